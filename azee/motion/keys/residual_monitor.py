"""The residual monitor: how far a movement is from what the score requires, frame by frame."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.movement import Movement
from azee.motion.keys.transpath import AnchoredPath
from azee.motion.tasks.schedule import TaskSchedule
from azee.motion.tasks.timed_task import EarlyEnd, TimedTask
from azee_rig.chain import Frames
from azee_solver import kinematics
from azee_solver.constraint import Constraint, Morph, Place, Transpath
from azee_solver.evaluate import Evaluator, LengthOrAngle

Array = NDArray[np.float64]

TOLERANCE = {"m": 1e-3, "rad": math.radians(0.5)}
PATH_TOLERANCE_M = 2e-3
"""Of sites on paths and at moving targets, between keys."""
_SAME_S = 1e-9
"""Times that differ by no more than this are the same instant."""


@dataclass(frozen=True, eq=False)
class MovementSamples:
    """A movement at some instants: exact times, coordinates (T, V) and frames (T, …)."""

    times: tuple[Fraction, ...]
    q: Array
    frames: Frames

    @cached_property
    def seconds(self) -> Array:
        """The times as numbers, (T,)."""
        return np.array([float(t) for t in self.times])

    def only(self, rows: slice) -> MovementSamples:
        """Return some of the instants."""
        frames = Frames(self.frames.positions[rows], self.frames.rotations[rows])
        return MovementSamples(self.times[rows], self.q[rows], frames)


def sample_movement(
    movement: Movement, times: Iterable[Fraction], evaluator: Evaluator
) -> MovementSamples:
    """Sample a movement, with forward kinematics of all instants at once."""
    exact = tuple(times)
    q = movement.sample(np.array([float(t) for t in exact]))
    return MovementSamples(exact, q, kinematics.frames(evaluator.rig.chain, q))


@dataclass(frozen=True, slots=True, eq=False)
class ResidualMonitor:
    """Measures the residuals of one score on one rig.

    paths: those whose ends are known, by rank of their transpath. early_ends: by rank of the task.
    """

    evaluator: Evaluator
    schedule: TaskSchedule
    paths: Mapping[int, AnchoredPath]
    early_ends: Mapping[int, EarlyEnd]

    @property
    def measured_tasks(self) -> tuple[TimedTask, ...]:
        """What a movement can be measured against."""
        return (*self.schedule.posture_tasks, *(p.motion.task for p in self.paths.values()))

    def in_force(self, time: Fraction) -> list[TimedTask]:
        """Return the tasks of a posture at an instant; those that have ended early are left out."""
        return in_force(self.schedule, time, self.early_ends)

    def paths_in_control(self, time: Fraction) -> list[AnchoredPath]:
        """Return the paths that hold a site at an instant."""
        found = (self.paths.get(t.rank) for t in self.schedule.transpaths_in_force.at(time))
        return [path for path in found if path is not None and path.motion.controls(time)]

    def tolerance(self, task: TimedTask) -> float:
        """Largest residual that counts as met, metres or radians."""
        if task.rank in self.paths:
            return PATH_TOLERANCE_M
        unit = self.unit(task)
        return PATH_TOLERANCE_M if task.dynamic and unit == "m" else TOLERANCE[unit]

    def unit(self, task: TimedTask) -> LengthOrAngle:
        """Return the unit of a task's residual."""
        return unit_of(task.constraint)

    def rows_inside(self, task: TimedTask, seconds: Array, *, enforced: bool = False) -> slice:
        """Return which of increasing instants are inside a task's block, both ends included.

        For a block between two of them it is the nearest one.

        Args: enforced: only those at which the movement must meet it: up to its early end.
        """
        first, last = float(task.interval.start), float(task.interval.end)
        if task.rank in self.paths:
            # Where a placement takes the site or leaves it, the placement holds it.
            motion = self.paths[task.rank].motion
            first = float(motion.start) + (2 * _SAME_S if motion.before is not None else 0.0)
            last = float(motion.end) - (2 * _SAME_S if motion.after is not None else 0.0)
        last += _SAME_S
        early = self.early_ends.get(task.rank)
        if early is not None:
            # The end itself belongs to the block that starts there.
            last = float(early.time) + _SAME_S if enforced else last - 2 * _SAME_S
        start, stop = (int(i) for i in np.searchsorted(seconds, (first - _SAME_S, last)))
        if start < stop or not len(seconds):
            return slice(start, max(start, stop))
        nearest = int(np.abs(seconds - (first + last) / 2).argmin())
        return slice(nearest, nearest + 1)

    def residual(self, task: TimedTask, samples: MovementSamples) -> Array:
        """How far a task is from being met at instants inside its block, (T,)."""
        path = self.paths.get(task.rank)
        if path is not None:
            site = self.evaluator.site(path.motion.constraint.site, samples.frames)
            target = path.targets(samples.times, samples.frames, self.evaluator)
            return np.asarray(np.linalg.norm(site - target, axis=-1))
        if task.dynamic:
            return self._to_moving_target(task, samples)
        if not isinstance(task.constraint, Morph):
            return self.evaluator.residual(task.constraint, samples.frames, samples.q)[0]
        out = np.empty(len(samples.times))
        for among, rows in self._concurrent_morphs(task, samples):
            part = samples.only(rows)
            value = self.evaluator.residual(task.constraint, part.frames, part.q, among=among)
            out[rows] = value[0]
        return out

    def _to_moving_target(self, task: TimedTask, samples: MovementSamples) -> Array:
        out = np.empty(len(samples.times))
        for i, time in enumerate(samples.times):
            one = Frames(samples.frames.positions[i], samples.frames.rotations[i])
            value, _ = self.evaluator.residual(
                task.constraint, one, samples.q[i], phase=task.phase(time)
            )
            out[i] = float(value)
        return out

    def _concurrent_morphs(
        self, task: TimedTask, samples: MovementSamples
    ) -> Iterator[tuple[Sequence[Constraint], slice]]:
        """Yield the morphs in force together with one, for their angles add, and in which rows."""
        others = self.schedule.morphs_of_same_hand[task]
        parts = [self.rows_inside(t, samples.seconds, enforced=True) for t in others]
        cuts = sorted({0, len(samples.times), *(i for p in parts for i in (p.start, p.stop))})
        for first, last in pairwise(cuts):
            concurrent = [
                t.constraint
                for t, part in zip(others, parts, strict=True)
                if part.start <= first and last <= part.stop
            ]
            yield [*dict.fromkeys([task.constraint, *concurrent])], slice(first, last)


def in_force(
    schedule: TaskSchedule, time: Fraction, early_ends: Mapping[int, EarlyEnd]
) -> list[TimedTask]:
    """Return the tasks of a posture at an instant, both ends included, up to their early ends."""
    found = ((t, early_ends.get(t.rank)) for t in schedule.in_force.at(time))
    return [t for t, early in found if early is None or time <= early.time]


def unit_of(constraint: Constraint) -> LengthOrAngle:
    """Return the unit in which a constraint's residual is measured."""
    return "m" if isinstance(constraint, Place | Transpath) else "rad"
