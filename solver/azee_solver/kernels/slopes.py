"""Slopes of the tape's entries by the free coordinates, forwards."""

from __future__ import annotations

import math

from numba import njit

from azee_rig.pointers import INNER
from azee_solver.block import (
    AXES,
    COLUMN,
    COMBINE,
    CROSS,
    DOF_COORDINATE,
    DOF_SCALE,
    DOF_START,
    PARENTS,
    POINT,
    POSITIONS,
    SHORT,
    TURN,
    UNIT,
    VECTOR,
)
from azee_solver.kernels.sections import part


@njit(**INNER)
def lever(node, point, direction, factor, row, ints, reals):
    """Add to a row (n,) what coordinates do to a point of a node, along a direction."""
    parents, start = part(ints, ints, PARENTS), part(ints, ints, DOF_START)
    coordinate, scale = part(ints, ints, DOF_COORDINATE), part(reals, ints, DOF_SCALE)
    column, positions = part(ints, ints, COLUMN), part(reals, ints, POSITIONS)
    axes = part(reals, ints, AXES)
    while node >= 0:
        ax = point[0] - positions[3 * node]
        ay = point[1] - positions[3 * node + 1]
        az = point[2] - positions[3 * node + 2]
        mx = factor * (ay * direction[2] - az * direction[1])
        my = factor * (az * direction[0] - ax * direction[2])
        mz = factor * (ax * direction[1] - ay * direction[0])
        for d in range(start[node], start[node + 1]):
            k = column[coordinate[d]]
            if k >= 0:
                row[k] += scale[d] * (
                    axes[3 * d] * mx + axes[3 * d + 1] * my + axes[3 * d + 2] * mz
                )
        node = parents[node]


@njit(**INNER)
def _turned(node, value, is_point, slope, ints, reals):
    """Slopes (3, n) of a point or direction that a node carries: axis × arm for each coordinate."""
    parents, start = part(ints, ints, PARENTS), part(ints, ints, DOF_START)
    coordinate, scale = part(ints, ints, DOF_COORDINATE), part(reals, ints, DOF_SCALE)
    column, positions = part(ints, ints, COLUMN), part(reals, ints, POSITIONS)
    axes = part(reals, ints, AXES)
    ax, ay, az = value[0], value[1], value[2]
    while node >= 0:
        if is_point:
            ax = value[0] - positions[3 * node]
            ay = value[1] - positions[3 * node + 1]
            az = value[2] - positions[3 * node + 2]
        for d in range(start[node], start[node + 1]):
            k = column[coordinate[d]]
            if k >= 0:
                ux, uy, uz = axes[3 * d], axes[3 * d + 1], axes[3 * d + 2]
                slope[0, k] += scale[d] * (uy * az - uz * ay)
                slope[1, k] += scale[d] * (uz * ax - ux * az)
                slope[2, k] += scale[d] * (ux * ay - uy * ax)
        node = parents[node]


@njit(**INNER)
def _add(slopes, t, i, factor, a, j):
    for v in range(slopes.shape[2]):
        slopes[t, i, v] += factor * slopes[a, j, v]


@njit(**INNER)
def differentiate(codes, numbers, values, slopes, ints, reals):
    """Work out derivatives (entries, 3, n) of the tape's entries by the free coordinates."""
    slopes[:] = 0.0
    for t in range(codes.shape[0]):
        code, a, b, node = codes[t, 0], codes[t, 1], codes[t, 2], codes[t, 3]
        if code in (POINT, VECTOR):
            _turned(node, values[t], code == POINT, slopes[t], ints, reals)
        elif code == COMBINE:
            for i in range(3):
                _add(slopes, t, i, numbers[t, 3], a, i)
                if b >= 0:
                    _add(slopes, t, i, numbers[t, 4], b, i)
        elif code == UNIT:
            length = math.sqrt(values[a, 0] ** 2 + values[a, 1] ** 2 + values[a, 2] ** 2)
            if length > SHORT:
                for i in range(3):
                    for k in range(3):
                        same = 1.0 if i == k else 0.0
                        _add(slopes, t, i, (same - values[t, i] * values[t, k]) / length, a, k)
        elif code == CROSS:
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                _add(slopes, t, i, values[b, k], a, j)
                _add(slopes, t, i, -values[b, j], a, k)
                _add(slopes, t, i, values[a, j], b, k)
                _add(slopes, t, i, -values[a, k], b, j)
        elif code == TURN:
            cos, sin = numbers[t, 3], numbers[t, 4]
            along = 0.0
            for i in range(3):
                along += values[b, i] * values[a, i]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                _add(slopes, t, i, cos, a, i)
                _add(slopes, t, i, (1.0 - cos) * along, b, i)
                _add(slopes, t, i, sin * values[b, j], a, k)
                _add(slopes, t, i, -sin * values[b, k], a, j)
                _add(slopes, t, i, sin * values[a, k], b, j)
                _add(slopes, t, i, -sin * values[a, j], b, k)
                for m in range(3):
                    _add(slopes, t, i, (1.0 - cos) * values[b, i] * values[b, m], a, m)
                    _add(slopes, t, i, (1.0 - cos) * values[b, i] * values[a, m], b, m)
