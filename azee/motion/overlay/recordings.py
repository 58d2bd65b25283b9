"""What recordings change in the overlays: less life where they have their own, and their faces."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.overlay.face import RAMP_S
from azee.motion.tasks.recordings import RecordedBlock

Array = NDArray[np.float64]

LIFE_RAMP_S = 0.4
"""In this time before and after a recording the life of a body fades; its own is in the frames."""


def life_share(blocks: Iterable[RecordedBlock], times_s: Array, count: int) -> Array:
    """Return the share of life that each of `count` coordinates keeps at times, (T, V), 0 to 1."""
    out = np.ones((len(times_s), count))
    for block in blocks:
        there = _ramped(block, times_s, LIFE_RAMP_S)
        out[:, block.members] = np.minimum(out[:, block.members], 1.0 - there[:, None])
    return out


def recorded_face(blocks: Iterable[RecordedBlock], units: Sequence[str], times_s: Array) -> Array:
    """Return what recordings add to the weights of face units at increasing times, (T, units)."""
    out = np.zeros((len(times_s), len(units)))
    for block in blocks:
        columns = [units.index(unit) for unit in block.clip.units]
        out[:, columns] += _ramped(block, times_s, RAMP_S)[:, None] * block.face(times_s)
    return out


def _ramped(block: RecordedBlock, times_s: Array, ramp_s: float) -> Array:
    """Return 1 while a recording plays, with ramps of minimum jerk before and after, (T,)."""
    rise = minimum_jerk((times_s - block.start_s) / ramp_s + 1.0)
    fall = minimum_jerk((block.end_s - times_s) / ramp_s + 1.0)
    return np.minimum(rise, fall)
