"""Frames of the nodes that a problem moves, and what its coordinates feel of pulls on them."""

from __future__ import annotations

import math

from numba import njit

from azee_rig.pointers import INNER
from azee_solver.block import (
    ACTIVE,
    AXES,
    DOF_AXIS,
    DOF_COORDINATE,
    DOF_SCALE,
    DOF_START,
    OFFSETS,
    PARENTS,
    POSITIONS,
    ROTATIONS,
    ZERO,
)
from azee_solver.kernels.sections import matrix, part, stack


@njit(**INNER)
def forward(q, ints, reals):
    """Frames of the active nodes; those of all others stand in the block already."""
    active, parents = part(ints, ints, ACTIVE), part(ints, ints, PARENTS)
    start, axis = part(ints, ints, DOF_START), part(ints, ints, DOF_AXIS)
    coordinate, scale = part(ints, ints, DOF_COORDINATE), part(reals, ints, DOF_SCALE)
    count = parents.shape[0]
    offsets = matrix(reals, ints, OFFSETS, count, 3)
    zero = stack(reals, ints, ZERO, count, 3, 3)
    positions = matrix(reals, ints, POSITIONS, count, 3)
    rotations = stack(reals, ints, ROTATIONS, count, 3, 3)
    axes = matrix(reals, ints, AXES, axis.shape[0], 3)
    for node in active:
        p = parents[node]
        for i in range(3):
            if p < 0:
                positions[node, i] = offsets[node, i]
                for j in range(3):
                    rotations[node, i, j] = zero[node, i, j]
            else:
                a, b, c = rotations[p, i, 0], rotations[p, i, 1], rotations[p, i, 2]
                positions[node, i] = (
                    positions[p, i]
                    + a * offsets[node, 0]
                    + b * offsets[node, 1]
                    + c * offsets[node, 2]
                )
                for j in range(3):
                    rotations[node, i, j] = (
                        a * zero[node, 0, j] + b * zero[node, 1, j] + c * zero[node, 2, j]
                    )
        for d in range(start[node], start[node + 1]):
            angle = scale[d] * q[coordinate[d]]
            cos, sin = math.cos(angle), math.sin(angle)
            j, k = (axis[d] + 1) % 3, (axis[d] + 2) % 3
            for i in range(3):
                axes[d, i] = rotations[node, i, axis[d]]
                u, w = rotations[node, i, j], rotations[node, i, k]
                rotations[node, i, j] = cos * u + sin * w
                rotations[node, i, k] = cos * w - sin * u


@njit(**INNER)
def joint_gradient(
    active, parents, start, scale, coordinate, positions, axes, forces, moments, pull_on_q
):
    """Add up forces and moments towards the root; what each coordinate feels of them."""
    for n in range(active.shape[0] - 1, -1, -1):
        node = active[n]
        o, F, M = positions[node], forces[node], moments[node]
        mx = M[0] - (o[1] * F[2] - o[2] * F[1])
        my = M[1] - (o[2] * F[0] - o[0] * F[2])
        mz = M[2] - (o[0] * F[1] - o[1] * F[0])
        for d in range(start[node], start[node + 1]):
            felt = axes[d, 0] * mx + axes[d, 1] * my + axes[d, 2] * mz
            pull_on_q[coordinate[d]] += scale[d] * felt
        p = parents[node]
        if p >= 0:
            for i in range(3):
                forces[p, i] += F[i]
                moments[p, i] += M[i]
