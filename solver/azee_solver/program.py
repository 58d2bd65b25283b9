"""One problem laid out for the kernels: what moves, towards what, at what cost."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_solver import kernels as k
from azee_solver.broadphase import BroadPhase, broad_phase
from azee_solver.nlopt_backend import Compiled, address, minimise, minimise_compiled
from azee_solver.tape import Tape

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


_POINTER = ctypes.c_void_p
_EVALUATE = int(k.evaluate.address or 0)
"""Where the compiled objective lies."""
_evaluate = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_uint, _POINTER, _POINTER, _POINTER)(
    _EVALUATE
)


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
    """What a posture costs, per coordinate of the rig: (V,) each; see the formula in `kernels`.

    follows: coordinates, and the one that each follows instead of its reference.
    """

    reference: Array
    keep: Array
    comfort: Array
    overlap: float
    follows: Mapping[int, int] = field(default_factory=dict)


class Program:
    """A problem in one block of words, and the objective that runs on it.

    ints, reals: the block, read as either; see `kernels`. rows: as given, with indices into the
    tape's used entries. free: (n,) coordinates that x stands for. lower, upper: (n,).
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
        phase = broad_phase(rig, collisions.pairs, collisions.reach)
        used = phase.capsules
        node = capsules.node[used]
        posture = np.empty((len(self.free), 5))
        posture[:, 0] = cost.reference[self.free]
        posture[:, 1] = cost.keep[self.free]
        posture[:, 2] = 0.5 * (self.lower + self.upper)
        posture[:, 3] = 0.5 * (self.upper - self.lower)
        posture[:, 4] = cost.comfort[self.free]
        column = np.full(len(coordinates), -1)
        column[self.free] = np.arange(len(self.free))
        followed = np.full(len(self.free), -1)
        for n, v in enumerate(self.free.tolist()):
            if v in cost.follows:
                followed[n] = column[cost.follows[v]]
                posture[n, 0] = k.FOLLOWING * q[cost.follows[v]]
        moving = tape.moving if all_frames else _needed(rig, tape.moving, codes, node, phase)
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
            k.FOLLOWED: followed,
            k.CODES: codes,
            k.ROWS: np.array([(r.kind, r.a, r.b) for r in self.rows], dtype=np.int64),
            k.CAPSULE_NODE: node,
            k.PAIRS: phase.pairs,
            k.BALL_NODE: phase.ball_node,
            k.RUNS: phase.runs,
            k.Q: q,
            k.OFFSETS: chain.offsets,
            k.ZERO: chain.zero,
            k.DOF_SCALE: chain.dof_scale,
            k.NUMBERS: numbers,
            k.ROW_NUMBERS: np.array([(r.weight, r.distance_m) for r in self.rows]),
            k.CAPSULE_ENDS: np.hstack([capsules.a[used], capsules.b[used]]),
            k.PAIR_REACH: phase.reach,
            k.BALLS: phase.ball_centre,
            k.RUN_REACH: phase.run_reach,
            k.POSTURE: posture,
            k.BOUNDS: np.stack([self.lower, self.upper]),
            k.OVERLAP_WEIGHT: np.array([cost.overlap]),
            k.TOLERANCE: np.zeros(1),
            k.POSITIONS: tape.frames.positions,
            k.ROTATIONS: tape.frames.rotations,
            k.AXES: np.zeros((len(chain.dof_axis), 3)),
            k.DEEPEST: np.zeros(1),
            k.BEST: np.full(1 + len(self.free), np.inf),
        }
        n, entries, nodes = len(self.free), len(codes), len(chain.names)
        worked_out = {
            k.FORCES: 3 * nodes,
            k.MOMENTS: 3 * nodes,
            k.VALUES: 3 * entries,
            k.PULLS: 3 * entries,
            k.ENDS: 6 * len(used),
            k.CENTRES: phase.ball_centre.size,
            k.CONTACTS: 12 * len(phase.pairs),
            k.PULL_ON_Q: len(coordinates),
            k.SLOPES: 3 * entries * n,
            k.HESSIAN: n * n,
            k.FACTOR: n * (n + 1),
            k.VECTORS: 5 * n,
        }
        at = k.SECTIONS_END + 1
        header = [0] * at
        for section in range(k.COUNT, k.SECTIONS_END):
            header[section] = at
            at += worked_out[section] if section >= k.FORCES else given[section].size
        header[k.SIZE], header[k.SECTIONS_END] = at, at
        self.ints: Ints = np.empty(at, dtype=np.int64)
        self.reals: Array = self.ints.view(np.float64)
        self.ints[: len(header)] = header
        for section, values in given.items():
            block = self.ints if section < k.Q else self.reals
            block[header[section] : header[section + 1]] = values.ravel()
        self._spare = np.empty(n)
        self.compiled = Compiled(
            _EVALUATE,
            address(self.ints),
            np.ascontiguousarray(self.lower),
            np.ascontiguousarray(self.upper),
            self.section(k.BEST),
        )

    def __call__(self, x: Array, gradient: Array) -> float:
        """Objective at x (n,); its gradient goes into `gradient`, unless that is empty."""
        at = np.ascontiguousarray(x, dtype=np.float64)
        slope = gradient if len(gradient) else self._spare
        return float(_evaluate(len(at), address(at), address(slope), self.compiled.block))

    @property
    def evaluations(self) -> int:
        """How often the objective has been worked out so far."""
        return int(self.ints[self.ints[k.COUNT]])

    def descend(self, start: Array, *, max_evaluations: int, tolerance: float) -> Array:
        """Return the lowest point (n,) that NLopt comes by from a start, inside the bounds."""
        found = minimise_compiled(
            self.compiled, start, max_evaluations=max_evaluations, tolerance=tolerance
        ) or minimise(
            self,
            start,
            self.lower,
            self.upper,
            max_evaluations=max_evaluations,
            tolerance=tolerance,
        )
        return found.x

    def polish(self, x: Array, *, rounds: int, tolerance: float) -> Array:
        """Return where damped Gauss-Newton steps lead from a point (n,), inside the bounds.

        Args: rounds: how many at most. tolerance: relative gain that ends it.
        """
        at = np.clip(x, self.lower, self.upper)
        self.section(k.TOLERANCE)[0] = tolerance
        self.ints[self.ints[k.ROUNDS]] = rounds
        self(at, self._spare)
        self.ints[self.ints[k.ROUNDS]] = 0
        return at

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
