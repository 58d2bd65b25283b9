"""Which block keys which coordinates, and when: what a picture of a movement draws."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from azee.motion.posture import KeyPosture
from azee_rig.coordinates import Coordinates


@dataclass(frozen=True, slots=True)
class Track:
    """Coordinates that one block keys, on the score's time line.

    path: names of the blocks that lead to it, outermost first; empty for the whole score.
    coordinates: their names, in the rig's order. keys_s: times of their keys, increasing.
    start_s, end_s: when the block holds them.
    """

    path: tuple[str, ...]
    coordinates: tuple[str, ...]
    keys_s: tuple[float, ...]
    start_s: float
    end_s: float


def flat_track(
    postures: Iterable[KeyPosture], coordinates: Coordinates, score_s: float
) -> tuple[Track, ...]:
    """Return the one track of a flattened score: every key posture keys the whole body."""
    keys = tuple(sorted({float(p.time) for p in postures}))
    return (Track((), tuple(coordinates.names), keys, 0.0, score_s),)
