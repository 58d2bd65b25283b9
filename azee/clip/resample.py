"""Samples a clip at other times: the C² spline through its frames, within the limits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from azee.clip.clip import Clip
from azee.clip.spline import cubic_spline
from azee_rig.coordinates import Coordinates

Array = NDArray[np.float64]

EVEN_S = 1e-6
"""Up to this difference of lengths, frames count as evenly spaced."""
MOST_FRAMES = 500_000
"""More than four hours at 30 frames a second: a larger number is a mistake."""


class TooManyFramesError(ValueError):
    """A clip with too many frames."""


def sampled(clip: Clip, times: ArrayLike, coordinates: Coordinates) -> Clip:
    """Return the clip at other times, (T,) increasing; the spline passes through its frames.

    Between frames there is a cubic spline. Where it overshoots, it is clamped to the limits, and
    face weights to their least and largest values. Before the first and after the last frame the
    clip stands still. Labels stay.
    """
    at = np.asarray(times, dtype=np.float64)
    columns = np.hstack([clip.coordinates, clip.unit_weights])
    if len(clip.times) > 1:
        inside = np.clip(at, clip.times[0], clip.times[-1])
        values = cubic_spline(clip.times, columns, inside)
        nearest = np.clip(np.searchsorted(clip.times, inside), 0, len(clip.times) - 1)
        exact = clip.times[nearest] == inside
        values[exact] = columns[nearest[exact]]
    else:
        values = np.repeat(columns, len(at), axis=0)
    q, weights = np.split(values, [clip.coordinates.shape[1]], axis=1)
    return replace(
        clip,
        times=at,
        coordinates=np.clip(q, coordinates.lower, coordinates.upper),
        unit_weights=np.clip(weights, *_extremes(clip.unit_weights)),
    )


def at_rate(clip: Clip, fps: float, coordinates: Coordinates) -> Clip:
    """Return the clip with evenly spaced frames, from its first time on.

    The last frame is the last one within the clip's own length.
    Raises: ValueError: the rate is not positive. TooManyFramesError: more than `MOST_FRAMES`.
    """
    if not (np.isfinite(fps) and fps > 0):
        raise ValueError(f"{fps} frames per second make no clip")
    count = frame_count(clip.duration_s, fps)
    times = clip.times[0] + np.arange(count) / fps
    return sampled(clip, times, coordinates)


def frame_count(duration_s: float, fps: float) -> int:
    """Return the number of frames within a length. Raises: TooManyFramesError: too many."""
    frames = np.floor(duration_s * fps + fps * EVEN_S) + 1
    if not frames <= MOST_FRAMES:
        raise TooManyFramesError(
            f"{duration_s:g} s at {fps:g} frames a second are {frames:,.0f} frames, "
            f"more than {MOST_FRAMES:,}"
        )
    return int(frames)


def rate(clip: Clip) -> float | None:
    """Frames per second of a clip with two frames or more, None if they are not evenly spaced."""
    if len(clip.times) < 2:
        return None
    step = clip.duration_s / (len(clip.times) - 1)
    return 1.0 / step if np.abs(np.diff(clip.times) - step).max() <= EVEN_S else None


def _extremes(weights: Array) -> tuple[Array, Array]:
    return weights.min(axis=0), weights.max(axis=0)
