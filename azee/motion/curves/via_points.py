"""Via points: smooth offsets that lead a movement round an obstacle between its keys."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LARGEST_EXPONENT = 12.0
"""Of either factor of the weight: it bounds how abruptly a via point sets in or ends."""
INSIDE = np.linspace(0.0, 1.0, 201)[1:-1]
"""Shares of a via point's time at which its rates are measured."""


@dataclass(frozen=True, slots=True, eq=False)
class ViaPoint:
    """An offset of some coordinates that grows from nothing to its peak and back.

    members: (n,) the coordinates. offset: (n,) radians at the peak. start_s, end_s: on the score's
    time line. peak: when the offset is whole, as a share of that time, 0 to 1.
    """

    members: NDArray[np.int64]
    offset: Array
    start_s: float
    end_s: float
    peak: float

    def weight(self, times_s: Array) -> Array:
        """Return the share of the offset at times, (T,), 0 to 1.

        w(u) = uᵃ (1 − u)ᵇ / (pᵃ (1 − p)ᵇ) with u = (t − start)/(end − start) and its maximum 1 at
        p = a/(a + b). The smaller exponent is 3, so that velocity and acceleration are zero at
        both ends: keys and their times stay as they are. The larger follows from the peak and is
        at most `LARGEST_EXPONENT`.
        """
        u = np.clip((times_s - self.start_s) / (self.end_s - self.start_s), 0.0, 1.0)
        a, b = self._exponents
        p = a / (a + b)
        return np.asarray(u**a * (1 - u) ** b / (p**a * (1 - p) ** b))

    @property
    def fastest(self) -> tuple[float, float]:
        """Largest |w′| and |w″| of the weight, 1/s and 1/s².

        w′ = w (a/u − b/(1 − u)) and w″ = w ((a/u − b/(1 − u))² − a/u² − b/(1 − u)²), by u.
        """
        u, span_s = INSIDE, self.end_s - self.start_s
        a, b = self._exponents
        w = self.weight(self.start_s + u * span_s)
        slope = a / u - b / (1 - u)
        bend = slope**2 - a / u**2 - b / (1 - u) ** 2
        return float(np.max(np.abs(w * slope))) / span_s, float(
            np.max(np.abs(w * bend))
        ) / span_s**2

    @property
    def _exponents(self) -> tuple[float, float]:
        p = float(
            np.clip(
                self.peak, 3 / (3 + LARGEST_EXPONENT), LARGEST_EXPONENT / (3 + LARGEST_EXPONENT)
            )
        )
        return (3.0, 3.0 * (1 - p) / p) if p < 0.5 else (3.0 * p / (1 - p), 3.0)

    def add_to(self, q: Array, times_s: Array) -> None:
        """Add the offset to a movement at increasing times, (T, V), in place."""
        first, last = np.searchsorted(times_s, (self.start_s, self.end_s))
        rows = slice(int(first), int(last))
        q[rows, self.members] += self.weight(times_s[rows])[:, None] * self.offset
