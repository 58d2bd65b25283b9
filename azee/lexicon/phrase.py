"""Timed movements of hands: moments with postures, ways between them, and trills."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from azee.lexicon.hands import Hand
from azee.lexicon.places import Site
from azee.lexicon.vectors import Vector


@dataclass(frozen=True, slots=True)
class StraightWay:
    """A straight way."""


@dataclass(frozen=True, slots=True)
class ArcWay:
    """An arc that bulges by a vector, in metres."""

    bulge: Vector


@dataclass(frozen=True, slots=True)
class CircleWay:
    """Turns about an axis, right-handed.

    phase: where it starts, in degrees beyond the highest point. ratio: its height over its width.
    """

    axis: Vector
    radius_m: float
    turns: float
    phase: int = 0
    ratio: float = 1.0


@dataclass(frozen=True, slots=True)
class ZigzagWay:
    """A way with corners, or with waves, to the side of a vector and to the other."""

    side: Vector
    is_wave: bool = False


SAME_S = 1e-6
"""Times nearer than this are one."""

Way: TypeAlias = StraightWay | ArcWay | CircleWay | ZigzagWay


@dataclass(frozen=True, slots=True)
class Moment:
    """What one hand is like at a time."""

    time_s: float
    name: str
    hand: Hand


@dataclass(frozen=True, slots=True)
class Move:
    """A way of one hand between two times."""

    start_s: float
    end_s: float
    name: str
    way: Way
    site: Site | None = None

    @property
    def length_s(self) -> float:
        """How long it takes."""
        return self.end_s - self.start_s


@dataclass(frozen=True, slots=True)
class Tremor:
    """A trill of one bone between two times, as AZee writes it without its frequency."""

    start_s: float
    end_s: float
    text: str


@dataclass(frozen=True, slots=True)
class Phrase:
    """A movement with its inner moments; its first and last moments are those of its user."""

    duration_s: float = 0.0
    moments: Sequence[Moment] = ()
    moves: Sequence[Move] = ()
    tremors: Sequence[Tremor] = ()

    def at(self, start_s: float, factor: float = 1.0) -> Phrase:
        """Return it stretched by a factor, then later."""

        def when(time_s: float) -> float:
            return start_s + time_s * factor

        return Phrase(
            self.duration_s * factor,
            [replace(m, time_s=when(m.time_s)) for m in self.moments],
            [replace(m, start_s=when(m.start_s), end_s=when(m.end_s)) for m in self.moves],
            [replace(t, start_s=when(t.start_s), end_s=when(t.end_s)) for t in self.tremors],
        )


def together(phrases: Iterable[Phrase]) -> Phrase:
    """Return phrases at the same time, all stretched to the longest.

    A hand that goes straight and in circles at once goes one way: what is straight moves its end.
    """
    parts = list(phrases)
    longest = max((p.duration_s for p in parts), default=0.0)
    stretched = [p.at(0, longest / p.duration_s if p.duration_s else 1.0) for p in parts]
    whole = joined(longest, stretched)
    return replace(whole, moves=[m for m in whole.moves if not _is_within(m, whole.moves)])


def _is_within(straight: Move, moves: Sequence[Move]) -> bool:
    """Whether a straight way of a hand is part of other ways that it goes meanwhile."""
    if not isinstance(straight.way, StraightWay):
        return False
    meanwhile = [
        m
        for m in moves
        if m is not straight
        and m.name == straight.name
        and m.start_s < straight.end_s - SAME_S
        and m.end_s > straight.start_s + SAME_S
    ]
    return any(
        not isinstance(m.way, StraightWay) or m.length_s < straight.length_s - SAME_S
        for m in meanwhile
    )


def joined(duration_s: float, parts: Sequence[Phrase]) -> Phrase:
    """Return phrases that have their place in time already, as one."""
    return Phrase(
        duration_s,
        [m for p in parts for m in p.moments],
        [m for p in parts for m in p.moves],
        [t for p in parts for t in p.tremors],
    )
