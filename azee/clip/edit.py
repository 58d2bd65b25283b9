"""Parts of clips, other speeds, the other hand: what is done to one clip."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from azee.clip.clip import Clip, Label
from azee.clip.finite import LEAST_STEP_S
from azee.clip.resample import sampled
from azee_rig.coordinates import Coordinates
from azee_rig.mirror import mirrored, mirrored_units

APART_S = LEAST_STEP_S
"""Times that are nearer are one: files round them."""


def cut(clip: Clip, start_s: float, end_s: float, coordinates: Coordinates) -> Clip:
    """Return the clip from one time to another, its frames counted from 0.

    There is a frame at each cut: where the clip has none, one is sampled, and takes the place of
    frames that are no farther than a rounding error. Labels keep what of them lies inside.

    Raises: ValueError: the times are not in order or outside the clip.
    """
    first, last = float(clip.times[0]), float(clip.times[-1])
    if not first <= start_s <= end_s <= last:
        raise ValueError(
            f"{start_s:g} s to {end_s:g} s is no part of a clip from {first:g} s to {last:g} s"
        )
    between = clip.times[(clip.times > start_s + APART_S) & (clip.times < end_s - APART_S)]
    last_s = [end_s] if end_s - start_s > APART_S else []
    times = np.r_[start_s, between, last_s]
    part = sampled(clip, times, coordinates)
    kept = [
        Label(label.path, max(label.start_s, start_s), min(label.end_s, end_s))
        for label in clip.labels
        if (label.start_s < end_s and label.end_s > start_s)
        or start_s <= label.start_s == label.end_s <= end_s
    ]
    return shifted(replace(part, labels=tuple(kept)), -start_s)


def shifted(clip: Clip, by_s: float) -> Clip:
    """Return the clip with all its times later by so many seconds."""
    return replace(
        clip,
        times=clip.times + by_s,
        labels=tuple(Label(x.path, x.start_s + by_s, x.end_s + by_s) for x in clip.labels),
    )


def retimed(clip: Clip, duration_s: float) -> Clip:
    """Return the clip slower or faster, so that it lasts so long; its frames move with it.

    Raises: ValueError: the length is none, or the clip is a still.
    """
    if not (math.isfinite(duration_s) and duration_s > 0):
        raise ValueError(f"a clip cannot last {duration_s:g} s")
    if clip.duration_s == 0.0:
        raise ValueError("a clip of one frame has no length that could change")
    first, factor = float(clip.times[0]), duration_s / clip.duration_s

    def moved(time_s: float) -> float:
        return first + factor * (time_s - first)

    return replace(
        clip,
        times=first + factor * (clip.times - first),
        labels=tuple(Label(x.path, moved(x.start_s), moved(x.end_s)) for x in clip.labels),
    )


def left_handed(clip: Clip, coordinates: Coordinates) -> Clip:
    """Return the mirror image: a right-handed signer's clip as a left-handed one signs it.

    Labels stay: it is the same utterance. Twice is as if never.
    """
    q = np.clip(mirrored(coordinates, clip.coordinates), coordinates.lower, coordinates.upper)
    return replace(clip, coordinates=q, units=mirrored_units(clip.units))
