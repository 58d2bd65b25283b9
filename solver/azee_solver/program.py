"""One problem laid out for the kernels: what moves, towards what, at what cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_solver import kernels as k
from azee_solver.tape import Tape

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Row:
    """A residual between two entries of a tape, in the kernels' kinds, times √weight."""

    kind: int
    a: int
    b: int
    weight: float
    distance_m: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Collisions:
    """Capsules that must stay apart. pairs: (P, 2) capsules of the rig; reach: (P,) metres."""

    pairs: Ints
    reach: Array

    @staticmethod
    def none() -> Collisions:
        """No collisions."""
        return Collisions(np.empty((0, 2), dtype=np.int64), np.empty(0))


@dataclass(frozen=True, slots=True, eq=False)
class Cost:
    """What a posture costs, per coordinate of the rig: (V,) each; see the formula in `kernels`."""

    reference: Array
    keep: Array
    comfort: Array
    overlap: float


class Program:
    """A problem in two flat arrays, and the objective that runs on them.

    ints, reals: see `kernels`. rows: as given, with indices into the tape's used entries. free:
    (n,) coordinates that x stands for. lower, upper: (n,). evaluations: calls so far.
    """

    def __init__(
        self,
        rig: Rig,
        q: Array,
        free: Sequence[int],
        tape: Tape,
        rows: Sequence[Row],
        collisions: Collisions,
        cost: Cost,
        *,
        all_frames: bool = False,
    ) -> None:
        """Lay the problem out.

        Args: q: (V,) posture of all that stays. tape: made for that posture. all_frames: work out
            the frames of all moving nodes, not only of those that the objective reads.
        """
        chain, coordinates, capsules = rig.chain, rig.coordinates, rig.capsules
        self.free: Ints = np.array(sorted(free), dtype=np.int64)
        self.lower: Array = coordinates.lower[self.free]
        self.upper: Array = coordinates.upper[self.free]
        self.rows, codes, numbers = _used(tape, rows)
        used = np.unique(collisions.pairs)
        node = capsules.node[used]
        ends = np.hstack([capsules.a[used], capsules.b[used]])
        posture = np.stack(
            [
                cost.reference[self.free],
                cost.keep[self.free],
                0.5 * (self.lower + self.upper),
                0.5 * (self.upper - self.lower),
                cost.comfort[self.free],
            ],
            axis=1,
        )
        nodes, entries = len(chain.names), len(codes)
        ints: dict[int, Ints] = {
            k.PARENTS: chain.parents,
            k.DOF_START: chain.dof_start,
            k.DOF_AXIS: chain.dof_axis,
            k.DOF_COORDINATE: chain.dof_coordinate,
            k.ACTIVE: np.flatnonzero(
                tape.moving if all_frames else _needed(rig, tape.moving, codes, node)
            ),
            k.FREE: self.free,
            k.CODES: codes,
            k.ROWS: np.array([(r.kind, r.a, r.b) for r in self.rows], dtype=np.int64),
            k.CAPSULE_NODE: node,
            k.PAIRS: np.searchsorted(used, collisions.pairs),
        }
        reals: dict[int, Array] = {
            k.Q: q,
            k.OFFSETS: chain.offsets,
            k.ZERO: chain.zero,
            k.DOF_SCALE: chain.dof_scale,
            k.NUMBERS: numbers,
            k.ROW_NUMBERS: np.array([(r.weight, r.distance_m) for r in self.rows]),
            k.CAPSULE_ENDS: ends,
            k.PAIR_REACH: collisions.reach,
            k.POSTURE: posture,
            k.OVERLAP_WEIGHT: np.array([cost.overlap]),
            k.POSITIONS: tape.frames.positions,
            k.ROTATIONS: tape.frames.rotations,
            k.AXES: np.zeros((len(chain.dof_axis), 3)),
            k.FORCES: np.zeros((nodes, 3)),
            k.MOMENTS: np.zeros((nodes, 3)),
            k.VALUES: np.zeros((entries, 3)),
            k.PULLS: np.zeros((entries, 3)),
            k.ENDS: np.zeros_like(ends),
            k.DEEPEST: np.zeros(1),
            k.PULL_ON_Q: np.zeros(len(coordinates)),
        }
        header = np.empty(k.REALS_END + 1, dtype=np.int64)
        at = len(header)
        for section in range(k.INTS_END):
            header[section] = at
            at += ints[section].size
        header[k.INTS_END] = at
        starts = np.cumsum([0, *(reals[s].size for s in range(k.Q, k.REALS_END))])
        header[k.Q : k.REALS_END + 1] = starts
        self.ints: Ints = np.concatenate(
            [header, *(np.ravel(ints[s]) for s in range(k.INTS_END))]
        ).astype(np.int64)
        self.reals: Array = np.concatenate(
            [np.ravel(reals[s]) for s in range(k.Q, k.REALS_END)]
        ).astype(np.float64)
        self.evaluations = 0

    def __call__(self, x: Array, gradient: Array) -> float:
        """Objective at x (n,); its gradient goes into `gradient`, unless that is empty."""
        self.evaluations += 1
        return float(k.objective(x, gradient, self.ints, self.reals))

    def section(self, section: int) -> Array:
        """Return a view of a section of the reals, flat."""
        return self.reals[self.ints[section] : self.ints[section + 1]]

    def gaps(self) -> Array:
        """Differences that the residuals measured at the last x, (rows, 3); a · b as (·, 0, 0)."""
        values = self.section(k.VALUES).reshape(-1, 3)
        out = np.zeros((len(self.rows), 3))
        for n, row in enumerate(self.rows):
            a, b = values[row.a], values[row.b]
            if row.kind == k.PERPENDICULAR:
                out[n, 0] = a @ b
            elif row.kind == k.MEET:
                out[n] = a - b
            else:
                out[n, 0] = np.linalg.norm(a - b) - row.distance_m
        return out


def _used(tape: Tape, rows: Sequence[Row]) -> tuple[list[Row], Ints, Array]:
    """Entries of the tape that residuals hang on, and the rows with their new indices."""
    needed = {i for row in rows for i in (row.a, row.b)}
    for t in range(len(tape.codes) - 1, -1, -1):
        if t in needed:
            needed.update(i for i in tape.codes[t][1:3] if i >= 0)
    order = sorted(needed)
    new = {old: i for i, old in enumerate(order)} | {-1: -1}
    codes = [(code, new[a], new[b], node) for code, a, b, node in (tape.codes[t] for t in order)]
    kept = [Row(r.kind, new[r.a], new[r.b], r.weight, r.distance_m) for r in rows]
    return (
        kept,
        np.array(codes, dtype=np.int64).reshape(-1, 4),
        np.array([tape.numbers[t] for t in order], dtype=np.float64).reshape(-1, 5),
    )


def _needed(rig: Rig, moving: NDArray[np.bool_], codes: Ints, capsules: Ints) -> NDArray[np.bool_]:
    """Find the moving nodes whose frames the objective reads, and those above them."""
    needed = np.zeros(len(moving), dtype=np.bool_)
    reads = codes[:, 3]
    needed[reads[reads >= 0]] = True
    needed[capsules] = True
    for node in range(len(moving) - 1, 0, -1):
        if needed[node] and rig.chain.parents[node] >= 0:
            needed[rig.chain.parents[node]] = True
    return needed & moving
