"""The cone filter: a moving mean whose weights fall evenly to both sides."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import convolve1d

from azee.capture.markers import Floats

RATE_HZ = 120.0
"""Of Wheatland's recordings, to which numbers of taps refer."""
NEAREST_TAPS, COMPONENT_TAPS = 15, 17
"""Published widths: of markers after nearest neighbours, of components after regression."""


def taps_at(rate_hz: float, taps: int) -> int:
    """Return the odd number of taps that lasts as long at another rate as `taps` at 120 Hz."""
    half = round((taps + 1) / 2 * rate_hz / RATE_HZ)
    return 2 * max(half, 1) - 1


def cone_filter(values: Floats, taps: int) -> Floats:
    """Return values (T, …) smoothed over time by a cone of `taps` weights, an odd number.

    At the ends the cone is cut off and its weights sum to one again.
    """
    half = (taps + 1) // 2
    weights = (half - np.abs(np.arange(taps) - (half - 1))).astype(np.float64)
    total = convolve1d(np.ones(len(values)), weights, mode="constant")
    summed = convolve1d(values, weights, axis=0, mode="constant")
    return np.asarray(summed / total.reshape(-1, *[1] * (values.ndim - 1)))
