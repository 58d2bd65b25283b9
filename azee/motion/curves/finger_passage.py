"""Fingers pass round fingers: via points of the digits of one hand between two handshapes.

From one handshape to the next every joint goes straight, which may lead a thumb through a finger
that closes over it. Where digits of a hand would enter each other between two keys, all digits that
nothing needs there get two via points each, an early and a late one. So a thumb can go before the
fingers that close over it, or wait until they have opened, and fingers can open further than either
handshape has them.

All ways of a movement are measured in one call of the kernel, so that only those that collide are
searched (see `PassageSearch`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.movement import Movement
from azee.motion.curves.passage_search import SHARES, PassageSearch, Side, via_points
from azee.motion.curves.via_points import ViaPoint
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.limbs import is_finger
from azee.score.interval import Interval

Array = NDArray[np.float64]

DEEP_M = 0.0015
"""Digits that overlap deeper, and than at both ends of the way, collide."""
LONGEST_S = 1.5
"""Longer ways return to rest meanwhile, or are no ways between handshapes."""
QUICK_S = 0.6
"""On longer ways, as from rest, skins are measured only where capsules collide."""
SIDES: tuple[Side, Side] = ("L", "R")


@dataclass(frozen=True, slots=True, eq=False)
class FingerPassage:
    """Leads the digits of each hand round each other.

    limbs_in_use: limbs that something needs, by when. Digits that touch in a handshape may be as
    near beside it as they are in it.
    """

    search: PassageSearch
    limbs_in_use: IntervalIndex[frozenset[str]]

    def via_points(self, movement: Movement) -> Iterator[ViaPoint]:
        """Yield the via points of a movement that has none yet."""
        for side in SIDES:
            ways = [*self._ways(movement, side)]
            for way, (q, depths) in zip(ways, self._measured(movement, ways, side), strict=True):
                deepest = depths.max(axis=0)
                collides = np.any(
                    deepest > np.maximum(DEEP_M, depths[[0, -1]].max(axis=0) + DEEP_M)
                )
                near = self.search.hands[side].thumb.near(depths[1:-1]).any()
                moves = np.ptp(q[:, self.search.hands[side].coordinates], axis=0).any()
                quick = way.end_s - way.start_s <= QUICK_S
                if moves and (collides or (quick and near)):
                    yield from self._round(movement, way, q, side)

    def _ways(self, movement: Movement, side: str) -> Iterator[_Way]:
        """Yield the ways between keys in which digits of a hand move and nothing needs them."""
        limbs = [n for n in movement.limbs.names if is_finger(n) and n.endswith(f"_{side}")]
        times = sorted({key.time_s for limb in limbs for key in movement.curves[limb].keys})
        for start_s, end_s in pairwise(times):
            if not 1e-3 < end_s - start_s <= LONGEST_S:
                continue
            span = Interval(
                Fraction(start_s).limit_denominator(10**6),
                Fraction(end_s).limit_denominator(10**6),
            )
            needed = [
                limb
                for interval, used in self.limbs_in_use.overlapping_entries(span)
                if min(float(interval.end), end_s) - max(float(interval.start), start_s) > 1e-6
                for limb in used
            ]
            free = tuple(limb for limb in limbs if limb not in needed)
            if free:
                yield _Way(free, start_s, end_s)

    def _measured(
        self, movement: Movement, ways: Sequence[_Way], side: Side
    ) -> Iterator[tuple[Array, Array]]:
        """Yield the samples of every way, (T, V), and the depths of the hand's pairs, (T, P) m."""
        if not ways:
            return
        overlaps, pairs = self.search.overlaps, self.search.hands[side].pairs
        q = np.concatenate([movement.sample(way.times) for way in ways])
        depths = overlaps.depths(q, overlaps.axis_distances(()), pairs)
        yield from zip(np.split(q, len(ways)), np.split(depths, len(ways)), strict=True)

    def _round(self, movement: Movement, way: _Way, q: Array, side: Side) -> Sequence[ViaPoint]:
        """Return the via points with which a way leads round, none if it cannot."""
        members = np.concatenate([movement.limbs.members[limb] for limb in way.limbs])
        offsets = self.search.offsets(q, members, way.end_s - way.start_s, side)
        if offsets is None:
            return []
        bells = via_points(members, way.start_s, way.end_s)
        parts = np.split(offsets, len(bells))
        return [replace(bell, offset=part) for bell, part in zip(bells, parts, strict=True)]


@dataclass(frozen=True, slots=True)
class _Way:
    """Digits of a hand that are free between two keys."""

    limbs: tuple[str, ...]
    start_s: float
    end_s: float

    @property
    def times(self) -> Array:
        """Instants at which it is measured, ends included."""
        return self.start_s + (self.end_s - self.start_s) * SHARES
