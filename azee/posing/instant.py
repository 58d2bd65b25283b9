"""A compiled score at one instant: the posture, and what is in force."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.compilation import Compilation
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.schedule import bind
from azee.motion.tasks.timed_task import TimedTask
from azee.posing.fault import cannot_pose
from azee.score.score import Block, Group, Score
from azee_grammar.diagnostic import AZeeError
from azee_solver.constraint import Constraint
from azee_solver.evaluate import Evaluator, evaluator
from azee_solver.geometry import Side
from azee_solver.task import Task

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Instant:
    """The state of a body at an instant of a score.

    time: on the score's time line. q: (V,) radians, as the clip has the body. unit_weights: of the
    face. tasks: of postures, in force. face: facial morphs in force. limbs: of the body. around:
    all tasks of postures, whenever they are in force.
    """

    score: Score
    time: Fraction
    evaluator: Evaluator
    q: Array
    unit_weights: dict[str, float]
    tasks: tuple[TimedTask, ...]
    face: tuple[TimedTask, ...]
    limbs: Limbs
    around: tuple[TimedTask, ...]

    @property
    def on_the_way(self) -> frozenset[int]:
        """Coordinates of arms that the score needs, but not now."""
        arms = {
            frozenset(members.tolist())
            for limb, members in self.limbs.members.items()
            if limb.startswith("arm_")
        }
        now = {v for task in self.tasks for v in task.moves}
        ever = {v for task in self.around for v in task.moves}
        return frozenset().union(*(arm for arm in arms if arm & ever and not arm & now))

    @classmethod
    def of(cls, made: Compilation, time_s: float, dominant: Side) -> Instant:
        """Find the state of a compiled score. Raises: AZeeError: cannot-pose: no such time."""
        animation, rig = made.animation, made.rig
        first_s, last_s = -animation.lead_s, made.clip.duration_s - animation.lead_s
        if not first_s <= time_s <= last_s:
            reason = f"{time_s:g} s is outside the clip, which lasts from {first_s:.2f} s"
            raise AZeeError(cannot_pose(f"{reason} to {last_s:.2f} s"))
        frame = int(np.abs(made.clip.times - animation.lead_s - time_s).argmin())
        measure, limbs = evaluator(rig, dominant), Limbs.of(rig.coordinates)
        schedule = bind(flatten(animation.score), rig, measure.binding, limbs)
        time = Fraction(str(round(time_s, 6)))
        weights = dict(zip(made.clip.units, made.clip.unit_weights[frame].tolist(), strict=True))
        return cls(
            animation.score,
            time,
            measure,
            np.array(made.clip.coordinates[frame]),
            weights,
            tuple(t for t in schedule.posture_tasks if t.requirement.covers(time)),
            tuple(t for t in schedule.facial_morphs if t.requirement.covers(time)),
            limbs,
            schedule.posture_tasks,
        )

    def ik_task(self, task: TimedTask) -> Task:
        """Return what a task asks of a posture now."""
        return task.ik_task(self.time)

    @property
    def constraints(self) -> Iterator[tuple[Constraint, TimedTask]]:
        """Yield what is in force, with its task."""
        for task in (*self.tasks, *self.face):
            yield task.constraint, task


def scores_at(score: Score, time: Fraction) -> Iterator[tuple[tuple[str, ...], Score, Fraction]]:
    """Yield the scores around an instant, outermost first: path, score and start.

    Of blocks that overlap, those that start last come last.
    """
    yield from _scores_at(score, time, (), Fraction(0))


def _scores_at(
    score: Score, time: Fraction, path: tuple[str, ...], start: Fraction
) -> Iterator[tuple[tuple[str, ...], Score, Fraction]]:
    yield path, score, start
    if not isinstance(score, Group):
        return
    for block in sorted(score.blocks, key=_start):
        begin = start + block.interval_in_parent.start
        if begin <= time <= begin + block.score.duration:
            yield from _scores_at(block.score, time, (*path, block.name), begin)


def _start(block: Block) -> Fraction:
    return block.interval_in_parent.start
