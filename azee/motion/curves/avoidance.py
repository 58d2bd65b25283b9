"""Collision avoidance: where a movement leads through the body, via points lead it round.

Between keys a limb moves straight in joint space, which may lead a hand through the chest. There
the limbs that carry the overlapping capsules, and that nothing needs at that time, get via points
(see `ViaPoint`): the smallest offsets of their coordinates with which all pairs of capsules keep
their distance on the whole stretch between the keys (see `OffsetSearch`). Keys and their times stay
as they are. Fingers of one hand pass each other by rules of their own (see `FingerPassage`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.capsule_overlap import CapsuleOverlaps
from azee.motion.curves.finger_passage import FingerPassage
from azee.motion.curves.movement import Movement
from azee.motion.curves.offset_search import CONSIDERED_M, OffsetSearch
from azee.motion.curves.passage_search import passage_search
from azee.motion.curves.via_points import ViaPoint
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.limbs import CARRIERS
from azee.motion.tasks.schedule import TaskSchedule
from azee.score.interval import Interval
from azee_solver.constraint import Constraint
from azee_solver.evaluate import Evaluator

Array = NDArray[np.float64]

PASSES = 4
"""How often the movement is searched for collisions: an offset may cause another one."""
SAMPLE_S = 1 / 30
"""Time between the postures in which collisions are searched."""
SAMPLES_AT_ONCE = 240
DEEP_M = 0.005
"""Pairs that overlap deeper collide; shallower ones the projection pushes apart. A hand that moves
*through* a body or another hand it cannot lead round."""
LEAST_APPROACH_M = 0.002
"""Pairs that come nearer than at the ends of the stretch by less than this do not collide."""
TOUCH_WINDOW_S = Fraction(1, 2)
"""A touch that the score asks for is no collision this long before and after."""

FEWEST_SAMPLES, MOST_SAMPLES = 8, 20
"""Samples on a stretch for which an offset is sought, its ends not counted."""
SHORT_S, LONG_S, LEAST_CLEARANCE_SHARE = 0.15, 0.45, 0.1
"""In stretches of `LONG_S` pairs keep the whole clearance, in those of `SHORT_S` this share of it,
since a wide offset in a short time is a jerk."""
ALLOWED_SHORTFALL = 0.25
"""The search ends when no pair lacks more than this share of the least clearance."""
WORTHWHILE = 0.7
"""An offset is used if it leaves at most this share of the largest shortfall."""
MAX_STEP_RAD = 0.15
MOST_ADDED_RAD_S, MOST_ADDED_RAD_S2 = math.radians(90.0), math.radians(800.0)
"""Largest speed and acceleration that an offset adds to a coordinate. Without a bound an arm at
rest was once swung aside by 111° in .2 s, out of the way of a hand that came there later."""
OFFSET_WEIGHT_M = 0.015
"""An offset of one radian costs as much as this overlap in one sample."""


_FreeLimbs: TypeAlias = tuple[tuple[str, float, float], ...]
"""Limbs that nothing needs, each from when to when."""


@dataclass(frozen=True, slots=True, eq=False)
class CollisionAvoidance:
    """Adds via points where a movement leads through the body.

    limbs_in_use: limbs that something needs, by when.
    """

    evaluator: Evaluator
    schedule: TaskSchedule
    limbs_in_use: IntervalIndex[frozenset[str]]
    overlaps: CapsuleOverlaps

    def avoid_collisions(self, movement: Movement) -> Movement:
        """Return a movement with via points where limbs that are free could avoid a collision."""
        fingers = FingerPassage(passage_search(self.evaluator), self.limbs_in_use)
        movement = replace(movement, via_points=tuple(fingers.via_points(movement)))
        unsuccessful: set[_FreeLimbs] = set()
        times = np.arange(movement.start_s - SAMPLE_S, movement.end_s + SAMPLE_S, SAMPLE_S)
        for _ in range(PASSES):
            collisions = _merged(self._collisions(movement, times))
            added: list[ViaPoint] = []
            for free, (first, last) in collisions.items():
                if free in unsuccessful:
                    continue
                found = self._via_points(movement, free, (first + last) / 2)
                if not found:
                    unsuccessful.add(free)
                added += found
            if not added:
                break
            movement = replace(movement, via_points=(*movement.via_points, *added))
            changed = [(v.start_s <= times) & (times <= v.end_s) for v in added]
            times = times[np.any(changed, axis=0)]
        return movement

    def intended_touches(self, first_s: float, last_s: float) -> list[Constraint]:
        """Constraints in force around some time: the touches they ask for are no collisions."""
        span = Interval(
            Fraction(first_s).limit_denominator(10**6) - TOUCH_WINDOW_S,
            Fraction(last_s).limit_denominator(10**6) + TOUCH_WINDOW_S,
        )
        return [t.constraint for t in self.schedule.in_force.overlapping(span)]

    def _collisions(
        self, movement: Movement, times: Array
    ) -> dict[_FreeLimbs, tuple[float, float]]:
        """Return the limbs that could avoid collisions at some times, and how long these last."""
        out: dict[_FreeLimbs, tuple[float, float]] = {}
        for start in range(0, len(times), SAMPLES_AT_ONCE):
            part = times[start : start + SAMPLES_AT_ONCE]
            for pair, rows in self._colliding_pairs(movement.sample(part), part).items():
                for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
                    first, last = float(part[run[0]]), float(part[run[-1]])
                    free = self._free_limbs(movement, (first + last) / 2, pair)
                    if free:
                        before = out.get(free, (first, last))
                        out[free] = (min(first, before[0]), max(last, before[1]))
        return out

    def _colliding_pairs(self, q: Array, times: Array) -> dict[int, NDArray[np.int64]]:
        """Return the pairs that collide in moving postures, and the rows in which they do."""
        deep = np.where(self.overlaps.same_hand, math.inf, DEEP_M)
        found: dict[int, list[int]] = {}
        moving = np.flatnonzero(np.any(np.diff(q, axis=0, prepend=q[:1]) != 0.0, axis=1))
        for rows in np.array_split(moving, max(1, len(moving) // 15)):
            if not len(rows):
                continue
            touches = self.intended_touches(times[rows[0]], times[rows[-1]])
            depths = self.overlaps.depths(q[rows], self.overlaps.axis_distances(touches))
            for t, p in zip(*np.nonzero(depths > deep), strict=True):
                found.setdefault(int(p), []).append(int(rows[t]))
        return {pair: np.array(rows, dtype=np.int64) for pair, rows in found.items()}

    def _via_points(self, movement: Movement, free: _FreeLimbs, peak_s: float) -> list[ViaPoint]:
        """Return via points of free limbs that avoid their collisions; none if there are none."""
        zero = [
            ViaPoint(
                movement.limbs.members[limb],
                np.zeros(len(movement.limbs.members[limb])),
                a, b, float(np.clip((peak_s - a) / (b - a), 0.0, 1.0)),
            )
            for limb, a, b in free
        ]  # fmt: skip
        start, end = min(v.start_s for v in zero), max(v.end_s for v in zero)
        count = int(np.clip((end - start) / SAMPLE_S, FEWEST_SAMPLES, MOST_SAMPLES))
        times = np.linspace(start, end, count + 2)
        time_share = (end - start - SHORT_S) / (LONG_S - SHORT_S)
        weights = np.hstack([np.outer(v.weight(times), np.ones(len(v.members))) for v in zero])
        most = np.concatenate([np.full(len(v.members), _largest_offset(v)) for v in zero])
        search = OffsetSearch(
            movement.sample(times),
            np.concatenate([v.members for v in zero]),
            weights,
            most,
            self.overlaps,
            self.overlaps.axis_distances(self.intended_touches(start, end)),
            self.overlaps.clearance_m * float(np.clip(time_share, LEAST_CLEARANCE_SHARE, 1.0)),
            OFFSET_WEIGHT_M,
            MAX_STEP_RAD,
            movement.coordinates.lower,
            movement.coordinates.upper,
        )
        offset = _smallest_offset(search)
        if offset is None:
            return []
        ends = np.cumsum([len(v.members) for v in zero])[:-1]
        parts = np.split(offset, ends)
        return [replace(v, offset=part) for v, part in zip(zero, parts, strict=True)]

    def _free_limbs(self, movement: Movement, time: float, pair: int) -> _FreeLimbs:
        """Return the limbs that may avoid a pair's collision, each with its free time around it.

        Arms rather than fingers; never trunk, head or eyes.
        """
        names = movement.limbs.touching(self.overlaps.moved_by(pair)) - {*CARRIERS, "eyes"}
        arms = {n for n in names if n.startswith("arm_")}
        found = ((limb, self._free_time(movement, limb, time)) for limb in sorted(arms or names))
        return tuple((limb, *span) for limb, span in found if span is not None)

    def _free_time(self, movement: Movement, limb: str, time: float) -> tuple[float, float] | None:
        """Return the time around an instant, between two keys, in which nothing needs a limb."""
        keys = [k.time_s for k in movement.curves[limb].keys]
        after = int(np.searchsorted(keys, time))
        if after in (0, len(keys)):
            return None
        start, end = keys[after - 1], keys[after]
        span = Interval(
            Fraction(start).limit_denominator(10**6), Fraction(end).limit_denominator(10**6)
        )
        for interval, needed in self.limbs_in_use.overlapping_entries(span):
            if limb in needed:
                a, b = float(interval.start), float(interval.end)
                if a < time < b:
                    return None
                start = max(start, b) if b <= time else start
                end = min(end, a) if a >= time else end
        return (start, end) if start < time < end else None


def _merged(
    collisions: Mapping[_FreeLimbs, tuple[float, float]],
) -> dict[_FreeLimbs, tuple[float, float]]:
    """Merge collisions that share a free limb: one offset must avoid all of them."""
    out: dict[_FreeLimbs, tuple[float, float]] = {}
    for free, (first, last) in collisions.items():
        for other in [o for o in out if {*o} & {*free}]:
            before = out.pop(other)
            first, last = min(first, before[0]), max(last, before[1])
            free = tuple(sorted({*free, *other}))
        out[free] = first, last
    return out


def _largest_offset(via_point: ViaPoint) -> float:
    """Return the largest offset of a coordinate that adds no more than is allowed, radians."""
    speed, acceleration = via_point.fastest
    return min(MOST_ADDED_RAD_S / speed, MOST_ADDED_RAD_S2 / acceleration)


def _smallest_offset(search: OffsetSearch) -> Array | None:
    """Return the offset, (n,) radians; none if it would avoid too little."""
    depths = search.overlaps.depths(search.q, search.axis_distances)
    approach = depths.max(axis=0) - np.maximum(depths[0], depths[-1])
    apart = ~search.overlaps.same_hand
    if not np.any(apart & (depths.max(axis=0) > DEEP_M) & (approach > LEAST_APPROACH_M)):
        return None
    pairs = np.flatnonzero(apart & np.any(depths > -CONSIDERED_M, axis=0))
    allowed = search.allowed_depths(depths[:, pairs], pairs)
    before = float(np.max(depths[:, pairs] - allowed))
    enough = ALLOWED_SHORTFALL * float(np.min(search.clearance[pairs]))
    found = search.smallest(np.zeros(len(search.members)), pairs, allowed, enough)
    return found.values if found.shortfall_m < WORTHWHILE * before else None
