"""Kinematics of many postures at once, compiled: frames of nodes, and how deep capsules overlap.

Apart from the kernels that optimise: what a posture reaches is measured with these, so that
nothing is taken for granted which a kernel may get wrong. `Chain.frames` does the same in plain
numpy, for whoever solves nothing.

The nearest points of two axes slide along them as the axes turn, but to first order that does not
change their distance: its slope is that of the two points as if fixed to their nodes (the envelope
theorem).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from azee_rig.chain import Frames
from azee_solver.kernels import SHORT, _nearest

if TYPE_CHECKING:
    from azee_rig.chain import Chain
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_NO_PAIRS: Ints = np.empty((0, 2), dtype=np.int64)
_NO_NODES: Ints = np.empty(0, dtype=np.int64)
_NO_ENDS = np.empty((0, 6))


def frames(chain: Chain, q: Array) -> Frames:
    """Return the frames of all nodes in postures (…, V)."""
    column = np.full(q.shape[-1], -1, dtype=np.int64)
    postures = q.reshape(-1, q.shape[-1])
    found, _, _ = _posed(
        chain, postures, column, _NO_NODES, _NO_ENDS, _NO_PAIRS, np.empty(0), math.inf, 0
    )
    batch = q.shape[:-1]
    return Frames(
        found.positions.reshape(*batch, *found.positions.shape[1:]),
        found.rotations.reshape(*batch, *found.rotations.shape[1:]),
    )


class Parting:
    """Depths of some pairs of a body's capsules.

    pairs: (P, 2).
    """

    def __init__(self, rig: Rig, pairs: Ints) -> None:
        self._rig = rig
        capsules = rig.capsules
        self._pairs: Ints = np.array(pairs, dtype=np.int64).reshape(-1, 2)
        self._ends = np.hstack([capsules.a, capsules.b])

    def depths(
        self, q: Array, reach: Array, coordinates: Ints, deeper_m: float = -math.inf
    ) -> tuple[Array, Array]:
        """Return how deep pairs overlap, (T, P) metres, and its slope, (T, P, n) metres a radian.

        Negative depths are distances. Args: q: (T, V). reach: (P,) distance of the axes at which
        a pair touches. coordinates: (n,) those to which slopes are wanted. deeper_m: of pairs
        that overlap no deeper slopes are left at zero.
        """
        column = np.full(q.shape[1], -1, dtype=np.int64)
        column[coordinates] = np.arange(len(coordinates))
        _, depth, slope = _posed(
            self._rig.chain,
            q,
            column,
            self._rig.capsules.node,
            self._ends,
            self._pairs,
            reach,
            deeper_m if len(coordinates) else math.inf,
            len(coordinates),
        )
        return depth, slope


def _posed(
    chain: Chain,
    q: Array,
    column: Ints,
    nodes: Ints,
    ends: Array,
    pairs: Ints,
    reach: Array,
    deeper_m: float,
    slopes: int,
) -> tuple[Frames, Array, Array]:
    """Frames, depths (T, P) and slopes (T, P, n) in postures (T, V)."""
    count = len(chain.names)
    positions, rotations = np.empty((len(q), count, 3)), np.empty((len(q), count, 3, 3))
    depth, slope = np.empty((len(q), len(pairs))), np.zeros((len(q), len(pairs), slopes))
    _pose(
        np.array(q, dtype=np.float64, order="C"),
        column,
        chain.parents,
        chain.offsets,
        chain.zero,
        chain.dof_start,
        chain.dof_axis,
        chain.dof_scale,
        chain.dof_coordinate,
        nodes,
        ends,
        pairs,
        np.array(reach, dtype=np.float64),
        deeper_m,
        positions,
        rotations,
        depth,
        slope,
    )
    return Frames(positions, rotations), depth, slope


@njit(error_model="numpy")
def _turn_all(  # type: ignore[no-untyped-def]
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


@njit(error_model="numpy")
def _add_slope(  # type: ignore[no-untyped-def]
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


_FROZEN_INTS = types.Array(types.int64, 1, "C", readonly=True)
_FROZEN_REALS = types.Array(types.float64, 1, "C", readonly=True)


@njit(
    types.void(
        types.float64[:, ::1],
        types.int64[::1],
        _FROZEN_INTS,
        types.Array(types.float64, 2, "C", readonly=True),
        types.Array(types.float64, 3, "C", readonly=True),
        _FROZEN_INTS,
        _FROZEN_INTS,
        _FROZEN_REALS,
        _FROZEN_INTS,
        _FROZEN_INTS,
        types.float64[:, ::1],
        types.int64[:, ::1],
        types.float64[::1],
        types.float64,
        types.float64[:, :, ::1],
        types.float64[:, :, :, ::1],
        types.float64[:, ::1],
        types.float64[:, :, ::1],
    ),
    error_model="numpy",
    cache=True,
)
def _pose(  # type: ignore[no-untyped-def]
    q, column, parents, offsets, zero, start, axis, scale, coordinate, nodes, local, pairs, reach,
    deeper, positions, rotations, depth, slope,
):  # fmt: skip
    axes, ends = np.empty((axis.shape[0], 3)), np.empty((nodes.shape[0], 6))
    first, second, along = np.empty(3), np.empty(3), np.empty(3)
    for t in range(q.shape[0]):
        p, R = positions[t], rotations[t]
        _turn_all(q[t], parents, offsets, zero, start, axis, scale, coordinate, p, R, axes)
        for c in range(nodes.shape[0]):
            node = nodes[c]
            for e in range(2):
                for i in range(3):
                    ends[c, 3 * e + i] = p[node, i]
                    for j in range(3):
                        ends[c, 3 * e + i] += R[node, i, j] * local[c, 3 * e + j]
        for n in range(pairs.shape[0]):
            i, j = pairs[n, 0], pairs[n, 1]
            u, w = _nearest(ends, i, j)
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
