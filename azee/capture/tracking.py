"""Markers that were swapped, jumped away or were not seen for a while.

All in the root's frame, so that the way of the hand through the room does not count.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import distance_transform_edt
from scipy.optimize import linear_sum_assignment

from azee.capture.markers import Flags, Floats

SWAP_M = 0.008
"""Two markers that together go farther than this from one frame to the next may be swapped."""
SWAP_GAIN = 0.4
"""They are, if under each other's names they go less than this share of it."""
FASTEST_M_S = 4.0
"""No marker moves faster against the root: what does is taken for something else."""
SHORT_S = 0.1
"""Gaps up to this are interpolated."""
LAG = 10
"""Frames over which speeds are measured."""
FADE_S = 0.15
"""In so long before and after longer gaps the trust in a marker fades."""


@dataclass(frozen=True, eq=False)
class Tracked:
    """Markers (T, m, 3) metres with the trust in each, (T, m).

    relabelled: (T,), frames in which markers were put under other names. gaps: (T, m), where a
    marker was not seen or not believed.
    """

    positions: Floats
    trust: Floats
    relabelled: Flags
    gaps: Flags


def tracked(positions: Floats, rate_hz: float) -> Tracked:
    """Put markers (T, m, 3) in order; NaN where one is not seen."""
    found, relabelled = _relabelled(positions)
    _drop_jumps(found, rate_hz)
    gaps = np.isnan(found[:, :, 0])
    trust = np.ones(gaps.shape)
    for m in range(found.shape[1]):
        _bridge(found[:, m], int(SHORT_S * rate_hz))
        trust[:, m] = _faded(np.isnan(found[:, m, 0]), FADE_S * rate_hz)
    return Tracked(found, trust, relabelled, gaps)


def _relabelled(positions: Floats) -> tuple[Floats, Flags]:
    """Undo swaps: where exchanging names makes the ways from frame to frame much shorter."""
    found = np.array(positions)
    ways = np.linalg.norm(found[1:, :, None] - found[:-1, None], axis=-1)  # to i, from j
    own = np.diagonal(ways, axis1=1, axis2=2)
    straight = own[:, :, None] + own[:, None, :]
    crossed = ways + np.swapaxes(ways, 1, 2)
    with np.errstate(invalid="ignore"):
        swapped = (straight > SWAP_M) & (crossed < SWAP_GAIN * straight)
    changes = np.flatnonzero(swapped.any(axis=(1, 2))) + 1
    relabelled = np.zeros(len(found), dtype=np.bool_)
    identity = np.arange(found.shape[1])
    for start, end in pairwise([*changes, len(found)]):
        before, now = found[start - 1], positions[start]
        both = np.flatnonzero(~np.isnan(before[:, 0]) & ~np.isnan(now[:, 0]))
        cost = np.linalg.norm(before[both, None] - now[None, both], axis=-1)
        order = identity.copy()
        order[both] = both[linear_sum_assignment(cost)[1]]
        if (order != identity).any():
            found[start:end] = positions[start:end, order]
            relabelled[start:end] = True
    return found, relabelled


def _drop_jumps(positions: Floats, rate_hz: float) -> None:
    """Forget markers in frames to which they would have come too fast, and come back."""
    most = FASTEST_M_S / rate_hz
    for m in range(positions.shape[1]):
        seen = np.flatnonzero(~np.isnan(positions[:, m, 0]))
        if len(seen) < 3:
            continue
        at = positions[seen, m]
        way = np.linalg.norm(np.diff(at, axis=0), axis=1)
        far = way > most * np.diff(seen)
        alone = far[:-1] & far[1:]
        positions[seen[1:-1][alone], m] = np.nan


def _bridge(way: Floats, longest: int) -> None:
    """Interpolate short gaps of one marker's way (T, 3), between frames in which it is seen."""
    missing = np.isnan(way[:, 0])
    known = np.flatnonzero(~missing)
    if len(known) < 2 or not missing.any():
        return
    gaps = np.flatnonzero(missing)
    inside = gaps[(gaps > known[0]) & (gaps < known[-1])]
    after = np.searchsorted(known, inside)
    short = inside[known[after] - known[after - 1] - 1 <= longest]
    if len(short):
        way[short] = PchipInterpolator(known, way[known])(short)


def _faded(missing: NDArray[np.bool_], fade: float) -> Floats:
    """Trust (T,) that falls smoothly to 0 where a marker is missing."""
    if not missing.any():
        return np.ones(len(missing))
    share = np.clip((distance_transform_edt(~missing)) / (fade + 1.0), 0.0, 1.0)
    return np.asarray(share * share * (3.0 - 2.0 * share))


def roughness_of(positions: Floats) -> float:
    """Return how rough markers (T, m, 3) are, metres: the noise that would explain it.

    Second differences of noise of deviation σ have the deviation √6 σ; the median is not misled by
    fast moments.
    """
    rough = np.abs(np.diff(positions, 2, axis=0))
    return float(np.nanmedian(rough)) / (0.6745 * np.sqrt(6.0)) if np.isfinite(rough).any() else 0.0


def speed_of(positions: Floats, rate_hz: float) -> float:
    """Return the speed that markers (T, m, 3) reach in a tenth of the time, metres a second.

    It is measured over `LAG` frames, so that noise does not count.
    """
    ways = np.linalg.norm(positions[LAG:] - positions[:-LAG], axis=-1)
    return float(np.nanquantile(ways, 0.9)) * rate_hz / LAG if np.isfinite(ways).any() else 0.0
