"""Collision avoidance: where a movement leads through the body, via points lead it round.

Between keys a limb moves straight in joint space, which may lead a hand through the chest or a
thumb through a finger. There the limbs that carry the overlapping capsules, and that nothing needs
at that time, get via points (see `ViaPoint`): the smallest offsets of their coordinates with which
all pairs of capsules keep their distance on the whole stretch between the keys. Keys and their
times stay as they are.

The offset c, (n,), is found by damped least squares. With d_tp(c) the depth of pair p at sample t,
a_tp the depth that it may have there, and m = `OFFSET_WEIGHT_M`, it minimises

    Σ_tp max(0, d_tp(c) − a_tp)² + m² |c|²

in Levenberg–Marquardt steps −(JᵀJ + (m² + λ) I)⁻¹ (Jᵀe + m² c), e being the positive parts and J
their derivatives by c.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.curves.capsule_overlap import CapsuleOverlaps
from azee.motion.curves.movement import Movement
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
DEEP_M, DEEP_FINGERS_M = 0.005, 0.003
"""Pairs that overlap deeper collide; shallower ones, and fingers of one hand that are, the
projection pushes apart. A hand that moves *through* a body or another hand it cannot lead round."""
LEAST_APPROACH_M = 0.002
"""Pairs that come nearer than at the ends of the stretch by less than this do not collide."""
TOUCH_WINDOW_S = Fraction(1, 2)
"""A touch that the score asks for is no collision this long before and after."""

FEWEST_SAMPLES, MOST_SAMPLES = 8, 20
"""Samples on a stretch for which an offset is sought, its ends not counted."""
CONSIDERED_M = 0.025
"""Pairs that are farther apart in all samples are not considered."""
SHORT_S, LONG_S, LEAST_CLEARANCE_SHARE = 0.15, 0.45, 0.1
"""In stretches of `LONG_S` pairs keep the whole clearance, in those of `SHORT_S` this share of it,
since a wide offset in a short time is a jerk."""
TAPER = 0.35
"""Share of the stretch in which pairs that are near at its end reach their clearance."""
ALLOWED_SHORTFALL = 0.25
"""The search ends when no pair lacks more than this share of the least clearance."""
WORTHWHILE = 0.7
"""An offset is used if it leaves at most this share of the largest shortfall."""
MAX_ITERATIONS, MAX_STEP_RAD = 40, 0.15
LEAST_GAIN = 0.05
"""A step that lowers the sum by less than this share is the last one."""
MOST_ADDED_RAD_S, MOST_ADDED_RAD_S2 = math.radians(90.0), math.radians(800.0)
"""Largest speed and acceleration that an offset adds to a coordinate. Without a bound an arm at
rest was once swung aside by 111° in .2 s, out of the way of a hand that came there later."""
DAMPING = 0.03
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
        deep = np.where(self.overlaps.same_hand, DEEP_FINGERS_M, DEEP_M)
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
        step_s = times[1] - times[0]
        speed, acceleration = (
            np.abs(np.diff(weights, n, axis=0)).max(axis=0) / step_s**n for n in (1, 2)
        )
        search = _OffsetSearch(
            movement.sample(times),
            np.concatenate([v.members for v in zero]),
            weights,
            np.minimum(MOST_ADDED_RAD_S / speed, MOST_ADDED_RAD_S2 / acceleration),
            self.overlaps,
            self.overlaps.axis_distances(self.intended_touches(start, end)),
            float(np.clip(time_share, LEAST_CLEARANCE_SHARE, 1.0)),
            movement.coordinates.lower,
            movement.coordinates.upper,
        )
        offset = search.smallest_offset()
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


@dataclass(frozen=True, slots=True, eq=False)
class _OffsetSearch:
    """Damped least squares for the smallest offset with which all pairs keep their distance.

    q: (T, V) samples of the stretch. members: (n,) coordinates to offset. weights: (T, n) share of
    the offset at each sample. most: (n,) largest offset either way. axis_distances: (P,) metres.
    clearance_share: how much of the clearance to keep, as there is time for it. lower, upper: (V,)
    limits.
    """

    q: Array
    members: NDArray[np.int64]
    weights: Array
    most: Array
    overlaps: CapsuleOverlaps
    axis_distances: Array
    clearance_share: float
    lower: Array
    upper: Array

    def smallest_offset(self) -> Array | None:
        """Return the offset, (n,) radians; none if it would avoid too little."""
        depths = self.overlaps.depths(self.q, self.axis_distances)
        approach = depths.max(axis=0) - np.maximum(depths[0], depths[-1])
        clearance = self.overlaps.clearance_m * self.clearance_share
        near = depths.max(axis=0) > np.where(self.overlaps.same_hand, DEEP_FINGERS_M, DEEP_M)
        if not np.any(near & (approach > LEAST_APPROACH_M)):
            return None
        pairs = np.flatnonzero(np.any(depths > -CONSIDERED_M, axis=0))
        allowed = self._allowed_depths(depths[:, pairs], clearance[pairs])
        enough = ALLOWED_SHORTFALL * float(np.min(clearance[pairs]))
        c, damping = np.zeros(len(self.members)), DAMPING
        error, J = self._errors(c, pairs, allowed)
        error_before, cost = float(np.max(error)), float(np.sum(error**2))
        for _ in range(MAX_ITERATIONS):
            if np.max(error) <= enough:
                break
            lhs, rhs = _normal_equations(J, error)
            lhs += (OFFSET_WEIGHT_M**2 + damping) * np.eye(len(c))
            step = -np.linalg.solve(lhs, rhs + OFFSET_WEIGHT_M**2 * c)
            step *= min(1.0, MAX_STEP_RAD / max(1e-9, float(np.max(np.abs(step)))))
            step = np.clip(c + step, -self.most, self.most) - c
            new_error, new_J = self._errors(c + step, pairs, allowed)
            new_cost = float(np.sum(new_error**2) + OFFSET_WEIGHT_M**2 * np.sum((c + step) ** 2))
            gain = 1.0 - new_cost / cost
            if gain > 0.0:
                c, error, J, cost, damping = c + step, new_error, new_J, new_cost, damping / 3
            else:
                damping *= 8
            if 0.0 < gain < LEAST_GAIN:
                break
        return c if float(np.max(error)) < WORTHWHILE * error_before else None

    def _allowed_depths(self, depths: Array, clearance: Array) -> Array:
        """Return the depths that pairs may have in the samples, (T, P) metres.

        Minus the clearance; but a pair that is nearer at an end of the stretch may be so near
        beside that end, and reaches the clearance by minimum jerk within the share `TAPER`.
        """
        ends = np.maximum(depths[[0, -1]], -clearance)
        along = np.linspace(0.0, 1.0, len(self.q))[:, None]
        leaving = 1.0 - minimum_jerk(along / TAPER)
        arriving = 1.0 - minimum_jerk((1.0 - along) / TAPER)
        near = np.maximum((ends[0] + clearance) * leaving, (ends[1] + clearance) * arriving)
        return np.asarray(near - clearance)

    def _errors(
        self, offset: Array, pairs: NDArray[np.int64], allowed: Array
    ) -> tuple[Array, Array]:
        """Return depths beyond the allowed ones, (T · P,) metres, and derivatives, (T · P, n)."""
        wanted = self.q.copy()
        wanted[:, self.members] += self.weights * offset
        q = np.clip(wanted, self.lower, self.upper)
        least = float(allowed.min(initial=math.inf))
        depths, gradients = self.overlaps.depths_and_gradients(
            q, self.axis_distances, pairs, self.members, least
        )
        beyond = depths - allowed
        # A coordinate at its limit does not move, and a pair that is far enough does not count.
        counts = (wanted == q)[:, None, self.members] & (beyond > 0.0)[..., None]
        J = gradients * self.weights[:, None, :] * counts
        return np.maximum(beyond, 0.0).ravel(), J.reshape(beyond.size, -1)


def _normal_equations(J: Array, error: Array) -> tuple[Array, Array]:
    """Return Jᵀ J, (n, n), and Jᵀ e, (n,), of slopes (R, n) that are zero where errors (R,) are.

    Without BLAS, which may share products of this size among threads: their number could then
    show in the result, and on busy cores they wait for each other longer than the product takes.
    """
    rows = np.flatnonzero(error)
    columns = np.ascontiguousarray(J[rows].T)
    return np.einsum("ir,jr->ij", columns, columns), np.einsum("ir,r->i", columns, error[rows])
