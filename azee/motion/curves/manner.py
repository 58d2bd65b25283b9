"""Laws of time: how far a movement has got, for each manner.

With whole numbers a and b the speed of a movement is in proportion to τ^(a−1) (1 − τ)^(b−1), so
that the share of the way is the regularised incomplete beta function I(τ; a, b). a = b = 3 is
minimum jerk (Flash and Hogan 1985).
"""

from __future__ import annotations

from collections.abc import Mapping
from math import comb

import numpy as np
from numpy.typing import ArrayLike, NDArray

from azee.clip.spline import minimum_jerk
from azee_solver.constraint import Manner

Array = NDArray[np.float64]

LAWS: Mapping[Manner, tuple[int, int]] = {
    Manner.TENSE: (2, 2),
    Manner.SLOW_START: (5, 3),
    Manner.SHARP_STOP: (5, 2),
    Manner.SOFT: (4, 4),
}
"""a and b. Tense movements are nearly even; those that start slowly or stop sharply are fastest at
two thirds and at four fifths of their time; soft ones begin and end gently."""


def share_of_way(tau: ArrayLike, manner: Manner | None) -> Array:
    """Return which share of its way a movement has covered at shares of its time, from 0 to 1."""
    if manner is None:
        return minimum_jerk(tau)
    a, b = LAWS[manner]
    t = np.clip(np.asarray(tau, dtype=np.float64), 0.0, 1.0)
    n = a + b - 1
    terms = (comb(n, k) * t**k * (1.0 - t) ** (n - k) for k in range(a, n + 1))
    return np.asarray(np.clip(sum(terms, np.zeros_like(t)), 0.0, 1.0))
