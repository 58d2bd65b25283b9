"""Path motions: a site moves on the path of a transpath, between the blocks that place it.

A transpath leads its site from where the placement before it leaves the site to where the
placement after it wants the site. While a placement overlaps the path in time, the placement holds
the site and the path takes the rest. Where a gap is left between them, the site waits. Along the
path it moves by minimum jerk: at time t it has covered the share s(τ) = 10τ³ − 15τ⁴ + 6τ⁵ of it,
τ = (t − start)/(end − start).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.curves.manner import share_of_way
from azee.motion.curves.movement import Movement
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.key_posture import KeyPosture
from azee.motion.tasks.limbs import CARRIERS, limb_of_bone
from azee.motion.tasks.schedule import TaskSchedule
from azee.motion.tasks.timed_task import TimedTask
from azee.score.interval import Interval
from azee_rig.chain import Frames
from azee_solver import kinematics
from azee_solver.constraint import (
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import (
    Bone,
    Point,
    Side,
    Site,
    SitePoint,
    Slide,
    WorldPoint,
    depends_on,
)
from azee_solver.task import Task

Array = NDArray[np.float64]

SAMPLE_LENGTH_M = 0.06
SAMPLE_TURN_RAD = math.radians(45.0)
FEWEST_SAMPLES, MOST_SAMPLES = 2, 48
"""Samples on a path, its ends not counted: more keys are inserted where the curve misses it."""
_PATH_POINTS = 65
"""Points with which a path's length and turns are measured."""
_STILL_M = 1e-9

LONGEST_WAIT_S = Fraction(3, 5)
"""Placements farther away than this in time are not the ends of a path."""


@dataclass(frozen=True, slots=True, eq=False)
class PathMotion:
    """A transpath, the placements it leads from and to, and when the site is on its way.

    before, after: none where nothing places the site within `LONGEST_WAIT_S`; then the path starts
    or ends where the body has the site anyway. lead: by how much of its time the site is early in
    the middle of its way: nobody moves twice alike.
    """

    task: TimedTask
    before: TimedTask | None
    after: TimedTask | None
    start: Fraction
    end: Fraction
    lead: float = 0.0

    @property
    def constraint(self) -> Transpath:
        """The transpath."""
        assert isinstance(self.task.constraint, Transpath)
        return self.task.constraint

    @property
    def touching(self) -> tuple[Site, ...]:
        """The sites at the ends of a path on the skin: the part that they are on is touched."""
        if not isinstance(self.constraint.path, Slide):
            return ()
        ends = [task.constraint for task in (self.before, self.after) if task is not None]
        points = [place.point for place in ends if isinstance(place, Place)]
        return tuple(dict.fromkeys(p.site for p in points if isinstance(p, SitePoint)))

    @property
    def between(self) -> Interval:
        """From where the placement before ends to where the placement after begins."""
        return Interval(min(self._left, self.start), max(self._reached, self.end))

    @property
    def _left(self) -> Fraction:
        """When the placement before leaves the site."""
        return self.start if self.before is None else self.before.interval.end

    @property
    def _reached(self) -> Fraction:
        """When the placement after takes the site."""
        return self.end if self.after is None else self.after.interval.start

    def progress(self, time: Fraction) -> float:
        """How far along the path the site is, 0 to 1."""
        span = self.end - self.start
        if span <= 0:
            return 1.0
        share = min(max(float((time - self.start) / span), 0.0), 1.0)
        led = share + 4.0 * self.lead * share * (1.0 - share)
        return float(share_of_way(led, self.constraint.manner))

    def controls(self, time: Fraction) -> bool:
        """Whether the path, rather than a placement, holds the site at an instant."""
        is_left = time > self._left if self.before is not None else time >= self._left
        is_before_end = time < self._reached if self.after is not None else time <= self._reached
        return self.start <= time <= self.end and is_left and is_before_end


@dataclass(frozen=True, slots=True, eq=False)
class PathEnd:
    """Where a path starts or ends, and when.

    world: (3,) metres, in the key posture there. carrier: the point of trunk or head that the
    placement there aims at, itself or by way of the other hand, and at which phase. offset: (3,)
    from it to `world`.
    """

    time: Fraction
    world: Array
    carrier: Point | None = None
    phase: float = 0.0
    offset: Array | None = None

    def carried(self, frames: Frames, evaluator: Evaluator) -> PathEnd:
        """Return the end in another posture at its time: a body that breathes takes it along."""
        if self.carrier is None or self.offset is None:
            return self
        return replace(self, world=evaluator.point(self.carrier, frames, self.phase) + self.offset)


@dataclass(frozen=True, slots=True, eq=False)
class AnchoredPath:
    """A path motion whose two ends are known."""

    motion: PathMotion
    start: PathEnd
    end: PathEnd

    @property
    def reads_body(self) -> bool:
        """Whether the path hangs on the posture."""
        return bool(self.motion.task.reads)

    def targets(self, times: Sequence[Fraction], frames: Frames, evaluator: Evaluator) -> Array:
        """Return where the site should be at times, (T, 3); frames (T, …) of the body then."""
        progress = np.array([self.motion.progress(t) for t in times])
        return self.targets_at(progress, frames, evaluator)

    def targets_at(self, progress: Array, frames: Frames, evaluator: Evaluator) -> Array:
        """Return where the site is after shares (T,) of its way, (T, 3); frames (T, …) then."""
        path, ends = self.motion.constraint.path, (self.start.world, self.end.world)
        if not self.reads_body:
            one = Frames(frames.positions[:1], frames.rotations[:1])
            return np.asarray(evaluator.path(path, *ends, progress, one).reshape(-1, 3))
        out = np.empty((len(progress), 3))
        for i, s in enumerate(progress):
            now = Frames(frames.positions[i], frames.rotations[i])
            out[i] = evaluator.path(path, *ends, float(s), now)
        return out

    def ik_task(self, point: Array) -> Task:
        """Return the placement of the site on a point of its path."""
        task = self.motion.task
        x, y, z = point.tolist()
        place = Place(
            self.motion.constraint.site,
            WorldPoint(x, y, z, self.motion.touching),
            origin=task.constraint.origin,
        )
        return Task(place, task.path, task.interval.start, task.rank)


def path_motions(schedule: TaskSchedule, dominant: Side) -> tuple[PathMotion, ...]:
    """Find for every transpath from which placement it leads to which."""
    out = []
    for task in schedule.transpaths:
        assert isinstance(task.constraint, Transpath)
        site, own = task.constraint.site.key(dominant), task.interval
        around = Interval(own.start - LONGEST_WAIT_S, own.end + LONGEST_WAIT_S)
        placements = [
            t
            for t in schedule.in_force.overlapping(around)
            if isinstance(t.constraint, Place) and t.constraint.site.key(dominant) == site
        ]
        out.append(_path_motion(task, placements))
    return tuple(out)


def _path_motion(task: TimedTask, placements: Sequence[TimedTask]) -> PathMotion:
    own = task.interval
    earlier, later = [], []
    for placement in placements:
        span = placement.interval
        if span.start <= own.start and own.start - LONGEST_WAIT_S <= span.end < own.end:
            earlier.append(placement)
        if span.end >= own.end and own.start < span.start <= own.end + LONGEST_WAIT_S:
            later.append(placement)
    before = max(earlier, key=lambda t: t.interval.end, default=None)
    after = min(later, key=lambda t: t.interval.start, default=None)
    start = own.start if before is None else max(own.start, before.interval.end)
    end = own.end if after is None else min(own.end, after.interval.start)
    return PathMotion(task, before, after, start, max(start, end))


def index_by_time(motions: Iterable[PathMotion]) -> IntervalIndex[PathMotion]:
    """Return path motions by when they are between their placements."""
    return IntervalIndex((m.between, m) for m in motions)


def end_times(motions: Iterable[PathMotion]) -> frozenset[Fraction]:
    """Return the instants at which placements leave sites to paths or take them back."""
    out: set[Fraction] = set()
    for motion in motions:
        if motion.before is not None:
            out.add(motion.before.interval.end)
        if motion.after is not None:
            out.add(motion.after.interval.start)
    return frozenset(out)


def boundaries_on_paths(
    motions: Sequence[PathMotion], schedule: TaskSchedule
) -> frozenset[Fraction]:
    """Return the boundaries at which a path holds a site and no other path starts or ends.

    They can be solved only when the ends of the paths are known. Boundaries at which nothing
    begins or ends that a posture meets, such as those of faces, need no posture.
    """
    index = index_by_time(motions)
    spans = (task.interval for task in schedule.posture_tasks)
    times = {time for span in spans for time in (span.start, span.end)}
    on_paths = (t for t in times if any(m.controls(t) for m in index.at(t)))
    return frozenset(on_paths) - end_times(motions)


def limbs_on_paths(
    time: Fraction, tasks: Sequence[TimedTask], motions: Iterable[PathMotion]
) -> frozenset[str]:
    """Return limbs in the middle of a path or behind a moving target, and what follows them."""
    moving: set[str] = set()
    for motion in motions:
        if motion.start < time < motion.end:
            moving |= motion.task.limbs
    for task in tasks:
        span = task.requirement.motion
        if task.dynamic and span.start < time < span.end:
            moving |= task.limbs
    while True:
        following = {limb for t in tasks if t.read_limbs & moving for limb in t.limbs}
        if following <= moving:
            return frozenset(moving)
        moving |= following


def anchor(
    motions: Iterable[PathMotion],
    postures: Sequence[KeyPosture],
    movement: Movement,
    evaluator: Evaluator,
) -> dict[int, AnchoredPath]:
    """Measure where paths start and end: on key postures of their placements, else on a movement.

    Args: postures: in order of time. Returns: paths by rank of their transpath.
    """
    first: dict[TimedTask, KeyPosture] = {}
    last: dict[TimedTask, KeyPosture] = {}
    for posture in postures:
        for task in posture.timed_tasks:
            first.setdefault(task, posture)
            last[task] = posture

    def end(
        motion: PathMotion, placement: TimedTask | None, key: KeyPosture | None, time: Fraction
    ) -> PathEnd:
        q = movement.sample(np.array([float(time)]))[0] if key is None else key.coordinates
        frames = kinematics.frames(evaluator.rig.chain, q)
        world = evaluator.site(motion.constraint.site, frames)
        if placement is None or key is None:
            return PathEnd(time, world)
        carrier = _carrier(placement, key.timed_tasks, evaluator)
        if carrier is None:
            return PathEnd(time, world)
        point, phase = _place(carrier).point, carrier.phase(time)
        return PathEnd(time, world, point, phase, world - evaluator.point(point, frames, phase))

    out = {}
    for motion in motions:
        before, after = motion.before, motion.after
        leaving = None if before is None else last.get(before)
        arriving = None if after is None else first.get(after)
        out[motion.task.rank] = AnchoredPath(
            motion,
            end(motion, before, leaving, motion.start),
            end(motion, after, arriving, motion.end),
        )
    return out


def _place(task: TimedTask) -> Place:
    assert isinstance(task.constraint, Place)
    return task.constraint


def _carrier(
    placement: TimedTask, among: Iterable[TimedTask], evaluator: Evaluator
) -> TimedTask | None:
    """Return the placement on trunk or head that a placement hangs on, if there is one.

    A hand that touches the other one hangs on what the other one is placed at.
    """
    dominant = evaluator.binding.dominant
    placed = {_place(t).site.key(dominant): t for t in among if isinstance(t.constraint, Place)}
    seen: list[TimedTask] = []
    now: TimedTask | None = placement
    while now is not None and now not in seen:
        seen.append(now)
        point = _place(now).point
        if depends_on(point) and _on_trunk_or_head(point, evaluator):
            return now
        names = [name for name in depends_on(point) if isinstance(name, Site)]
        now = placed.get(names[0].key(dominant)) if len(names) == 1 else None
    return None


def _on_trunk_or_head(point: Point, evaluator: Evaluator) -> bool:
    """Whether a point is carried by trunk and head alone; hands move on paths of their own."""
    binding = evaluator.binding
    bones = (
        name.key(binding.dominant) if isinstance(name, Bone) else binding.site(name).bone
        for name in depends_on(point)
    )
    return all(limb_of_bone(bone) in CARRIERS for bone in bones)


def path_sample_times(path: AnchoredPath, frames: Frames, evaluator: Evaluator) -> list[Fraction]:
    """Return instants at which to sample a path. `frames`: one posture, for paths that read it."""
    motion = path.motion
    progress = np.linspace(0.0, 1.0, _PATH_POINTS)
    ends = path.start.world, path.end.world
    points = evaluator.path(motion.constraint.path, *ends, progress, frames)
    return sample_times(points, Interval(motion.start, motion.end))


def target_sample_times(task: TimedTask, frames: Frames, evaluator: Evaluator) -> list[Fraction]:
    """Return instants at which to sample a moving target. `frames`: one posture."""
    phases = [float(s) for s in np.linspace(0.0, 1.0, _PATH_POINTS)]
    match task.constraint:
        case Place(point=point) | LookAt(point=point):
            points = np.stack([evaluator.point(point, frames, s) for s in phases])
        case Orient(vector=vector) | Look(vector=vector):
            # Directions as points a turn of `SAMPLE_TURN_RAD` apart.
            size = SAMPLE_LENGTH_M / SAMPLE_TURN_RAD
            points = size * np.stack([evaluator.vector(vector, frames, s) for s in phases])
        case Morph() | Trill() | Rotate() | Transpath():
            return []
    requirement = task.requirement
    return [t for t in sample_times(points, requirement.motion) if requirement.covers(t)]


def sample_times(points: Array, interval: Interval) -> list[Fraction]:
    """Return instants at even steps along a path, enough of them for its length and turns.

    Args: points: (n, 3) at even steps of the path's own parameter.
    """
    if interval.duration == 0 or not np.all(np.isfinite(points)):
        return []
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    directions = steps[lengths > _STILL_M] / lengths[lengths > _STILL_M, None]
    turns = np.arccos(np.clip(np.sum(directions[1:] * directions[:-1], axis=1), -1.0, 1.0))
    wanted = max(lengths.sum() / SAMPLE_LENGTH_M, turns.sum() / SAMPLE_TURN_RAD)
    count = int(np.clip(math.ceil(wanted), FEWEST_SAMPLES, MOST_SAMPLES))
    grid = np.linspace(0.0, 1.0, 1001)
    times = np.interp(np.arange(1, count + 1) / (count + 1), minimum_jerk(grid), grid)
    parts = 10_000
    return [interval.start + interval.duration * Fraction(round(t * parts), parts) for t in times]
