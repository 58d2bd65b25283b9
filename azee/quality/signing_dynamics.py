"""How people and signers move their hands and head, in figures that need nothing but five points.

The same code measures a body of ours, the landmarks of a tracker on our films, and the same
tracker's landmarks of people: shoulders, wrists and nose in the frontal plane. Positions are
scaled until the shoulders are `SHOULDERS_M` apart and averaged over three frames, which takes off
some of a tracker's noise; speeds are first differences of what is left.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SHOULDERS_M = 0.36
"""Between the shoulders of an adult, as trackers mark them; all recordings are scaled to it."""
WINDOW = 3
"""Frames that positions are averaged over."""
STOPPED_M_S = 0.1
"""A slower wrist counts as stopped."""
HEAD_STILL_M_S = 0.01
"""A slower head counts as still."""
FPS = 25.0
"""Of most recordings of people; figures of other rates differ, for the window is in frames."""


@dataclass(frozen=True, slots=True)
class WristSpeeds:
    """Speeds of one wrist over a recording, m/s: the median, the 95th percentile, the largest."""

    median_m_s: float
    p95_m_s: float
    largest_m_s: float


@dataclass(frozen=True, slots=True)
class SigningDynamics:
    """Figures of one recording; none where its points were not seen.

    both_stopped_share: of frames in which both wrists are below `STOPPED_M_S`.
    head_longest_still_s: longest time that the nose stays below `HEAD_STILL_M_S`.
    """

    right_wrist: WristSpeeds | None
    left_wrist: WristSpeeds | None
    both_stopped_share: float | None
    head_mean_cm_s: float | None
    head_p95_cm_s: float | None
    head_longest_still_s: float | None
    shoulders_mean_cm_s: float | None


def averaged(positions: Array) -> Array:
    """Return means over `WINDOW` frames, (T − 2, …) of (T, …); empty where there are fewer."""
    if len(positions) < WINDOW:
        return np.asarray(positions[:0])
    count = len(positions) - WINDOW + 1
    return np.asarray(sum(positions[n : n + count] for n in range(WINDOW)) / WINDOW)


def speeds(positions: Array, fps: float) -> Array:
    """Return speeds (T − 3,) of a point (T, D), averaged over three frames, in its unit a second.

    The n-th lies half-way between frames n + 1 and n + 2.
    """
    return np.asarray(np.linalg.norm(np.diff(averaged(positions), axis=0), axis=1) * fps)


def accelerations(positions: Array, fps: float) -> Array:
    """Return sizes of accelerations (T − 4,) of a point (T, D), averaged over three frames.

    The n-th lies at frame n + 2: the second difference of the averages, times fps².
    """
    return np.asarray(np.linalg.norm(np.diff(averaged(positions), 2, axis=0), axis=1) * fps**2)


def runs(hits: NDArray[np.bool_]) -> list[NDArray[np.int64]]:
    """Return the indices of each run of what is true, in order."""
    rows = np.flatnonzero(hits)
    return [run for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1) if len(run)]


def longest_run(hits: NDArray[np.bool_]) -> int:
    """Return the length of the longest run of what is true."""
    return max((len(run) for run in runs(hits)), default=0)


def signing_dynamics(points: Array, fps: float) -> SigningDynamics:
    """Measure a recording of left and right shoulder, left and right wrist, and nose.

    Args: points: (T, 5, 2) in any unit, seen from the front; a point that was never seen is NaN.
    """
    width = np.median(np.linalg.norm(points[:, 0] - points[:, 1], axis=1))
    metres = points / width * SHOULDERS_M
    left, right, nose = (_seen(speeds(metres[:, i], fps)) for i in (2, 3, 4))
    shoulders = _seen(speeds((metres[:, 0] + metres[:, 1]) / 2.0, fps))
    both = None if left is None or right is None else np.maximum(left, right) < STOPPED_M_S
    return SigningDynamics(
        right_wrist=_wrist(right),
        left_wrist=_wrist(left),
        both_stopped_share=None if both is None else float(both.mean()),
        head_mean_cm_s=None if nose is None else 100.0 * float(nose.mean()),
        head_p95_cm_s=None if nose is None else 100.0 * float(np.percentile(nose, 95)),
        head_longest_still_s=None if nose is None else longest_run(nose < HEAD_STILL_M_S) / fps,
        shoulders_mean_cm_s=None if shoulders is None else 100.0 * float(shoulders.mean()),
    )


def _seen(values: Array) -> Array | None:
    return values if len(values) and np.all(np.isfinite(values)) else None


def _wrist(values: Array | None) -> WristSpeeds | None:
    if values is None:
        return None
    return WristSpeeds(
        float(np.median(values)), float(np.percentile(values, 95)), float(values.max())
    )
