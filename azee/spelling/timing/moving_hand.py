"""The angles of a hand that spells a word at given times: to try alignment and warping on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee.spelling.timing.letter_poses import LetterPoses
from azee.spelling.timing.timed_word import TimedWord

Array = NDArray[np.float64]


def spelled_angles(
    word: TimedWord,
    poses: LetterPoses,
    rate_hz: float,
    rng: np.random.Generator,
    *,
    coarticulation_rad: float = 0.08,
    noise_rad: float = 0.004,
) -> Array:
    """Return the angles of a hand, (T, joints) radians: minimum-jerk ways between held letters.

    Each letter is off by a deviation of its own, each frame by noise. The hand starts and ends
    with its first and last hold.
    """
    letters = poses.of(word.word)
    letters = letters + rng.normal(0, coarticulation_rad, letters.shape)
    spans = word.hold_spans_s
    times = np.arange(round(word.duration_s * rate_hz) + 1) / rate_hz
    bounds = np.array([time for span in spans for time in span])
    index = np.clip(np.searchsorted(bounds, times, side="right") - 1, 0, len(bounds) - 1)
    start = bounds[index]
    length = np.append(np.diff(bounds), 1.0)[index]
    s = np.clip((times - start) / length, 0, 1)[:, None]
    moved = s**3 * (10 - 15 * s + 6 * s**2)
    here, there = letters[index // 2], letters[np.minimum((index + 1) // 2, len(letters) - 1)]
    angles = here + moved * (there - here)
    return np.asarray(angles + rng.normal(0, noise_rad, angles.shape))
