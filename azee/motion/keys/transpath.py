"""Controlled movements: a site travels on its path between the blocks that place it.

A transpath takes its site from where the placement before leaves it to where the placement after
wants it. Where placement and path overlap, the placement holds the site and the path takes the
rest; where they leave a gap, the site waits. Along the path it moves by minimum jerk in time.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.curves.movement import Movement
from azee.motion.tasks.posture import KeyPosture
from azee.motion.tasks.spans import Spans
from azee.motion.tasks.timed_task import Bound, BoundScore
from azee.score.interval import Interval
from azee_rig.chain import Frames
from azee_solver.constraint import LookAt, Place, Transpath
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side, WorldPoint
from azee_solver.task import Task

Array = NDArray[np.float64]

SAMPLE_LENGTH_M = 0.06
SAMPLE_TURN_RAD = math.radians(45.0)
FEWEST, MOST = 2, 48
"""Samples on a path, its ends not counted: more are added where the curve misses it."""

WAITS_S = Fraction(3, 5)
"""Placements farther away than this in time are not the ends of a movement."""


@dataclass(frozen=True, slots=True, eq=False)
class Travel:
    """A transpath with the placements it leads from and to, and when the site is on its way.

    before, after: none where nothing places the site within `WAITS_S`; then the path starts or
    ends where the body has the site anyway.
    """

    bound: Bound
    before: Bound | None
    after: Bound | None
    start: Fraction
    end: Fraction

    @property
    def constraint(self) -> Transpath:
        """The transpath."""
        assert isinstance(self.bound.constraint, Transpath)
        return self.bound.constraint

    @property
    def between(self) -> Interval:
        """From where the placement before ends to where the placement after begins."""
        first = self.start if self.before is None else self.before.requirement.interval.end
        last = self.end if self.after is None else self.after.requirement.interval.start
        return Interval(min(first, self.start), max(last, self.end))

    def progress(self, time: Fraction) -> float:
        """How far along the path the site is, 0 to 1."""
        span = self.end - self.start
        return float(minimum_jerk(float((time - self.start) / span))) if span > 0 else 1.0

    def steers(self, time: Fraction) -> bool:
        """Whether the path, rather than a placement, holds the site at an instant."""
        first = self.start if self.before is None else self.before.requirement.interval.end
        last = self.end if self.after is None else self.after.requirement.interval.start
        arrives = time > first if self.before is not None else time >= first
        leaves = time < last if self.after is not None else time <= last
        return self.start <= time <= self.end and arrives and leaves


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """A travel whose ends are known: world points (3,), metres."""

    travel: Travel
    start: Array
    end: Array

    def target(self, times: Sequence[Fraction], frames: Frames, evaluator: Evaluator) -> Array:
        """Return where the site should be at times, (T, 3); frames (T, …) of the body then."""
        progress = np.array([self.travel.progress(t) for t in times])
        path, reads = self.travel.constraint.path, bool(self.travel.bound.reads)
        if not reads:
            one = Frames(frames.positions[:1], frames.rotations[:1])
            line = evaluator.path(path, self.start, self.end, progress, one)
            return np.asarray(line.reshape(-1, 3))
        return np.stack(
            [
                evaluator.path(
                    path,
                    self.start,
                    self.end,
                    float(s),
                    Frames(frames.positions[i], frames.rotations[i]),
                )
                for i, s in enumerate(progress)
            ]
        )

    def task(self, point: Array) -> Task:
        """Return the placement of the site on a point of its path."""
        r = self.travel.bound.requirement
        place = Place(
            self.travel.constraint.site,
            WorldPoint(*(float(x) for x in point)),
            origin=r.constraint.origin,
        )
        return Task(place, r.path, r.interval.start, r.rank)


def travels(score: BoundScore, dominant: Side) -> tuple[Travel, ...]:
    """Find between which placements every transpath leads."""
    out = []
    for path in score.paths:
        assert isinstance(path.constraint, Transpath)
        site, own = path.constraint.site.key(dominant), path.requirement.interval
        near = score.in_force.meeting(Interval(own.start - WAITS_S, own.end + WAITS_S))
        placements = [
            b
            for b in near
            if isinstance(b.constraint, Place) and b.constraint.site.key(dominant) == site
        ]
        out.append(_travel(path, placements))
    return tuple(out)


def _travel(path: Bound, placements: Sequence[Bound]) -> Travel:
    own = path.requirement.interval
    earlier, later = [], []
    for b in placements:
        span = b.requirement.interval
        if span.start <= own.start and own.start - WAITS_S <= span.end < own.end:
            earlier.append(b)
        if span.end >= own.end and own.start < span.start <= own.end + WAITS_S:
            later.append(b)
    before = max(earlier, key=lambda b: b.requirement.interval.end, default=None)
    after = min(later, key=lambda b: b.requirement.interval.start, default=None)
    start = own.start if before is None else max(own.start, before.requirement.interval.end)
    end = own.end if after is None else min(own.end, after.requirement.interval.start)
    return Travel(path, before, after, start, max(start, end))


def by_time(known: Iterable[Travel]) -> Spans[Travel]:
    """Return travels by when they are between their placements."""
    return Spans((k.between, k) for k in known)


def deferred(known: Sequence[Travel], times: Iterable[Fraction]) -> frozenset[Fraction]:
    """Return keyframes that lie on a path and on which no path's end depends."""
    spans = by_time(known)
    return frozenset(t for t in times if any(k.steers(t) for k in spans.at(t))) - ends(known)


def ends(known: Iterable[Travel]) -> frozenset[Fraction]:
    """Return the instants at which placements leave sites to paths and take them back."""
    out: set[Fraction] = set()
    for travel in known:
        if travel.before is not None:
            out.add(travel.before.requirement.interval.end)
        if travel.after is not None:
            out.add(travel.after.requirement.interval.start)
    return frozenset(out)


def passing_limbs(
    time: Fraction, bounds: Sequence[Bound], known: Iterable[Travel]
) -> frozenset[str]:
    """Return limbs in the middle of a controlled movement, and those that must follow them."""
    moving: set[str] = set()
    for travel in known:
        if travel.start < time < travel.end:
            moving |= travel.bound.limbs
    for b in bounds:
        motion = b.requirement.motion
        if b.dynamic and motion.start < time < motion.end:
            moving |= b.limbs
    while True:
        following = {limb for b in bounds if b.read_limbs & moving for limb in b.limbs}
        if following <= moving:
            return frozenset(moving)
        moving |= following


def courses(
    known: Iterable[Travel],
    postures: Sequence[KeyPosture],
    movement: Movement,
    evaluator: Evaluator,
) -> dict[int, Course]:
    """Measure where travels start and end, on key postures or else on the movement.

    Args: postures: in order of time. Returns: courses by rank of their transpath.
    """
    first: dict[Bound, KeyPosture] = {}
    last: dict[Bound, KeyPosture] = {}
    for posture in postures:
        for bound in posture.bounds:
            first.setdefault(bound, posture)
            last[bound] = posture

    def place(travel: Travel, posture: KeyPosture | None, time: Fraction) -> Array:
        at = np.array([float(time)])
        q = movement.sample(at)[0] if posture is None else posture.coordinates
        return evaluator.site(travel.constraint.site, evaluator.rig.chain.frames(q))

    out = {}
    for travel in known:
        leaves = None if travel.before is None else last.get(travel.before)
        arrives = None if travel.after is None else first.get(travel.after)
        out[travel.bound.requirement.rank] = Course(
            travel, place(travel, leaves, travel.start), place(travel, arrives, travel.end)
        )
    return out


def course_samples(whole: Course, frames: Frames, evaluator: Evaluator) -> list[Fraction]:
    """Return instants at which to sample a path. `frames`: one posture, for paths that read it."""
    travel = whole.travel
    line = evaluator.path(
        travel.constraint.path, whole.start, whole.end, np.linspace(0.0, 1.0, _FINE), frames
    )
    return sample_times(line, Interval(travel.start, travel.end))


def moving_samples(bound: Bound, frames: Frames, evaluator: Evaluator) -> list[Fraction]:
    """Return instants at which to sample a dynamic point. `frames`: one posture."""
    assert isinstance(bound.constraint, Place | LookAt)
    point = bound.constraint.point
    phases = np.linspace(0.0, 1.0, _FINE)
    line = np.stack([evaluator.point(point, frames, float(s)) for s in phases])
    r = bound.requirement
    return [t for t in sample_times(line, r.motion) if r.covers(t)]


def sample_times(line: Array, interval: Interval) -> list[Fraction]:
    """Return instants at even steps along a path, enough of them for its length and turns.

    Args: line: (n, 3) points at even steps of the path's own parameter.
    """
    if interval.duration == 0 or not np.all(np.isfinite(line)):
        return []
    steps = np.diff(line, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    directions = steps[lengths > _STILL_M] / lengths[lengths > _STILL_M, None]
    turns = np.arccos(np.clip(np.sum(directions[1:] * directions[:-1], axis=1), -1.0, 1.0))
    wanted = max(lengths.sum() / SAMPLE_LENGTH_M, turns.sum() / SAMPLE_TURN_RAD)
    count = int(np.clip(math.ceil(wanted), FEWEST, MOST))
    grid = np.linspace(0.0, 1.0, 1001)
    times = np.interp(np.arange(1, count + 1) / (count + 1), minimum_jerk(grid), grid)
    parts = 10_000
    return [interval.start + interval.duration * Fraction(round(t * parts), parts) for t in times]


_FINE = 65
_STILL_M = 1e-9
