"""Idle motion: breathing and sway; small, seeded, never on what a score constrains."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.tasks.timed_task import TimedTask
from azee_rig.coordinates import Coordinates

Array = NDArray[np.float64]

BEFORE_S, AFTER_S = 0.3, 0.5
"""How long the signer stands in the neutral posture before and after all movement, at least."""

BREATH_S = 3.6
BREATH_RAD: Mapping[str, float] = {
    "back_2.flexion": math.radians(-0.5),
    "clav_L.elevation": math.radians(0.5),
    "clav_R.elevation": math.radians(0.5),
}
"""Amplitude of one breath, in and out. It moves arms and head too, so it fades out with them."""
BREATH_FADE_S = 0.4

SWAY_S = (5.9, 8.3)
"""Two periods; the sum of the two waves repeats itself only after minutes."""
SWAY_RAD: Mapping[str, float] = {
    "back_1.lateral": math.radians(0.3),
    "back_1.axial": math.radians(0.25),
    "head.axial": math.radians(0.5),
    "neck.flexion": math.radians(0.3),
}
"""Amplitude with which somebody who stands shifts their weight and balances their head."""


def breathing(
    coordinates: Coordinates, tasks: Iterable[TimedTask], times_s: Array, rng: np.random.Generator
) -> Array:
    """Return what breathing adds to coordinates at times, (T, V).

    A wave ½(1 − cos(2πt/BREATH_S + φ)) times the amplitude, with a random φ.

    Args: tasks: everything that moves the skeleton; breathing fades out before each block and
        comes back after it.
    """
    out = np.zeros((len(times_s), len(coordinates)))
    phase = rng.uniform(0.0, 2.0 * math.pi)
    fade = minimum_jerk(_to_nearest_block_s(tasks, times_s) / BREATH_FADE_S)
    wave = fade * 0.5 * (1.0 - np.cos(2.0 * math.pi * times_s / BREATH_S + phase))
    for name, amplitude in BREATH_RAD.items():
        if name in coordinates.index:
            out[:, coordinates.index[name]] = amplitude * wave
    return out


def swaying(
    coordinates: Coordinates, tasks: Iterable[TimedTask], times_s: Array, rng: np.random.Generator
) -> Array:
    """Return what swaying adds to coordinates at times, (T, V).

    The mean of two sine waves of the periods `SWAY_S` and random phases, times the amplitude.

    Args: tasks: as for `breathing`, and with the same fading.
    """
    out = np.zeros((len(times_s), len(coordinates)))
    fade = minimum_jerk(_to_nearest_block_s(tasks, times_s) / BREATH_FADE_S)
    for name, amplitude in SWAY_RAD.items():
        phases = rng.uniform(0.0, 2.0 * math.pi, len(SWAY_S))
        if name in coordinates.index:
            waves = (
                np.sin(2.0 * math.pi * times_s / s + p) for s, p in zip(SWAY_S, phases, strict=True)
            )
            out[:, coordinates.index[name]] = amplitude * fade * np.sum([*waves], axis=0) / 2.0
    return out


def _to_nearest_block_s(tasks: Iterable[TimedTask], times_s: Array) -> Array:
    """Return how far in time the nearest block is, (T,) seconds; 0 inside one."""
    spans = sorted((t.interval.start, t.interval.end) for t in tasks)
    if not spans:
        return np.full(len(times_s), math.inf)
    starts = np.array([float(start) for start, _ in spans])
    latest_end = np.maximum.accumulate(np.array([float(end) for _, end in spans]))
    k = np.searchsorted(starts, times_s, side="right")
    since = np.where(k > 0, times_s - latest_end[np.maximum(k, 1) - 1], math.inf)
    until = np.where(k < len(starts), starts[np.minimum(k, len(starts) - 1)] - times_s, math.inf)
    return np.asarray(np.maximum(0.0, np.minimum(since, until)))
