"""Variations of a compilation that need no solving: another hand, another speed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

from azee.animation import Animation
from azee.clip.clip import Clip
from azee.clip.edit import left_handed, retimed
from azee.clip.resample import at_rate
from azee.compilation import Compilation, Hand
from azee.score.stretch import warped


@dataclass(frozen=True, slots=True)
class Variation:
    """Which of the variations of a text on a body; without a seed, that of the score."""

    hand: Hand
    seed: int | None
    speed: float


def varied(made: Compilation, variation: Variation) -> Compilation:
    """Return a compilation as another hand signs it, and faster or slower.

    Frames are as many a second as before. Score, keys and tracks have the times of the clip. The
    report stays that of the compilation as it was solved.
    """
    clip = made.clip
    if variation.hand == "left":
        clip = left_handed(clip, made.rig.coordinates)
    if variation.speed == 1.0:
        return _with(made, clip)
    factor = 1 / Fraction(str(variation.speed))
    if clip.duration_s:
        clip = retimed(clip, clip.duration_s * float(factor))
    clip = at_rate(clip, made.report.fps, made.rig.coordinates)
    score = warped(made.score, lambda time: time * factor)
    return replace(_with(made, clip, float(factor)), score=score)


def _with(made: Compilation, clip: Clip, factor: float = 1.0) -> Compilation:
    before = made.animation
    animation: Animation = replace(
        before,
        clip=clip,
        key_times=tuple(factor * time for time in before.key_times),
        lead_s=factor * before.lead_s,
        tracks=tuple(
            replace(
                track,
                keys_s=tuple(factor * time for time in track.keys_s),
                start_s=factor * track.start_s,
                end_s=factor * track.end_s,
            )
            for track in before.tracks
        ),
    )
    return replace(made, animation=animation)
