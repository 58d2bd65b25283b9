"""Tracks as rows: a row per part of the body, with a bar for every block that moves it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from azee.motion.tasks.tracks import Track

SIDES = {"L": "left", "R": "right"}
_FINGER = re.compile("(?:thumb|index|middle|ring|little)_")
"""The fingers of a hand share a row."""


@dataclass(frozen=True, slots=True)
class Bar:
    """The keys of one block for one part of the body, on the score's time line."""

    path: tuple[str, ...]
    start_s: float
    end_s: float
    keys_s: tuple[float, ...]
    coordinates: tuple[str, ...]

    @property
    def name(self) -> str:
        """The block's own name."""
        return self.path[-1] if self.path else "whole score"


@dataclass(frozen=True, slots=True)
class Row:
    """A part of the body; bars of one lane do not overlap."""

    name: str
    lanes: tuple[tuple[Bar, ...], ...]


def track_rows(tracks: Sequence[Track]) -> tuple[Row, ...]:
    """Return a row per part of the body that any track moves, in the order of its coordinates."""
    if not tracks:
        return ()
    from azee.motion.tasks.limbs import limb_of_coordinate

    bars: dict[str, list[Bar]] = {}
    for track in tracks:
        parts: dict[str, list[str]] = {}
        for coordinate in track.coordinates:
            part = _FINGER.sub("fingers_", limb_of_coordinate(coordinate))
            parts.setdefault(part, []).append(coordinate)
        for part, coordinates in parts.items():
            bar = Bar(track.path, track.start_s, track.end_s, track.keys_s, tuple(coordinates))
            bars.setdefault(part, []).append(bar)
    return tuple(Row(part_name(part), _lanes(bars[part])) for part in sorted(bars, key=_order))


def part_name(limb: str) -> str:
    """Return the name of a limb for people: `arm_R` is the right arm."""
    part, _, side = limb.partition("_")
    return f"{SIDES[side]} {part}" if side in SIDES else limb.replace("_", " ")


def _order(limb: str) -> tuple[int, str]:
    first = ("trunk", "head", "eyes", "arm_R", "fingers_R", "arm_L", "fingers_L")
    return (first.index(limb) if limb in first else len(first), limb)


def _lanes(bars: Sequence[Bar]) -> tuple[tuple[Bar, ...], ...]:
    lanes: list[list[Bar]] = []
    for bar in sorted(bars, key=lambda b: (b.start_s, b.end_s)):
        free = (lane for lane in lanes if lane[-1].end_s <= bar.start_s < bar.end_s)
        lane = next(free, None)
        if lane is None:
            lanes.append([bar])
        else:
            lane.append(bar)
    return tuple(map(tuple, lanes))
