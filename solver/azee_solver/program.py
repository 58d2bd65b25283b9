"""One problem laid out for the kernels: what moves, towards what, at what cost."""

from __future__ import annotations

import ctypes
import math
import operator
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_rig.machine_code import Kernel
from azee_solver import block as k
from azee_solver.broadphase import Collisions
from azee_solver.layout import Structure, layout
from azee_solver.nlopt_backend import Compiled, address, minimise
from azee_solver.tape import Tape

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


_POINTER = ctypes.c_void_p
_OBJECTIVE = Kernel(
    "azee_solver.kernels.evaluate",
    "evaluate",
    "azee_solver.kernels",
    "azee_solver.block",
    "azee_rig.pointers",
)
_EVALUATE = _OBJECTIVE.address
"""Where the compiled objective lies."""
_evaluate = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_uint, _POINTER, _POINTER, _POINTER)(
    _EVALUATE
)


@dataclass(frozen=True, slots=True)
class Row:
    """A residual between two entries of a tape, in the kernels' kinds, times √weight.

    slack: how large it may be before it costs anything, for all kinds but `MEET`.
    """

    kind: int
    a: int
    b: int
    weight: float
    distance_m: float = 0.0
    slack: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Cost:
    """What a posture costs, per coordinate of the rig: (V,) each; see the formula in `kernels`.

    follows: coordinates, and the one that each follows instead of its reference. half_ranges: of
    coordinates whose joint-limit cost starts before their limits come near.
    """

    reference: Array
    keep: Array
    comfort: Array
    overlap: float
    follows: Mapping[int, int] = field(default_factory=dict)
    half_ranges: Mapping[int, float] = field(default_factory=dict)


class Program:
    """A problem in one block of words, and the objective that runs on it.

    ints, reals: the block, read as either; see `kernels`. rows: as given, with indices into the
    tape's used entries. free: (n,) coordinates that x stands for. lower, upper: (n,). weights: the
    factor of all residuals, and the weight of a squared metre of overlap, (1,) each.
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
        limits: tuple[Array, Array] | None = None,
        all_frames: bool = False,
    ) -> None:
        """Lay the problem out.

        Args: q: (V,) posture of all that stays. tape: made for that posture. limits: (V,) each,
            narrower than the body's. all_frames: work out the frames of all moving nodes, not only
            of those that the objective reads.
        """
        self.rows, codes, numbers = _used(tape, rows)
        self.tape_numbers: Array = np.array(numbers).reshape(-1, 5)
        self.row_weights = [row.weight for row in self.rows]
        self.layout = layout(
            rig,
            Structure(
                tuple(sorted(free)),
                tape.moving.tobytes(),
                codes,
                tuple((row.kind, row.a, row.b) for row in self.rows),
                collisions,
                tuple(cost.follows.items()),
                all_frames,
            ),
        )
        self.free, self.lower, self.upper = self.layout.free, self.layout.lower, self.layout.upper
        self.ints: Ints = self.layout.block()
        self.reals: Array = self.ints.view(np.float64)
        posture = self.section(k.POSTURE).reshape(-1, 5)
        posture[:, 0] = cost.reference[self.free]
        posture[self.layout.followed, 0] = k.FOLLOWING * q[self.layout.leaders]
        posture[:, 1] = cost.keep[self.free]
        posture[:, 4] = cost.comfort[self.free]
        for n, v in enumerate(self.free.tolist() if cost.half_ranges else ()):
            posture[n, 3] = cost.half_ranges.get(v, posture[n, 3])
        if limits is not None:
            self.lower, self.upper = (limit[self.free] for limit in limits)
            self.section(k.BOUNDS)[:] = np.concatenate([self.lower, self.upper])
        self.section(k.Q)[:] = q
        self.section(k.NUMBERS)[:] = numbers
        self.section(k.ROW_NUMBERS)[:] = [
            x for r in self.rows for x in (r.weight, r.distance_m, r.slack)
        ]
        self.section(k.OVERLAP_WEIGHT)[0] = cost.overlap
        self.section(k.POSITIONS)[:] = tape.frames.positions.ravel()
        self.section(k.ROTATIONS)[:] = tape.frames.rotations.ravel()
        self.weights = self.section(k.MISS_SHARE), self.section(k.OVERLAP_WEIGHT)
        self._damping, self._tolerance = self.section(k.DAMPING), self.section(k.TOLERANCE)
        self._count = len(self.free)
        self._rounds = self.ints[self.layout.sections[k.ROUNDS]]
        self._at, self._spare = scratch = np.empty((2, len(self.free)))
        self._at_address = address(scratch)
        self._spare_address = self._at_address + self._at.nbytes
        self.compiled = Compiled(
            _EVALUATE, address(self.ints), self.lower, self.upper, self.section(k.BEST)
        )

    def __call__(self, x: Array, gradient: Array) -> float:
        """Objective at x (n,); its gradient goes into `gradient`, unless that is empty."""
        self._at[:] = x
        value = self._evaluated(self._spare_address)
        if len(gradient):
            gradient[:] = self._spare
        return value

    def _evaluated(self, slope: int) -> float:
        value: float = _evaluate(self._count, self._at_address, slope, self.compiled.block)
        return value

    @property
    def evaluations(self) -> int:
        """How often the objective has been worked out so far."""
        return int(self.ints[self.ints[k.COUNT]])

    def lbfgs(self, start: Array, *, max_evaluations: int, tolerance: float) -> Array:
        """Return the lowest point (n,) that NLopt comes by from a start, inside the bounds."""
        found = self.compiled.minimise(
            start, max_evaluations=max_evaluations, tolerance=tolerance
        ) or minimise(
            self,
            start,
            self.lower,
            self.upper,
            max_evaluations=max_evaluations,
            tolerance=tolerance,
        )
        return found.x

    def gauss_newton(
        self, x: Array, *, rounds: int, tolerance: float, keep_damping: bool = False
    ) -> Array:
        """Return where damped Gauss-Newton steps lead from a point (n,) inside the bounds.

        Args: rounds: how many at most. tolerance: relative gain that ends it. keep_damping: x is
            where the last call has led: start with the damping that it ended with.
        """
        if not keep_damping:
            self._damping[0] = k.FIRST_DAMPING
        self._at[:] = x
        self._tolerance[0] = tolerance
        self._rounds[0] = rounds
        self._evaluated(self._spare_address)
        self._rounds[0] = 0
        return self._at.copy()

    def section(self, section: int) -> Array:
        """Return a view of a section of the reals, flat."""
        return self.reals[self.layout.sections[section]]

    def lengths(self) -> list[float]:
        """Return how far each row was from being met at the last x: metres, chords or cosines."""
        values = self.section(k.VALUES).reshape(-1, 3).tolist()
        out = [math.dist(values[a], values[b]) for a, b in self.layout.compared]
        for n in self.layout.others:
            row = self.rows[n]
            if row.kind == k.PERPENDICULAR:
                out[n] = abs(sum(map(operator.mul, values[row.a], values[row.b])))
            else:
                out[n] = abs(out[n] - row.distance_m)
            out[n] = max(out[n] - row.slack, 0.0)
        return out


def used_entries(tape: Tape, rows: Sequence[Row]) -> Array:
    """Return the numbers of the entries that residuals hang on, (m, 5), as a program has them."""
    return np.array(_used(tape, rows)[2]).reshape(-1, 5)


def _used(
    tape: Tape, rows: Sequence[Row]
) -> tuple[list[Row], tuple[tuple[int, int, int, int], ...], list[float]]:
    """Entries of the tape that residuals hang on, their numbers, the rows with new indices."""
    needed = {i for row in rows for i in (row.a, row.b)}
    for t in range(len(tape.codes) - 1, -1, -1):
        if t in needed:
            needed.update(i for i in tape.codes[t][1:3] if i >= 0)
    order = sorted(needed)
    new = {old: i for i, old in enumerate(order)} | {-1: -1}
    codes = tuple(
        (code, new[a], new[b], node) for code, a, b, node in (tape.codes[t] for t in order)
    )
    kept = [replace(row, a=new[row.a], b=new[row.b]) for row in rows]
    return kept, codes, [x for t in order for x in tape.numbers[t]]
