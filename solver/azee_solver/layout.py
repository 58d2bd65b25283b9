"""Where everything of a problem lies in its block of words, and what of it always stays the same.

Most of a problem is the body's and its structure's: nodes, limits, pairs of capsules, the kinds of
its operations. That is laid out once, for all problems that differ in numbers only, as those of a
movement do.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_rig.skeleton import frozen
from azee_solver import block as k
from azee_solver.broadphase import BroadPhase, Collisions, broad_phase

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Structure:
    """What a problem is, but for its numbers.

    free: coordinates that move, increasing. moving: (B,) flags as bytes. codes: operations of the
    tape. rows: kind and entries of each residual. follows: coordinates and the one each follows.
    all_frames: whether all moving nodes matter, not only those that the objective reads.
    """

    free: tuple[int, ...]
    moving: bytes
    codes: tuple[tuple[int, int, int, int], ...]
    rows: tuple[tuple[int, int, int], ...]
    collisions: Collisions
    follows: tuple[tuple[int, int], ...]
    all_frames: bool


class Layout:
    """A block's sections, and what is in them before numbers are filled in.

    free: (n,) coordinates that x stands for. lower, upper: (n,). followed: (F,) places in x of
    coordinates that follow; leaders: (F,) the coordinates of the rig that they follow. rows: (R, 3)
    kind and entries of the residuals.
    """

    def __init__(self, rig: Rig, structure: Structure) -> None:
        chain, coordinates = rig.chain, rig.coordinates
        self.free: Ints = frozen(structure.free, np.int64)
        self.lower: Array = frozen(coordinates.lower[self.free], np.float64)
        self.upper: Array = frozen(coordinates.upper[self.free], np.float64)
        phase = broad_phase(rig, structure.collisions)
        node = rig.capsules.node[phase.capsules]
        self.margin: Array = phase.margin
        self.rows: Ints = np.array(structure.rows, dtype=np.int64).reshape(-1, 3)
        codes = np.array(structure.codes, dtype=np.int64).reshape(-1, 4)
        n, entries, nodes = len(self.free), len(codes), len(chain.names)
        posture = np.zeros((n, 5))
        posture[:, 2] = 0.5 * (self.lower + self.upper)
        posture[:, 3] = 0.5 * (self.upper - self.lower)
        column = np.full(len(coordinates), -1)
        column[self.free] = np.arange(n)
        follows = [(column[v], leader) for v, leader in structure.follows if column[v] >= 0]
        self.followed, self.leaders = np.array(follows, dtype=np.int64).reshape(-1, 2).T
        leader_column = np.full(n, -1)
        leader_column[self.followed] = column[self.leaders]
        moving = np.frombuffer(structure.moving, dtype=np.bool_)
        if not structure.all_frames:
            moving = _needed(rig, moving, codes, node, phase)
        ends = np.hstack([rig.capsules.a[phase.capsules], rig.capsules.b[phase.capsules]])
        given: dict[int, Ints | Array] = {
            k.COUNT: np.zeros(1, dtype=np.int64),
            k.ROUNDS: np.zeros(1, dtype=np.int64),
            k.PARENTS: chain.parents,
            k.DOF_START: chain.dof_start,
            k.DOF_AXIS: chain.dof_axis,
            k.DOF_COORDINATE: chain.dof_coordinate,
            k.ACTIVE: np.flatnonzero(moving),
            k.FREE: self.free,
            k.COLUMN: column,
            k.FOLLOWED: leader_column,
            k.CODES: codes,
            k.ROWS: self.rows,
            k.CAPSULE_NODE: node,
            k.PAIRS: phase.pairs,
            k.BALL_NODE: phase.ball_node,
            k.RUNS: phase.runs,
            k.Q: np.zeros(len(coordinates)),
            k.OFFSETS: chain.offsets,
            k.ZERO: chain.zero,
            k.DOF_SCALE: chain.dof_scale,
            k.NUMBERS: np.zeros(5 * entries),
            k.ROW_NUMBERS: np.zeros(3 * len(self.rows)),
            k.CAPSULE_ENDS: ends,
            k.PAIR_REACH: phase.reach,
            k.BALLS: phase.ball_centre,
            k.RUN_REACH: phase.run_reach,
            k.POSTURE: posture,
            k.BOUNDS: np.stack([self.lower, self.upper]),
            k.MISS_SHARE: np.ones(1),
            k.OVERLAP_WEIGHT: np.zeros(1),
            k.TOLERANCE: np.zeros(1),
            k.DAMPING: np.zeros(1),
            k.POSITIONS: np.zeros(3 * nodes),
            k.ROTATIONS: np.zeros(9 * nodes),
            k.AXES: np.zeros(3 * len(chain.dof_axis)),
            k.DEEPEST: np.zeros(1),
            k.BEST: np.full(1 + n, np.inf),
        }
        worked_out = {
            k.FORCES: 3 * nodes,
            k.MOMENTS: 3 * nodes,
            k.VALUES: 3 * entries,
            k.PULLS: 3 * entries,
            k.ENDS: 6 * len(node),
            k.CENTRES: phase.ball_centre.size,
            k.CONTACTS: 12 * len(phase.pairs),
            k.PULL_ON_Q: len(coordinates),
            k.SLOPES: 3 * entries * n,
            k.HESSIAN: n * n,
            k.FACTOR: n * (n + 1),
            k.VECTORS: 7 * n,
        }
        at = k.SECTIONS_END + 1
        self.sections: dict[int, slice] = {}
        for section in range(k.COUNT, k.SECTIONS_END):
            size = worked_out[section] if section >= k.FORCES else given[section].size
            self.sections[section] = slice(at, at + size)
            at += size
        self.size = at
        self._given: Ints = np.empty(self.sections[k.BEST].stop, dtype=np.int64)
        starts = [self.sections[section].start for section in range(k.COUNT, k.SECTIONS_END)]
        self._given[: k.SECTIONS_END + 1] = [at, *starts, at]
        for section, values in given.items():
            block = self._given if section < k.Q else self._given.view(np.float64)
            block[self.sections[section]] = values.ravel()

    def block(self) -> Ints:
        """Return a new block, as integers: all but the numbers is in it."""
        block = np.empty(self.size, dtype=np.int64)
        block[: len(self._given)] = self._given
        return block

    @cached_property
    def compared(self) -> list[list[int]]:
        """Entries that each residual compares."""
        return [row[1:] for row in self.rows.tolist()]

    @cached_property
    def others(self) -> list[int]:
        """Residuals that are no differences of their entries."""
        return [n for n, kind in enumerate(self.rows[:, 0].tolist()) if kind != k.MEET]


@lru_cache(maxsize=256)
def layout(rig: Rig, structure: Structure) -> Layout:
    """Return the layout of all problems of one structure."""
    return Layout(rig, structure)


def _needed(
    rig: Rig, moving: NDArray[np.bool_], codes: Ints, capsules: Ints, phase: BroadPhase
) -> NDArray[np.bool_]:
    """Find the moving nodes whose frames the objective reads, and those above them."""
    needed = np.zeros(len(moving), dtype=np.bool_)
    reads = codes[:, 3]
    needed[reads[reads >= 0]] = True
    needed[capsules] = True
    needed[phase.ball_node] = True
    for node in range(len(moving) - 1, 0, -1):
        if needed[node] and rig.chain.parents[node] >= 0:
            needed[rig.chain.parents[node]] = True
    return needed & moving
