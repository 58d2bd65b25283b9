"""From the constraints of one moment to a posture.

The paper's ordered problems are built, those that share coordinates are grouped, and the groups
are solved in the order of their dependencies, each with what the earlier ones reached. Where one
misses, its problems may move more of the body, up to the trunk, together with those they depend
on; where no posture meets all, what starts earlier or goes before by its kind wins.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_solver.anatomy import Part
from azee_solver.attempt import solve_group
from azee_solver.body import Body
from azee_solver.constraint import Place
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Side
from azee_solver.ghost import Ghost
from azee_solver.groups import Group, grouped
from azee_solver.options import SolveOptions
from azee_solver.problems import Problem, ProblemBuilder, Reach
from azee_solver.report import SolveReport
from azee_solver.result import Result, excess
from azee_solver.settling import giving_way
from azee_solver.state import State
from azee_solver.task import Task
from azee_solver.verdict import verdict

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]

CLEARLY = 0.7
"""Moving more of the body is worth it for misses below this part of the others."""
DODGED_M = 0.02
"""Deeper overlaps than a finger is thick are none that fingers get out of."""
LEAP_RAD = math.radians(1.5)
"""Along a movement, where a coordinate changes by more than this, more of the body may share it."""
BEGUN_RAD = math.radians(1.0)
"""A coordinate farther than this from the reference has been taken into use by an earlier step."""


def solve(
    rig: Rig,
    tasks: Sequence[Task],
    *,
    dominant: Side,
    start: Array,
    reference: Array,
    options: SolveOptions | None = None,
) -> SolveReport:
    """Return the posture that meets the constraints, or the nearest one and why.

    Facial morphs, trills and transpaths are not the joints' to meet and are passed over.

    Args: start: (V,) where to start looking. reference: (V,) the posture to stay near; what no
        constraint moves has its value.
    Raises: BindingError: the rig lacks a bone, site or morph.
    """
    began = time.perf_counter()
    moment = _Moment(rig, tasks, dominant, start, reference, options or SolveOptions())
    state = moment.solve()
    return verdict(
        moment.body, tasks, moment.problems, moment.footprints, state, moment.spent_s, began
    )


class _Moment:
    def __init__(
        self,
        rig: Rig,
        tasks: Sequence[Task],
        dominant: Side,
        start: Array,
        reference: Array,
        options: SolveOptions,
    ) -> None:
        self.rig, self.tasks = rig, tasks
        self.options = replace(options, posture=(1.0 + options.inertia) * options.posture)
        limits = rig.coordinates
        measure = evaluator(rig, dominant)
        for task in tasks:
            measure.binding.check(task.constraint)
        self.constraints = [task.constraint for task in tasks]
        presets = measure.binding.presets(self.constraints)
        self.start = np.clip(start, limits.lower, limits.upper)
        self.rest = np.clip(reference, limits.lower, limits.upper)
        self.rest += options.inertia / (1.0 + options.inertia) * (self.start - self.rest)
        for v in options.fixed:
            self.rest[v] = self.start[v]
        self.body = Body(rig, measure, self.rest.copy(), presets, self.options, self.constraints)
        for v, angle in presets.items():
            if v not in options.fixed:
                self.rest[v] = np.clip(angle, limits.lower[v], limits.upper[v])
        builder = ProblemBuilder(tasks, measure.binding, self.body.anatomy)
        self.problems: tuple[Problem, ...] = builder.build()
        self.footprints = builder.footprints
        self.spent_s: dict[tuple[int, ...], float] = {}
        """Time that groups have taken, by their problems."""
        self.ghost = Ghost(self.body, tasks, builder.footprints)

    # Solving ----------------------------------------------------------------------------------

    def solve(self) -> State:
        """Solve with as little of the body as will do.

        Where nothing meets all, postures that move less of the body stand against those that move
        more. Settling gives up at least one constraint in every group that misses, which tells
        beforehand who cannot win.
        """
        reach = [self._begun(problem) for problem in self.problems]
        tried = [(reach, self._in_order(reach, None))]
        while wider := self._widened(*tried[-1]):
            self._ask_a_ghost(tried[-1][1], in_the_way=False)
            tried.append((wider, self._in_order(wider, tried[-1][1])))
        reach, state = tried[-1]
        if not all(self._is_well(result) for result in state.results):
            self._ask_a_ghost(state, in_the_way=True)
            tried[-1] = reach, self._in_order(reach, state, thorough=True)
        met = [state for _, state in tried if not state.missed()]
        if met and self.options.inertia:
            return min(met, key=lambda state: self._leap(state.q))
        if met:
            return tried[-1][1]
        widest = self._in_order(*tried[-1], settle=True)
        fewest = len(self._misses(widest))
        able = [(r, s) for r, s in tried[:-1] if sum(bool(g.missed()) for g in s.results) <= fewest]
        settled = [self._in_order(reach, state, settle=True) for reach, state in able]
        best = (*settled, widest)[0]
        for state in (*settled, widest)[1:]:
            if self._prefers(state, best):
                best = state
        return best

    def _leap(self, q: Array) -> float:
        """How far a posture is from the one before, in the coordinate that is farthest."""
        return float(np.abs(q - self.start).max())

    def _begun(self, problem: Problem) -> Reach:
        """Return what a problem may move first: along a movement, what the last step has moved."""
        if not self.options.inertia:
            return Reach.OWN
        anatomy_ = self.body.anatomy
        steps = [
            # Where the trunk may move the head moves too, to stay level.
            step | (anatomy_.of(Part.HEAD) if step & anatomy_.of(Part.TRUNK) else frozenset())
            for step in problem.steps
        ]
        away = np.abs(self.start - self.body.reference) > BEGUN_RAD / (1.0 + self.options.inertia)
        moved = frozenset(np.flatnonzero(away).tolist()) & steps[Reach.ALL]
        moved -= self.options.fixed | frozenset(self.body.presets)
        return next(r for r in Reach if moved <= steps[r] or r is Reach.ALL)

    def _in_order(
        self,
        reach: Sequence[Reach],
        before: State | None,
        *,
        thorough: bool = False,
        settle: bool = False,
    ) -> State:
        """Solve all groups, each with what the earlier ones reached.

        Args: before: a state whose results stand where nothing they depend on has changed.
            thorough: no wider problem will take over: look further in groups that miss. settle:
            where constraints exclude each other, the later ones give way.
        """
        groups = grouped(self.problems, reach, self.body.anatomy, self.options.fixed)
        q = self.rest.copy()
        results = []
        for n, group in enumerate(groups):
            unsettled = frozenset().union(*(g.free for g in groups[n + 1 :]))
            began = time.perf_counter()
            result = self._standing(group, q, before)
            last = self._is_last(group)
            if result is None or (thorough and not last and not self._is_well(result)):
                first = [self.start] if before is None else [before.q, self.start]
                first += self.ghost.postures
                further = (thorough or last) and not self._is_in_vain(group, before)
                result = self._together(group, q, unsettled, first, thorough=further)
            if settle:
                result = self._settled(group, q, unsettled, result)
            q = q.copy()
            q[sorted(group.free)] = result.q[sorted(group.free)]
            results.append(result)
            spent_s = self.spent_s.get(group.problems, 0.0) + time.perf_counter() - began
            self.spent_s[group.problems] = spent_s
        return State(q, tuple(groups), tuple(results))

    def _standing(self, group: Group, q: Array, before: State | None) -> Result | None:
        """Return an earlier result for the same group with the same surroundings."""
        around = sorted(group.reads - group.free)
        if before is None or not np.array_equal(q[around], before.q[around]):
            return None
        for other, result in zip(before.groups, before.results, strict=True):
            if (other.problems, other.free) == (group.problems, group.free):
                eased = self.ghost.given_up.keys() & self._tasks_of(group).keys()
                return result if result.eased >= eased else None
        return None

    def _together(
        self,
        group: Group,
        q: Array,
        unsettled: frozenset[int],
        first: Sequence[Array],
        *,
        thorough: bool,
    ) -> Result:
        """Solve one group, all its constraints with equal right but those that were given up."""
        tasks = self._tasks_of(group)
        return solve_group(
            self.body,
            tasks,
            q,
            group.free,
            unsettled=unsettled,
            ease={i: ease for i, ease in self.ghost.given_up.items() if i in tasks},
            first=first,
            thorough=thorough,
            to_the_end=False,
        )

    def _is_in_vain(self, group: Group, before: State | None) -> bool:
        """Whether all that a group has missed so far is missed by a ghost too."""
        if before is None:
            return False
        tasks = self._tasks_of(group).keys()
        lost = frozenset().union(*(r.lost() for r in before.results)) & tasks
        return bool(lost) and lost <= self.ghost.hopeless

    def _is_last(self, group: Group) -> bool:
        """Whether nothing more can be given to a group."""
        return all(
            self.problems[p].steps[Reach.ALL] <= group.free | self.options.fixed
            for p in group.problems
        )

    def _is_well(self, result: Result) -> bool:
        """Whether nothing is missed that could be met, and nothing is in the way."""
        return not result.lost() and not excess(result, self.options)

    def _settled(self, group: Group, q: Array, unsettled: frozenset[int], result: Result) -> Result:
        """Where constraints exclude each other, let the later ones give way to the earlier."""

        def again(ease: Mapping[int, float], begin: Array, *, finish: bool = False) -> Result:
            return solve_group(
                self.body,
                tasks,
                q,
                group.free,
                unsettled=unsettled,
                ease=ease,
                first=[begin] if finish else [begin, self.start],
                only_first=finish,
                thorough=False,
                to_the_end=finish,
            )

        tasks = self._tasks_of(group)
        given = {i: ease for i, ease in self.ghost.given_up.items() if i in tasks}
        ease, settled = giving_way(result, given, again, lambda i: self.tasks[i].order)
        if settled.lost() or ease != given:
            settled = again(ease, settled.q, finish=True)
        return settled

    def _ask_a_ghost(self, state: State, *, in_the_way: bool) -> None:
        """Find out what of the misses could be met if nothing were in the way.

        Args: in_the_way: ask too where it may well be that the body is in the way.
        """
        asked = [
            (group, result)
            for group, result in zip(state.groups, state.results, strict=True)
            if result.lost() and (in_the_way or result.overlap_m < DODGED_M)
        ]
        among: dict[int, Task] = {}
        for group, _ in asked:
            among |= self._tasks_of(group)
        self.ghost.ask(frozenset().union(*(r.lost() for _, r in asked)), among, state.q)

    def _tasks_of(self, group: Group) -> dict[int, Task]:
        indices = sorted(i for p in group.problems for i in self.problems[p].tasks)
        return {i: self.tasks[i] for i in indices}

    def _widened(self, reach: Sequence[Reach], state: State) -> list[Reach] | None:
        """Let problems of groups that miss move more, where that can help; none if nothing can."""
        wider = list(reach)
        for group, result in zip(state.groups, state.results, strict=True):
            missed = result.lost()
            in_the_way = result.overlap_m > self.options.overlap_m
            leaps = self.options.inertia > 0.0 and self._leap(result.q) > LEAP_RAD
            if not missed and not in_the_way and not leaps:
                continue
            touched = frozenset().union(
                *(self.footprints[i].affected(self.body.anatomy) for i in missed)
            )
            for p in group.problems:
                steps = self.problems[p].steps
                for r in Reach:
                    gain = steps[r] - group.free - self.options.fixed
                    linked = r is Reach.TRUNK > reach[p] and self._is_linked(p, group)
                    dodges = in_the_way and (r > Reach.FINGERS or result.overlap_m < DODGED_M)
                    helps = gain & touched or (gain and (dodges or leaps))
                    if r > reach[p] and (helps or linked):
                        wider[p] = r
                        break
        return None if wider == list(reach) else wider

    def _is_linked(self, p: int, group: Group) -> bool:
        """Whether a problem depends on one that is not in its group."""
        return any(
            self.problems[p].needs(other)
            for j, other in enumerate(self.problems)
            if j not in group.problems
        )

    def _prefers(self, one: State, other: State) -> bool:
        """Whether to take a posture that moves more of the body."""
        a, b = self._misses(one), self._misses(other)
        if len(a) != len(b):
            return len(a) < len(b)
        places = [
            sum(r for i, r in m.items() if isinstance(self.constraints[i], Place)) for m in (a, b)
        ]
        if abs(places[0] - places[1]) > 1.0:
            return places[0] < places[1]
        ratio = sum(a.values()) / sum(b.values()) if b else 1.0
        if not CLEARLY < ratio < 1 / CLEARLY:
            return ratio < 1
        depth = [max(r.overlap_m for r in s.results) for s in (one, other)]
        return depth[0] < depth[1] - self.options.overlap_m

    def _misses(self, state: State) -> dict[int, float]:
        return {i: r.ratios[i] for r in state.results for i in r.missed() - r.undefined}
