"""The trajectory problem: all postures of a movement, each with its tasks, solved at once.

Postures of one movement should differ from a reference movement as smoothly as possible and meet
the tasks of their frames. With d = x − ref, the problem is to lower

    F(x) = Σ_t f_t(x_t) + Σ_v s_v |Dᵏ d_v|²

where f_t is the solver's objective for the tasks of frame t and Dᵏ d_v are k-th differences of a
coordinate's displacement in time. Projected frame by frame instead, .69 to .99 of the acceleration
of a wrist lay above 10 Hz; all at once it keeps the reference's spectrum.

A long movement is solved in windows: each goes on from the last frames of the one before, and looks
ahead into frames that the next one solves again.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from azee_rig.machine_code import Kernel
from azee_solver.block import BAND_PAD
from azee_solver.program import Program

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_PROJECT = Kernel(
    "azee_solver.kernels.trajectory",
    "project",
    "azee_solver.kernels",
    "azee_solver.block",
    "azee_rig.pointers",
)

ORDER = 2
"""k, the order of the differences that are kept small."""
SMOOTH_S = 0.06
"""A displacement that lasts shorter than about this costs more in F by its differences than by its
size: s_v = λ_v (SMOOTH_S · frames per second)²ᵏ."""
WINDOW_S, AHEAD_S = 1.5, 0.3
"""Length of a window, and how far it looks ahead."""


@dataclass(frozen=True, slots=True)
class Stage:
    """A run of Gauss-Newton steps.

    misses, overlaps: factors of the costs of misses and of overlap. steps: at most so many.
    tolerance: relative gain that ends it.
    """

    misses: float
    overlaps: float
    steps: int
    tolerance: float


LOOK = Stage(1.0, 1.0, 0, 0.0)
"""Measures what the reference misses."""
NEAR = 30.0
"""A reference that misses by more tolerances is first drawn near softly: a stiff start from there
ends in bad minima."""
SOFT = Stage(1e-3, 1e-3, 6, 0.1)
WHOLE = Stage(1.0, 1.0, 14, 0.05)
MET_SHARE = 0.7
"""What is still missed by more than this share of a tolerance is met more firmly at the end."""
FIRM = Stage(4.0, 0.1, 6, 0.02)


@dataclass(frozen=True, slots=True, eq=False)
class Refills:
    """Numbers of programs' tapes that differ from frame to frame.

    counts: (T,) how many entries of a frame's tape. entries: (T, K) which. numbers: (T, K, 5) what
    stands there in this frame.
    """

    counts: Ints
    entries: Ints
    numbers: Array


class Refilling(Protocol):
    """Works the refills out for postures near the solution: a target may read the body."""

    def __call__(self, frames: range, q: Array) -> Refills:
        """Return the refills of some frames, in which the body has the postures q (T, V)."""


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """The problem of a movement of T frames and all V coordinates of a rig.

    programs: of all frames, several of which may share one; each is laid out for the coordinates
    that its terms hang on, with all nodes moving. of_frame: (T,) each frame's, an index.
    reference, keep: (T, V) radians and cost of a squared radian. fixed: (T, V) coordinates that
    stay at the reference. smooth, lower, upper: (V,) s_v and the limits. overlap: cost of a
    squared metre of overlap. near_limits: (T, V) how far inside the limits coordinates stay,
    radians, unless something is missed by that; nothing by default.
    """

    programs: Sequence[Program]
    of_frame: Ints
    reference: Array
    keep: Array
    fixed: NDArray[np.bool_]
    smooth: Array
    lower: Array
    upper: Array
    overlap: float
    refilled: Refilling
    near_limits: Array | None = None

    def solve(self, fps: float) -> Array:
        """Return the postures (T, V) that lower F, inside the limits."""
        T = len(self.reference)
        out = np.clip(self.reference, self.lower, self.upper)
        windows = [(max(0, start - ORDER - 1), start, stop) for start, stop in _windows(T, fps)]
        room = _Room.of(max(stop - first for first, _, stop in windows), out.shape[1])
        roomy = {*range(len(windows))} if self.near_limits is None else set[int]()
        starts: list[Array] = []
        while len(starts) < len(windows):
            i = len(starts)
            first, start, stop = windows[i]
            rows, solved = slice(first, stop), start - first
            lower, upper = self.lower, self.upper
            if i not in roomy:
                lower, upper = self._inner_limits(rows, out[first:start])
            found, missed = self._solve_window(rows, solved, out[rows], (lower, upper), room)
            if missed <= MET_SHARE or i in roomy:
                starts.append(out[rows].copy())
                out[rows] = found
                continue
            roomy |= {max(i - 1, 0), i}  # the one before looks ahead into it
            if starts:
                first, _, stop = windows[i - 1]
                out[first:stop] = starts.pop()
        return out

    def _solve_window(
        self, rows: slice, solved: int, start: Array, limits: tuple[Array, Array], room: _Room
    ) -> tuple[Array, float]:
        """Return the postures of some frames, the first of which are solved, inside limits.

        And the largest miss that is left, in tolerances.
        """
        T, n = start.shape
        frames = range(rows.start, rows.stop)
        lower, upper = limits
        programs = [self.programs[i] for i in self.of_frame[rows]]
        blocks = np.array([p.compiled.block for p in programs], dtype=np.int64)
        x, weights = np.array(start), _weights(programs)
        reference, keep = (np.ascontiguousarray(a[rows]) for a in (self.reference, self.keep))
        fixed = self.fixed[rows].astype(np.int64)
        fixed[:solved] = 1
        bands = _difference_bands(T)
        misses, result = np.empty((2, T)), np.empty(2)

        def take(stage: Stage, refills: Refills) -> float:
            """Take a stage's steps; return the largest miss that is left, in tolerances."""
            options = np.array([stage.misses, stage.overlaps * self.overlap, stage.tolerance, 1e-4])
            _PROJECT(
                T, n, weights.shape[1], refills.entries.shape[1], ORDER, stage.steps, blocks,
                x, reference, keep, weights, refills.counts, refills.entries, refills.numbers,
                bands, self.smooth, lower, upper, fixed, options, *room.reals,
                misses[0], result, *room.integers[:3], misses[1], room.integers[3],
            )  # fmt: skip
            return math.sqrt(float(misses[0].max(initial=0.0)))

        x[solved:] = np.clip(x[solved:], lower, upper)
        refills = self.refilled(frames, x)
        if take(LOOK, refills) > NEAR:
            take(SOFT, refills)
            refills = self.refilled(frames, x)
        missed = take(WHOLE, refills)
        if missed > MET_SHARE:
            missed = take(FIRM, self.refilled(frames, x))
        return x, missed

    def _inner_limits(self, rows: slice, before: Array) -> tuple[Array, Array]:
        """Return the limits in some frames, (V,) each, after others that are solved.

        What comes nearer to its limits in these has all its room: it would jump.
        """
        if self.near_limits is None:
            return self.lower, self.upper
        least = self.near_limits[rows].min(axis=0)
        lower, upper = self.lower + least, self.upper - least
        inside = np.all((lower <= before) & (before <= upper), axis=0)
        return np.where(inside, lower, self.lower), np.where(inside, upper, self.upper)


@dataclass(frozen=True, slots=True, eq=False)
class _Room:
    """What the kernel works in: matrices, band, gradients, step, trial, spare, nothing; and words.

    It is made once for all windows: fresh pages of memory cost as much as a step.
    """

    reals: Sequence[Array]
    integers: Sequence[Ints]

    @staticmethod
    def of(count: int, n: int) -> _Room:
        """Make room for windows of so many frames and n coordinates."""
        reals = [
            np.empty(2 * count * n * n),
            np.empty(count * n * (ORDER * n + 1 + BAND_PAD)),
            np.empty(2 * count * n),
            *(np.empty(count * n) for _ in range(3)),
            np.empty(0),
        ]
        sizes = (count * n, n, n, n * n)
        return _Room(reals, [np.empty(k, dtype=np.int64) for k in sizes])


def _weights(programs: Sequence[Program]) -> Array:
    """Return the weights of all rows of frames' programs, (T, R)."""
    out = np.zeros((len(programs), max((len(p.rows) for p in programs), default=0)))
    for row, program in zip(out, programs, strict=True):
        row[: len(program.rows)] = program.row_weights
    return out


def _windows(count: int, fps: float) -> list[tuple[int, int]]:
    """Return the first frame of each window, and one past the last that it looks at."""
    stride, ahead = max(ORDER + 1, round(WINDOW_S * fps)), round(AHEAD_S * fps)
    starts = [0]
    while starts[-1] + stride + ahead < count:
        starts.append(starts[-1] + stride)
    stops = [min(count, b + ahead) for _, b in pairwise(starts)]
    return [*zip(starts, [*stops, count], strict=True)]


@lru_cache(maxsize=16)
def _difference_bands(count: int) -> Array:
    """Return the main and the upper diagonals of DᵀD for `ORDER`-th differences, (k + 1, T)."""
    stencil = np.diff(np.eye(ORDER + 1), ORDER, axis=0)[0]
    out = np.zeros((ORDER + 1, count))
    for start in range(count - ORDER):
        for i in range(ORDER + 1):
            for j in range(i, ORDER + 1):
                out[j - i, start + i] += stencil[i] * stencil[j]
    return out
