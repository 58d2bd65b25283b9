"""Frames of postures, and how deep their capsules overlap: the kernel of `kinematics`.

It shares no forward kinematics with the kernels that optimise. Only `machine_code` imports this.
"""

from __future__ import annotations

import math

from numba import cfunc, njit

from azee_rig.machine_code import KEEPS
from azee_rig.pointers import INNER, WORDS, carray, integers, reals
from azee_solver.block import SHORT
from azee_solver.kernels.capsules import nearest


@njit(**INNER)
def _turn_all(
    q, parents, offsets, zero, start, axis, scale, coordinate, positions, rotations, axes
):
    """Frames of all nodes, and the axes of all degrees of freedom, in the world."""
    for node in range(parents.shape[0]):
        p = parents[node]
        for i in range(3):
            if p < 0:
                positions[node, i] = offsets[node, i]
                for j in range(3):
                    rotations[node, i, j] = zero[node, i, j]
                continue
            positions[node, i] = positions[p, i]
            for j in range(3):
                positions[node, i] += rotations[p, i, j] * offsets[node, j]
                rotations[node, i, j] = (
                    rotations[p, i, 0] * zero[node, 0, j]
                    + rotations[p, i, 1] * zero[node, 1, j]
                    + rotations[p, i, 2] * zero[node, 2, j]
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
def _add_slope(
    node, point, along, sign, column, parents, start, scale, coordinate, positions, axes, slope
):
    """Add how fast a point of a node moves along a direction, per coordinate above it."""
    while node >= 0:
        x, y, z = (
            point[0] - positions[node, 0],
            point[1] - positions[node, 1],
            point[2] - positions[node, 2],
        )
        for d in range(start[node], start[node + 1]):
            v = column[coordinate[d]]
            if v >= 0:
                a, b, c = axes[d, 0], axes[d, 1], axes[d, 2]
                speed = (
                    along[0] * (b * z - c * y)
                    + along[1] * (c * x - a * z)
                    + along[2] * (a * y - b * x)
                )
                slope[v] += sign * scale[d] * speed
        node = parents[node]


@cfunc(WORDS, cache=not KEEPS, error_model="numpy")
def pose(words):
    """Pose a body many times.

    Words: T postures, B nodes, D degrees of freedom, V coordinates, K capsules, P pairs, n slopes;
    q (T, V), column (V,), the chain's seven arrays, nodes (K,), ends (K, 6), pairs (P, 2), reach
    (P,), the depth beyond which slopes are wanted (1,); positions (T, B, 3), rotations
    (T, B, 3, 3), depth (T, P), slope (T, P, n), which is zero; room for axes (D, 3), ends (K, 6)
    and three vectors.
    """
    w = carray(words, (28,))
    postures, bones, dofs, coordinates = w[0], w[1], w[2], w[3]
    capsules, count, slopes = w[4], w[5], w[6]
    q, column = reals(w[7], (postures, coordinates)), integers(w[8], (coordinates,))
    parents, offsets = integers(w[9], (bones,)), reals(w[10], (bones, 3))
    zero, start = reals(w[11], (bones, 3, 3)), integers(w[12], (bones + 1,))
    axis, scale = integers(w[13], (dofs,)), reals(w[14], (dofs,))
    coordinate, nodes = integers(w[15], (dofs,)), integers(w[16], (capsules,))
    local, pairs = reals(w[17], (capsules, 6)), integers(w[18], (count, 2))
    reach, deeper = reals(w[19], (count,)), reals(w[20], (1,))[0]
    positions, rotations = reals(w[21], (postures, bones, 3)), reals(w[22], (postures, bones, 3, 3))
    depth, slope = reals(w[23], (postures, count)), reals(w[24], (postures, count, slopes))
    axes, ends, room = reals(w[25], (dofs, 3)), reals(w[26], (capsules, 6)), reals(w[27], (3, 3))
    first, second, along = room[0], room[1], room[2]
    for t in range(postures):
        p, R = positions[t], rotations[t]
        _turn_all(q[t], parents, offsets, zero, start, axis, scale, coordinate, p, R, axes)
        for c in range(capsules):
            node = nodes[c]
            for e in range(2):
                for i in range(3):
                    ends[c, 3 * e + i] = p[node, i]
                    for j in range(3):
                        ends[c, 3 * e + i] += R[node, i, j] * local[c, 3 * e + j]
        for n in range(count):
            i, j = pairs[n, 0], pairs[n, 1]
            u, w = nearest(ends, i, j)
            square = 0.0
            for k in range(3):
                first[k] = ends[i, k] + u * (ends[i, 3 + k] - ends[i, k])
                second[k] = ends[j, k] + w * (ends[j, 3 + k] - ends[j, k])
                along[k] = first[k] - second[k]
                square += along[k] * along[k]
            distance = math.sqrt(square)
            depth[t, n] = reach[n] - distance
            if distance <= SHORT or depth[t, n] <= deeper:
                continue
            for k in range(3):
                along[k] /= distance
            _add_slope(
                nodes[i], first, along, -1.0, column, parents, start, scale, coordinate, p, axes,
                slope[t, n],
            )  # fmt: skip
            _add_slope(
                nodes[j], second, along, 1.0, column, parents, start, scale, coordinate, p, axes,
                slope[t, n],
            )  # fmt: skip
