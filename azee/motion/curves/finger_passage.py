"""Fingers pass round fingers: via points of the digits of one hand between two handshapes.

From one handshape to the next every joint goes straight, which may lead a thumb through a finger
that closes over it. Where digits of a hand would enter each other between two keys, all digits that
nothing needs there get two via points each, an early and a late one. So a thumb can go before the
fingers that close over it, or wait until they have opened, and fingers can open further than either
handshape has them.

A search that starts from straight ways alone stays on the wrong side of the finger. It is therefore
started from several ways in which people do it (`_starts`), in the order of what they cost, until
one leads round. All ways of a movement are measured in one call of the kernel, so that only those
that collide are searched.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.capsule_overlap import CapsuleOverlaps
from azee.motion.curves.movement import Movement
from azee.motion.curves.offset_search import Offset, OffsetSearch
from azee.motion.curves.via_points import ViaPoint
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.limbs import is_finger
from azee.score.interval import Interval

Array = NDArray[np.float64]

DEEP_M = 0.0015
"""Digits that overlap deeper, and than at both ends of the way, collide."""
SAMPLES = 12
"""On a way, its ends not counted."""
LONGEST_S = 1.5
"""Longer ways return to rest meanwhile, or are no ways between handshapes."""
PEAKS = (0.3, 0.6)
"""When the early and the late via point are whole, as shares of the way."""
MOST_RAD_S, MOST_RAD_S2 = math.radians(1200.0), math.radians(40_000.0)
"""Largest speed and acceleration that an offset adds to a joint of a finger."""
PRICE_M = 0.002
"""An offset of one radian costs as much as this overlap in one sample."""
STEP_RAD = 0.35
ENOUGH_M = 0.0005
"""A way on which no pair lacks more is good."""
WORTHWHILE = 0.9
"""Offsets are used if they leave at most this share of the shortfall."""
TRIES = 8
"""So many starts are searched from."""

_OPEN = {
    **{f"{finger}_{{S}}_1.flexion": -0.35 for finger in ("index", "middle", "ring", "little")},
    **{f"{finger}_{{S}}_2.flexion": -0.5 for finger in ("index", "middle", "ring", "little")},
    **{f"{finger}_{{S}}_3.flexion": -0.2 for finger in ("index", "middle", "ring", "little")},
}
"""Fingers that let a thumb pass below them, radians."""
_ASIDE = {"thumb_{S}_1.flexion": -0.5, "thumb_{S}_3.flexion": -0.3}
"""A thumb beside the hand."""
_BEFORE = {"thumb_{S}_1.abduction": 0.5, "thumb_{S}_2.flexion": -0.3, "thumb_{S}_3.flexion": -0.4}
"""A thumb before the fingers."""


@dataclass(frozen=True, slots=True, eq=False)
class FingerPassage:
    """Leads the digits of each hand round each other.

    limbs_in_use: limbs that something needs, by when. Digits that touch in a handshape may be as
    near beside it as they are in it.
    """

    overlaps: CapsuleOverlaps
    limbs_in_use: IntervalIndex[frozenset[str]]
    _found: dict[bytes, Array | None] = field(default_factory=dict)
    """Offsets of ways that were searched, by what they lead from and to."""

    def via_points(self, movement: Movement) -> Iterator[ViaPoint]:
        """Yield the via points of a movement that has none yet."""
        for side in ("L", "R"):
            ways = [*self._ways(movement, side)]
            for way, depths in zip(ways, self._depths(movement, ways, side), strict=True):
                deepest = depths.max(axis=0)
                if np.any(deepest > np.maximum(DEEP_M, depths[[0, -1]].max(axis=0) + DEEP_M)):
                    yield from self._round(movement, way, side)

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

    def _depths(self, movement: Movement, ways: Sequence[_Way], side: str) -> Iterator[Array]:
        """Yield the depths of the hand's pairs on every way, (T, P) metres."""
        if not ways:
            return
        q = np.concatenate([movement.sample(way.times) for way in ways])
        of_hand = self._pairs(side)
        reach = self.overlaps.axis_distances(())
        yield from np.split(self.overlaps.depths(q, reach, of_hand), len(ways))

    def _pairs(self, side: str) -> NDArray[np.int64]:
        """Return the pairs of digits of a hand."""
        own = np.flatnonzero(self.overlaps.same_hand)
        return own[[f"_{side}_" in self.overlaps.names(pair)[0] for pair in own.tolist()]]

    def _round(self, movement: Movement, way: _Way, side: str) -> Sequence[ViaPoint]:
        """Return the via points with which a way leads round, none if it cannot."""
        members = np.concatenate([movement.limbs.members[limb] for limb in way.limbs])
        nothing = np.zeros(len(members))
        bells = [ViaPoint(members, nothing, way.start_s, way.end_s, peak) for peak in PEAKS]
        q = movement.sample(way.times)
        known = (
            np.round(q[:, members] * 200).astype(np.int64).tobytes()
            + repr((side, round(way.end_s - way.start_s, 3))).encode()
        )
        if known not in self._found:
            self._found[known] = self._offset(movement, q, bells, way, side)
        offset = self._found[known]
        if offset is None:
            return []
        parts = np.split(offset, len(bells))
        return [replace(bell, offset=part) for bell, part in zip(bells, parts, strict=True)]

    def _offset(
        self, movement: Movement, q: Array, bells: Sequence[ViaPoint], way: _Way, side: str
    ) -> Array | None:
        """Return the offsets of all via points, one after the other; none if none helps."""
        members = bells[0].members
        weight = np.stack([bell.weight(way.times) for bell in bells])
        speed, acceleration = np.array([bell.fastest for bell in bells]).T
        most = np.minimum(MOST_RAD_S / speed, MOST_RAD_S2 / acceleration)
        coordinates = movement.coordinates
        search = OffsetSearch(
            q,
            np.tile(members, len(bells)),
            np.repeat(weight, len(members), axis=0).T,
            np.repeat(most, len(members)),
            self.overlaps,
            self.overlaps.axis_distances(()),
            np.zeros(len(self.overlaps.pairs)),
            PRICE_M,
            STEP_RAD,
            coordinates.lower,
            coordinates.upper,
        )
        pairs = self._pairs(side)
        depths = self.overlaps.depths(q, search.axis_distances, pairs)
        allowed = search.allowed_depths(depths, pairs)
        before = float(np.max(depths - allowed, initial=0.0))
        if before <= ENOUGH_M:
            return None
        best: Offset | None = None
        starts = [
            np.clip(start, -search.most, search.most)
            for start in _starts(q[0, members], q[-1, members], members, coordinates.index, side)
        ]
        for start in _by_cost(search, starts, pairs, allowed)[:TRIES]:
            found = search.smallest(start, pairs, allowed, ENOUGH_M)
            if best is None or found.shortfall_m < best.shortfall_m:
                best = found
            if best.shortfall_m <= ENOUGH_M:
                break
        if best is None or best.shortfall_m > WORTHWHILE * before:
            return None
        return best.values


@dataclass(frozen=True, slots=True)
class _Way:
    """Digits of a hand that are free between two keys."""

    limbs: tuple[str, ...]
    start_s: float
    end_s: float

    @property
    def times(self) -> Array:
        """Instants at which it is measured, ends included."""
        return np.linspace(self.start_s, self.end_s, SAMPLES + 2)


def _starts(
    a: Array, b: Array, members: NDArray[np.int64], index: Mapping[str, int], side: str
) -> Iterator[Array]:
    """Yield offsets to start from, (2 n,): early and late ones of every coordinate.

    Nothing; fingers that open while the thumb goes beside or before them; and each of these with
    the thumb first or last.

    Args: a, b: (n,) the coordinates at both ends.
    """
    column = {int(v): i for i, v in enumerate(members)}
    thumb = np.zeros(len(members), dtype=np.bool_)
    for name, v in index.items():
        if name.startswith(f"thumb_{side}") and v in column:
            thumb[column[v]] = True

    def shape(*parts: Mapping[str, float]) -> Array:
        out = np.zeros(len(members))
        for part in parts:
            for name, angle in part.items():
                v = index.get(name.format(S=side), -1)
                if v in column:
                    out[column[v]] += angle
        return out

    turn = 0.4 * (b - a)
    thumb_first = np.where(thumb, turn, -turn)
    for opened in (shape(), shape(_OPEN), shape(_ASIDE), shape(_OPEN, _ASIDE),
                   shape(_BEFORE), shape(_OPEN, _BEFORE)):  # fmt: skip
        for early, late in ((0.7, 0.7), (1.2, 0.2), (0.2, 1.2)):
            for order in (0.0, 1.0, -1.0):
                way = order * thumb_first
                yield np.concatenate([early * opened + way, late * opened + way])


def _by_cost(
    search: OffsetSearch, starts: Sequence[Array], pairs: NDArray[np.int64], allowed: Array
) -> list[Array]:
    """Return the starts in the order of what they cost, which one call measures."""
    wanted = np.concatenate([search.offset_by(start) for start in starts])
    q = np.clip(wanted, search.lower, search.upper)
    depths = search.overlaps.depths(q, search.axis_distances, pairs)
    beyond = np.maximum(depths.reshape(len(starts), *allowed.shape) - allowed, 0.0)
    costs = [
        float(np.sum(each**2) + search.price_m**2 * np.sum(start**2))
        for each, start in zip(beyond, starts, strict=True)
    ]
    return [starts[i] for i in np.argsort(costs, kind="stable")]
