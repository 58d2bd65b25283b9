"""The solver of key postures at boundaries: what a solve starts from, and which limbs it keys."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.limb_curves import DIRECT_WITHIN_S, transition_s
from azee.motion.keys.incremental import solve_incrementally
from azee.motion.keys.neutral import SELF_RETURNING, ReturnToNeutral
from azee.motion.keys.transpath import PathMotion, limbs_on_paths
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.key_posture import KeyPosture, Origin, PostureSolver, Search
from azee.motion.tasks.key_selection import KeySelection, beginning_or_ending
from azee.motion.tasks.limbs import CARRIERS, Limbs
from azee.motion.tasks.recordings import RecordedBlock, imposed
from azee.motion.tasks.timed_task import TimedTask, ik_tasks_at, limbs_moved, limbs_used
from azee_rig.coordinates import Coordinates
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]


@dataclass(slots=True)
class KeyPostureSolver:
    """Solves key postures in order of time, and keeps the state of the body between them.

    What constraints leave open is drawn to neutral, never to the posture before. Drawn to the
    posture before, a trunk that leans bent a little more at each of twenty keyframes and ended at
    its limits, 40° twisted (ADR 6). The search starts from the posture before only in limbs that
    one block goes on constraining, so that no sign inherits an odd elbow from the last one.

    path_motions: by when they are between their placements. neutral: knows which limbs have
    returned to rest. recorded: signs that are played: all else is solved round them. current: (V,)
    the body after the last accepted posture.
    """

    coordinates: Coordinates
    selection: KeySelection
    solver: PostureSolver
    path_motions: IntervalIndex[PathMotion]
    neutral: ReturnToNeutral
    recorded: Sequence[RecordedBlock] = ()
    current: Array = field(init=False)
    last: KeyPosture | None = field(init=False, default=None)
    _released: dict[str, Fraction] = field(init=False, default_factory=dict)
    """Since when limbs of `SELF_RETURNING` are free of a task that has ended, while other tasks
    still move them."""

    @property
    def limbs(self) -> Limbs:
        """The limbs of the body."""
        return self.selection.limbs

    def __post_init__(self) -> None:
        self.current = np.array(self.neutral.posture)

    def solve(
        self,
        time: Fraction,
        tasks: Sequence[TimedTask],
        origin: Origin = Origin.BOUNDARY,
        ending_early: Sequence[TimedTask] = (),
    ) -> KeyPosture:
        """Return the posture for the tasks of an instant. It changes nothing until accepted.

        Args: ending_early: those of the tasks that end here though their blocks do not.
        """
        ik_tasks = ik_tasks_at(tasks, time)
        changing = [*beginning_or_ending(tasks, time), *ending_early]
        passing = limbs_on_paths(time, tasks, self.path_motions.at(time))
        playing = imposed(self.recorded, [time], len(self.current))
        mask = playing.mask[0]
        current = self._after_recordings(
            self.neutral.posture_at(self.current, self.last, time), time
        )
        current = np.where(mask, playing.values[0], current)
        solver = _round_what_is_played(self.solver, mask)
        owned = frozenset(n for block in self.recorded if block.plays(time) for n in block.limbs)
        returning = self._returning(time, self._released_with(tasks))
        answer: tuple[tuple[Task, ...], SolveReport] | None = None
        if self.last is not None and not returning:
            reused = self._reused(self.last, tasks, ik_tasks, changing, current)
            if reused is not None:
                keyed, report = reused
                return KeyPosture(
                    time, current, keyed - owned, passing, tuple(tasks), ik_tasks, report, origin,
                    reused=True,
                )  # fmt: skip
        constrained = limbs_moved(tasks)
        if constrained:
            constrained |= {*CARRIERS}
        free = self._members(constrained) & ~mask
        reference = np.where(free, self._drawn_to(tasks), current)
        start = np.where(self._members(self._lasting(time, tasks) - returning), current, reference)
        if self.last is not None and not returning:
            answer = solve_incrementally(
                self.last, tasks, ik_tasks, current, start, reference,
                limbs=self.limbs, solver=solver,
            )  # fmt: skip
        if answer is None:
            answer = ik_tasks, solver(ik_tasks, start=start, reference=reference)
        ik_tasks, report = answer
        keyed = self.selection.at_boundary(
            tasks, changing, report.coordinates - current, report.coordinates - reference
        )
        passing |= self.selection.passing_at_boundary(tasks, changing)
        return KeyPosture(
            time, report.coordinates, keyed - owned, passing, tuple(tasks), ik_tasks, report, origin
        )

    def accept(self, posture: KeyPosture) -> KeyPosture:
        """Make a posture the one that the next is solved after."""
        released = self._released_with(posture.timed_tasks)
        if not posture.reused:
            for limb in self._returning(posture.time, released):
                del released[limb]
        self._released = released
        self.current = np.array(posture.coordinates)
        self.neutral.record(posture)
        self.last = posture
        return posture

    def _after_recordings(self, posture: Array, time: Fraction) -> Array:
        """Return a posture with limbs where recordings left them a short while ago, (V,)."""
        out = posture.copy()
        for block in self.recorded:
            if not 0 < time - block.body.end <= DIRECT_WITHIN_S:
                continue
            last = block.sample(np.array([block.end_s]))[0]
            for limb in block.limbs:
                keyed = self.last is not None and limb in self.last.limbs
                if not (keyed and self.last is not None and self.last.time >= block.body.end):
                    members = self.limbs.members[limb]
                    out[members] = last[members]
        return out

    def _reused(
        self,
        last: KeyPosture,
        tasks: Sequence[TimedTask],
        ik_tasks: Sequence[Task],
        changing: Sequence[TimedTask],
        current: Array,
    ) -> tuple[frozenset[str], SolveReport] | None:
        """Return keyed limbs and report of the last posture, if it serves and nothing has moved."""
        if not _answers(last, ik_tasks):
            return None
        used = limbs_used(tasks)
        same = used | (last.limbs if set(ik_tasks) == set(last.ik_tasks) else frozenset())
        indices = [v for limb in same for v in self.limbs.members[limb]]
        if not np.array_equal(current[indices], last.coordinates[indices]):
            return None
        left = {t.constraint for t in ik_tasks}
        kept = tuple(c for c in last.report.constraints if c.task.constraint in left)
        unmoved = np.zeros(len(current))
        keyed = self.selection.at_boundary(tasks, changing, unmoved, unmoved)
        keyed |= same & last.limbs - used
        return keyed, replace(last.report, constraints=kept)

    def _released_with(self, tasks: Sequence[TimedTask]) -> dict[str, Fraction]:
        """Return since when limbs are released, if these are the tasks of the next posture."""
        out = dict(self._released)
        before = self.last.timed_tasks if self.last is not None else ()
        newly_moved = limbs_moved(t for t in tasks if t not in before)
        moved = limbs_moved(tasks)
        staying = {t.constraint for t in tasks}
        for limb in SELF_RETURNING:
            if limb in newly_moved or limb not in moved:
                out.pop(limb, None)
                continue
            for task in before:
                if limb in task.limbs and task.constraint not in staying:
                    end = task.interval.end
                    out[limb] = max(end, out.get(limb, end))
        return out

    def _returning(self, time: Fraction, released: Mapping[str, Fraction]) -> frozenset[str]:
        """Return released limbs that have had the time to return; their posture is solved anew.

        So a head that a glance has bent comes up again though its chin is still raised.
        """
        neutral = self.neutral.posture
        return frozenset(
            limb
            for limb, since in released.items()
            for members in (self.limbs.members[limb],)
            if time - since >= transition_s(self.current[members], neutral[members])
        )

    def _lasting(self, time: Fraction, tasks: Iterable[TimedTask]) -> frozenset[str]:
        """Return the limbs that one task moves both at the last posture and now."""
        if self.last is None:
            return frozenset()
        since = self.last.time
        return limbs_moved(t for t in tasks if t.interval.start <= since < time)

    def _drawn_to(self, tasks: Iterable[TimedTask]) -> Array:
        """Return what constraints leave open is drawn to, (V,).

        Neutral; rest in arms of which only the clavicle is moved: a raised shoulder lifts no hand.
        """
        moved = frozenset[int]().union(*(t.moves for t in tasks))
        names = self.coordinates.names
        beyond = (v for v in moved if not names[v].startswith("clav_"))
        posed = self.limbs.touching(beyond)
        idle = frozenset(n for n in self.limbs.touching(moved) - posed if n.startswith("arm_"))
        return np.where(self._members(idle), self.neutral.posture, self.coordinates.idle)

    def _members(self, limbs: frozenset[str]) -> NDArray[np.bool_]:
        """Return which coordinates belong to some limbs, (V,)."""
        chosen: NDArray[np.bool_] = np.array([n in limbs for n in self.limbs.names])
        return chosen[self.limbs.of_coordinate]


def _round_what_is_played(solver: PostureSolver, mask: NDArray[np.bool_]) -> PostureSolver:
    """Return a solver that leaves the coordinates of recordings where its start has them."""
    if not mask.any():
        return solver
    played = frozenset(np.flatnonzero(mask).tolist())

    def solve(
        ik_tasks: Sequence[Task],
        *,
        start: Array,
        reference: Array,
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        return solver(
            ik_tasks, start=start, reference=reference, search=search, fixed=fixed | played
        )

    return solve


def _answers(last: KeyPosture, ik_tasks: Iterable[Task]) -> bool:
    """Whether an earlier posture serves: for the same tasks, or for some of them.

    A task that it does not meet might be met now if a task that has ended moved the same limbs:
    then it does not serve.
    """
    before = {(t.constraint, t.phase) for t in last.ik_tasks}
    now = {(t.constraint, t.phase) for t in ik_tasks}
    if not now <= before:
        return False
    left = {constraint for constraint, _ in now}
    unmet = {c.task.constraint for c in last.report.constraints if not c.met} & left
    freed = limbs_moved(t for t in last.timed_tasks if t.constraint not in left)
    return not any(freed & t.used_limbs for t in last.timed_tasks if t.constraint in unmet)
