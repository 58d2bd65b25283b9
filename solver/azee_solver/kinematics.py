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
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Frames
from azee_rig.machine_code import Kernel, address

if TYPE_CHECKING:
    from azee_rig.chain import Chain
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_POSE = Kernel(
    "azee_solver.posing",
    "pose",
    "azee_solver.kernels",
    "azee_solver.block",
    "azee_rig.pointers",
)
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


@lru_cache(maxsize=16)
def _addresses(chain: Chain) -> tuple[int, ...]:
    """Return where the arrays of a chain lie, which never change, in the order of the kernel."""
    arrays = (
        chain.parents,
        chain.offsets,
        chain.zero,
        chain.dof_start,
        chain.dof_axis,
        chain.dof_scale,
        chain.dof_coordinate,
    )
    return tuple(map(address, arrays))


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
    _POSE(
        *(len(q), count, len(chain.dof_axis), q.shape[1]),
        *(len(nodes), len(pairs), slopes),
        np.array(q, dtype=np.float64, order="C"),
        column,
        *_addresses(chain),
        nodes,
        ends,
        pairs,
        np.array(reach, dtype=np.float64),
        np.array([deeper_m]),
        positions,
        rotations,
        depth,
        slope,
        np.empty((len(chain.dof_axis), 3)),
        np.empty((len(nodes), 6)),
        np.empty((3, 3)),
    )
    return Frames(positions, rotations), depth, slope
