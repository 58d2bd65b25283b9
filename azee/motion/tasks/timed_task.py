"""Timed tasks: what the score requires, each with the coordinates of one body it concerns."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction

from azee.clip.spline import minimum_jerk
from azee.motion.tasks.requirement import Requirement
from azee.score.interval import Interval
from azee_solver.constraint import Constraint
from azee_solver.task import Task


@dataclass(frozen=True, slots=True, eq=False)
class TimedTask:
    """A requirement bound to a body: a constraint, when it holds, and what can meet it.

    It lasts for an interval; `ik_task` is what it asks of one posture inside that interval.

    limb: that of the bone or site which the constraint names. moves: coordinates that can move
    this bone or site. reads: all other coordinates that change the residual, as a head does that a
    hand touches. limbs, read_limbs: the limbs of either, used_limbs: of both. dynamic: its
    target moves.
    """

    requirement: Requirement
    limb: str
    moves: frozenset[int]
    reads: frozenset[int]
    limbs: frozenset[str]
    read_limbs: frozenset[str]
    dynamic: bool
    used_limbs: frozenset[str] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "used_limbs", self.limbs | self.read_limbs)

    @property
    def constraint(self) -> Constraint:
        """The constraint that is required."""
        return self.requirement.constraint

    @property
    def path(self) -> tuple[str, ...]:
        """Names of the blocks that lead to it, outermost first."""
        return self.requirement.path

    @property
    def interval(self) -> Interval:
        """When it holds."""
        return self.requirement.interval

    @property
    def rank(self) -> int:
        """Its place in the order of the score; no two are equal."""
        return self.requirement.rank

    def ik_task(self, time: Fraction) -> Task:
        """Return what it asks of a posture at an instant."""
        phase = self.phase(time) if self.dynamic else 0.0
        return Task(self.constraint, self.path, self.interval.start, self.rank, phase)

    def phase(self, time: Fraction) -> float:
        """How far a dynamic point has got, 0 to 1: minimum jerk over its own block."""
        motion = self.requirement.motion
        if motion.duration == 0:
            return 1.0
        return float(minimum_jerk(float((time - motion.start) / motion.duration)))


def limbs_moved(tasks: Iterable[TimedTask]) -> frozenset[str]:
    """Limbs that tasks move."""
    return frozenset[str]().union(*(t.limbs for t in tasks))


def limbs_used(tasks: Iterable[TimedTask]) -> frozenset[str]:
    """Limbs that tasks move or read."""
    return frozenset[str]().union(*(t.used_limbs for t in tasks))


def ik_tasks_at(
    tasks: Iterable[TimedTask], time: Fraction, on_paths: Iterable[Task] = ()
) -> tuple[Task, ...]:
    """Return what tasks ask of a posture at an instant, each distinct constraint once.

    A block that holds another repeats its constraints: one morph asked for twice must not add up.

    Args: on_paths: placements of sites on their paths, which come last.
    """
    distinct: dict[tuple[object, float], Task] = {}
    for ik_task in (*(t.ik_task(time) for t in tasks), *on_paths):
        distinct.setdefault((ik_task.constraint, ik_task.phase), ik_task)
    return tuple(distinct.values())


@dataclass(frozen=True, slots=True, eq=False)
class EarlyEnd:
    """A task that stops holding before its block ends, since another block starts at that end.

    time: when it stops. successor: path of the block that starts.
    """

    time: Fraction
    successor: tuple[str, ...]
