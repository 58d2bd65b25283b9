"""Unspoken life: blinks, breathing and sway, low, seeded, and never on what a score constrains."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.overlay.face import busy
from azee.motion.tasks.timed_task import Bound
from azee_rig.coordinates import Coordinates

Array = NDArray[np.float64]

BEFORE_S, AFTER_S = 0.3, 0.5
"""How long the signer stands idle before the first and after the last movement, at least."""

BLINK = "AU43"
BLINK_GAPS_S = (1.8, 5.5)
CLOSE_S, OPEN_S = 0.07, 0.13

BREATH_S = 3.6
BREATH_RAD: Mapping[str, float] = {
    "back_2.flexion": math.radians(-0.5),
    "clav_L.elevation": math.radians(0.5),
    "clav_R.elevation": math.radians(0.5),
}
"""Amplitude of one breath, in and out. It moves arms and head along, so it rests with them."""
BREATH_FADE_S = 0.4

SWAY_S = (5.9, 8.3)
"""Two periods whose sum never repeats itself soon."""
SWAY_RAD: Mapping[str, float] = {
    "back_1.lateral": math.radians(0.3),
    "back_1.axial": math.radians(0.25),
    "head.axial": math.radians(0.5),
    "neck.flexion": math.radians(0.3),
}
"""Amplitude of the shifting of weight of somebody who stands, and of a head that is held up."""


def blinks(
    units: Mapping[str, float],
    names: tuple[str, ...],
    faces: Iterable[Bound],
    times_s: Array,
    rng: np.random.Generator,
) -> Array:
    """Return the weights that blinks add to face units at times, (T, len(names)).

    Args: units: weights of the units that close the eyes. faces: facial blocks; a blink that
        would fall on one is left out.
    """  # fmt: skip
    out = np.zeros((len(times_s), len(names)))
    taken = busy(faces, times_s)
    time = float(times_s[0]) + rng.uniform(0.3, BLINK_GAPS_S[1])
    while time < times_s[-1]:
        during = (times_s >= time) & (times_s <= time + CLOSE_S + OPEN_S)
        if not np.any(taken & during):
            curve = minimum_jerk((times_s - time) / CLOSE_S)
            curve = curve - minimum_jerk((times_s - time - CLOSE_S) / OPEN_S)
            for unit, weight in units.items():
                out[:, names.index(unit)] += weight * curve
        time += rng.uniform(*BLINK_GAPS_S)
    return out


def breathing(
    coordinates: Coordinates, required: Iterable[Bound], times_s: Array, rng: np.random.Generator
) -> Array:
    """Return what breathing adds to coordinates at times, (T, V).

    Args: required: everything that asks something of the posture; breathing fades out before each
        block and comes back after it.
    """
    out = np.zeros((len(times_s), len(coordinates)))
    phase = rng.uniform(0.0, 2.0 * math.pi)
    free = minimum_jerk(_away_s(required, times_s) / BREATH_FADE_S)
    wave = free * 0.5 * (1.0 - np.cos(2.0 * math.pi * times_s / BREATH_S + phase))
    for name, amplitude in BREATH_RAD.items():
        if name in coordinates.index:
            out[:, coordinates.index[name]] = amplitude * wave
    return out


def swaying(
    coordinates: Coordinates, required: Iterable[Bound], times_s: Array, rng: np.random.Generator
) -> Array:
    """Return what standing unsupported adds to coordinates at times, (T, V).

    Args: required: as for `breathing`, and with the same fading.
    """
    out = np.zeros((len(times_s), len(coordinates)))
    free = minimum_jerk(_away_s(required, times_s) / BREATH_FADE_S)
    for name, amplitude in SWAY_RAD.items():
        phases = rng.uniform(0.0, 2.0 * math.pi, len(SWAY_S))
        if name in coordinates.index:
            waves = (
                np.sin(2.0 * math.pi * times_s / s + p) for s, p in zip(SWAY_S, phases, strict=True)
            )
            out[:, coordinates.index[name]] = amplitude * free * np.sum([*waves], axis=0) / 2.0
    return out


def _away_s(required: Iterable[Bound], times_s: Array) -> Array:
    """Return how far in time the nearest block is, (T,) seconds; 0 inside one."""
    spans = sorted((b.requirement.interval.start, b.requirement.interval.end) for b in required)
    if not spans:
        return np.full(len(times_s), math.inf)
    starts = np.array([float(start) for start, _ in spans])
    reached = np.maximum.accumulate(np.array([float(end) for _, end in spans]))
    k = np.searchsorted(starts, times_s, side="right")
    since = np.where(k > 0, times_s - reached[np.maximum(k, 1) - 1], math.inf)
    until = np.where(k < len(starts), starts[np.minimum(k, len(starts) - 1)] - times_s, math.inf)
    return np.asarray(np.maximum(0.0, np.minimum(since, until)))
