"""Ways round the body: smooth detours that a movement makes between its keys."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STEEPEST = 12.0
"""Largest exponent of a detour's rise or fall."""


@dataclass(frozen=True, slots=True, eq=False)
class Swerve:
    """A detour of some coordinates, none at its start and its end.

    members: (n,) which coordinates. change: (n,) radians at the peak. start_s, end_s: on the
    score's time line. peak: when it is largest, as a share of its length, 0 to 1.
    """

    members: NDArray[np.int64]
    change: Array
    start_s: float
    end_s: float
    peak: float

    def share(self, times_s: Array) -> Array:
        """Return how much of the change is made at times, (T,), 0 to 1.

        u^a (1 − u)^b, scaled to 1 at its peak; both exponents are at least 3, so that velocity and
        acceleration are zero where it starts and ends: keys and their times stay as they are.
        """
        u = np.clip((times_s - self.start_s) / (self.end_s - self.start_s), 0.0, 1.0)
        p = float(np.clip(self.peak, 3 / (3 + STEEPEST), STEEPEST / (3 + STEEPEST)))
        a, b = (3.0, 3.0 * (1 - p) / p) if p < 0.5 else (3.0 * p / (1 - p), 3.0)
        return np.asarray(u**a * (1 - u) ** b / (p**a * (1 - p) ** b))

    def add_to(self, q: Array, times_s: Array) -> None:
        """Lay the detour on a movement at increasing times, (T, V), in place."""
        first, last = np.searchsorted(times_s, (self.start_s, self.end_s))
        rows = slice(int(first), int(last))
        q[rows, self.members] += self.share(times_s[rows])[:, None] * self.change
