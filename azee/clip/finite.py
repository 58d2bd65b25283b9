"""The numbers that a movement may hold: finite, and no larger than bodies and clocks make them.

Clips and recordings are checked here when they are made, whoever makes them: readers, writers and
all that lies between may then count on it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

LARGEST = 1e6
"""Metres, radians, weights and seconds beyond this come of a mistake; 32-bit floats hold it."""
LEAST_STEP_S = 1e-5
"""Frames nearer to each other than this, on the whole, come of a mistake."""


def check_numbers(what: str, numbers: ArrayLike) -> None:
    """Check numbers of any shape.

    Args: what: their name in the message, a plural.
    Raises: ValueError: one is infinite, not a number, or larger than `LARGEST`.
    """
    array = np.asarray(numbers, dtype=np.float64)
    if not np.isfinite(array).all():
        raise ValueError(f"{what} are infinite or not numbers")
    largest = max(-float(array.min(initial=0.0)), float(array.max(initial=0.0)))
    if largest > LARGEST:
        raise ValueError(f"{what} are as large as {largest:.3g}")


def check_times(times: ArrayLike) -> None:
    """Check the times of frames, (T,) seconds.

    Raises: ValueError: there are none, they do not increase, or frames follow each other faster
        than every `LEAST_STEP_S`.
    """
    array = np.asarray(times, dtype=np.float64)
    check_numbers("times", array)
    if not len(array) or np.any(np.diff(array) <= 0.0):
        raise ValueError("times do not increase")
    if len(array) > 1:
        step = float(array[-1] - array[0]) / (len(array) - 1)
        if step < LEAST_STEP_S:
            raise ValueError(
                f"frames follow each other every {step:.3g} s; the least is {LEAST_STEP_S:g} s"
            )
