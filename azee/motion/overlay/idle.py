"""Blinks, and how long the signer stands before and after."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.overlay.face import is_active
from azee.motion.tasks.timed_task import TimedTask

Array = NDArray[np.float64]

BEFORE_S, AFTER_S = 0.3, 0.5
"""How long the signer stands in the neutral posture before and after all movement, at least."""

BLINK = "AU43"
BLINK_GAPS_S = (1.8, 5.5)
CLOSE_S, OPEN_S = 0.07, 0.13


def blinks(
    units: Mapping[str, float],
    names: tuple[str, ...],
    facial_morphs: Iterable[TimedTask],
    times_s: Array,
    rng: np.random.Generator,
) -> Array:
    """Return the weights that blinks add to face units at times, (T, len(names)).

    Args: units: weights of the units that close the eyes. facial_morphs: a blink that would
        coincide with one is left out.
    """
    out = np.zeros((len(times_s), len(names)))
    active = is_active(facial_morphs, times_s)
    time = float(times_s[0]) + rng.uniform(0.3, BLINK_GAPS_S[1])
    while time < times_s[-1]:
        during = (times_s >= time) & (times_s <= time + CLOSE_S + OPEN_S)
        if not np.any(active & during):
            curve = minimum_jerk((times_s - time) / CLOSE_S)
            curve = curve - minimum_jerk((times_s - time - CLOSE_S) / OPEN_S)
            for unit, weight in units.items():
                out[:, names.index(unit)] += weight * curve
        time += rng.uniform(*BLINK_GAPS_S)
    return out
