"""Key postures at the boundaries of blocks, solved in order of time.

Where a block ends at the instant at which another begins, one posture serves both if it can. Two
different postures cannot share an instant: a block holds on [start, end), so the instant belongs
to the block that begins, exactly on its time. The block that ends has its last key earlier, by the
time that the transition between the two postures needs, but by no more than half its own length.
Where times may bend, it ends as early as an arm needs for its way, but keeps a core. The report
names such early ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.limb_curves import transition_s
from azee.motion.keys.key_posture_solver import KeyPostureSolver
from azee.motion.keys.residual_monitor import in_force
from azee.motion.tasks.contradiction import contradict
from azee.motion.tasks.key_posture import KeyPosture, Origin
from azee.motion.tasks.key_selection import beginning_or_ending
from azee.motion.tasks.limbs import CARRIERS
from azee.motion.tasks.schedule import TaskSchedule
from azee.motion.tasks.timed_task import (
    EarlyEnd,
    TimedTask,
    ik_tasks_at,
    limbs_moved,
    limbs_used,
)
from azee.score.interval import Interval
from azee_solver import kinematics
from azee_solver.constraint import Constraint
from azee_solver.evaluate import Evaluator
from azee_solver.outcome import Outcome

LOOK_AHEAD_S = Fraction(3, 20)
"""Head and trunk take the posture of what begins within this time."""
SHORTEST_EARLY_END_S = Fraction(1, 12)
CORE_S = Fraction(3, 20)
"""What stays of a block that gives time to the way after it."""

Array = NDArray[np.float64]
NeededTime: TypeAlias = Callable[[Array, Array, frozenset[str]], float]
"""Seconds that some limbs need from one posture to another, (V,) radians each."""


@dataclass(frozen=True, slots=True, eq=False)
class Boundaries:
    """Solved key postures in order of time, and the early ends, by rank of the task."""

    postures: tuple[KeyPosture, ...]
    early_ends: dict[int, EarlyEnd]

    @property
    def unmet(self) -> frozenset[Constraint]:
        """Constraints that some of the postures do not meet."""
        answers = (c for p in self.postures for c in p.report.constraints)
        return frozenset(c.task.constraint for c in answers if not c.met)

    @property
    def eased(self) -> dict[Constraint, float]:
        """Constraints that are eased in some of the postures, and by how much at most."""
        out: dict[Constraint, float] = {}
        for answer in (c for p in self.postures for c in p.report.constraints):
            if answer.outcome is Outcome.EASED:
                constraint = answer.task.constraint
                out[constraint] = max(answer.residual, out.get(constraint, 0.0))
        return out


def solve_boundaries(
    schedule: TaskSchedule,
    solver: KeyPostureSolver,
    evaluator: Evaluator,
    deferred: frozenset[Fraction],
    needed_s: NeededTime | None = None,
) -> Boundaries:
    """Solve a key posture at every boundary of blocks, but for the deferred ones on paths.

    Args: needed_s: what a block that ends early leaves for the way; a quick transition by default.
    """
    postures: list[KeyPosture] = []
    early_ends: dict[int, EarlyEnd] = {}
    for keyframe in schedule.timeline.keyframes:
        time = keyframe.time
        tasks = in_force(schedule, time, early_ends)
        if not beginning_or_ending(tasks, time) or time in deferred:
            continue
        closing = [t for t in tasks if t.interval.end == time != t.interval.start]
        opening = [t for t in tasks if t not in closing]
        posture = _looking_ahead(time, opening, closing, schedule, solver)
        if posture is None:
            posture = _shared(time, opening, closing, solver, evaluator)
        if posture is None:
            postures += _separate(time, opening, closing, solver, early_ends, needed_s)
        else:
            postures.append(solver.accept(posture))
    return Boundaries(tuple(postures), early_ends)


def _looking_ahead(
    time: Fraction,
    opening: Sequence[TimedTask],
    closing: Sequence[TimedTask],
    schedule: TaskSchedule,
    solver: KeyPostureSolver,
) -> KeyPosture | None:
    """Return a posture in which head and trunk are already as the next blocks want them.

    It spares a movement to and fro: a gaze that would bend the head for .09 s, until a raised chin
    asks for the opposite, is met as well by eyes and neck (ADR 30).

    None if no task on a head or trunk that is in use begins soon, if that limb has been moved too
    recently to come from neutral, or if present and next tasks cannot all be met.
    """
    if solver.selection.flat or closing:
        return None
    carriers = limbs_moved(opening) & {*CARRIERS}
    ahead = [
        t
        for t in schedule.in_force.overlapping(Interval(time, time + LOOK_AHEAD_S))
        if t.interval.start > time
        and t.limb in CARRIERS
        and t.limbs & carriers
        and solver.neutral.since_moved(t.limb, time) >= t.interval.start - time
    ]
    if not ahead:
        return None
    posture = solver.solve(time, [*opening, *ahead])
    return replace(posture, timed_tasks=tuple(opening)) if posture.met else None


def _shared(
    time: Fraction,
    opening: Sequence[TimedTask],
    closing: Sequence[TimedTask],
    solver: KeyPostureSolver,
    evaluator: Evaluator,
) -> KeyPosture | None:
    """Return one posture for what begins and what ends; none if each needs its own.

    It is shared where no limb is used by both, and where it meets as much as a posture for what
    begins alone.
    """
    starting = [t for t in opening if t.interval.start == time]
    if not any(a.used_limbs & b.used_limbs for a in closing for b in starting):
        return solver.solve(time, [*opening, *closing])
    frames = kinematics.frames(evaluator.rig.chain, solver.current)
    if contradict(closing, starting, evaluator, frames):
        return None
    shared = solver.solve(time, [*opening, *closing])
    if shared.met or shared.reused or len(ik_tasks_at(opening, time)) == len(shared.ik_tasks):
        return shared
    return shared if solver.solve(time, opening).unmet_count >= shared.unmet_count else None


def _separate(
    time: Fraction,
    opening: Sequence[TimedTask],
    closing: Sequence[TimedTask],
    solver: KeyPostureSolver,
    early_ends: dict[int, EarlyEnd],
    needed_s: NeededTime | None,
) -> list[KeyPosture]:
    """Solve what begins on time, and give what ends there an earlier last key.

    All tasks of a block end early if one of them uses a limb that what begins uses.
    """
    starting = [t for t in opening if t.interval.start == time]
    contested = limbs_used(starting)
    ending_blocks = {t.path for t in closing if t.used_limbs & contested}
    ending = [t for t in closing if t.path in ending_blocks]
    staying = [t for t in closing if t.path not in ending_blocks]
    after = solver.solve(time, [*opening, *staying])
    lasting = [t for t in [*opening, *staying] if t.interval.start < time]
    before = solver.solve(time, [*ending, *lasting], Origin.EARLY_END, ending)
    end = time - _transition_s(before, after, ending, solver, needed_s)
    last_time = solver.last.time if solver.last is not None else None
    out: list[KeyPosture] = []
    if last_time is None or end > last_time:
        last_key = solver.solve(end, [*ending, *lasting], Origin.EARLY_END, ending)
        out.append(solver.accept(last_key))
    else:
        end = last_time
    successor = starting[0].path
    early_ends.update({t.rank: EarlyEnd(end, successor) for t in ending})
    out.append(solver.accept(after))
    return out


def _transition_s(
    before: KeyPosture,
    after: KeyPosture,
    ending: Sequence[TimedTask],
    solver: KeyPostureSolver,
    needed_s: NeededTime | None,
) -> Fraction:
    """Time for the transition between two postures: how much earlier a block ends.

    That of its slowest limb, at least `SHORTEST_EARLY_END_S`, at most half the shortest block. An
    arm that needs longer gets all of the block but its core.
    """
    leaving = limbs_used(ending)
    slowest = max(
        transition_s(before.coordinates[members], after.coordinates[members])
        for members in (solver.limbs.members[limb] for limb in leaving)
    )
    wanted = max(SHORTEST_EARLY_END_S, Fraction(round(slowest * 1000), 1000))
    shortest = min(t.interval.duration for t in ending)
    most = shortest / 2
    if needed_s is not None:
        needed = needed_s(before.coordinates, after.coordinates, leaving)
        wanted = max(wanted, Fraction(math.ceil(needed * 1000), 1000))
        most = max(most, shortest - CORE_S)
    return min(wanted, most)
