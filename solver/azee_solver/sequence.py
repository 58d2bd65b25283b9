"""Solving all groups of a moment, each with what the earlier ones reached."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from azee_solver.comfort import eased
from azee_solver.group_search import DEEP, solve_group
from azee_solver.groups import Group, grouped
from azee_solver.moment import Moment
from azee_solver.priorities import give_up_later_tasks, take_back
from azee_solver.problems import Reach
from azee_solver.relaxed import RelaxedProblem
from azee_solver.result import Result
from azee_solver.solution import Solution

Array = NDArray[np.float64]


class GroupSequence:
    """Solves the groups of a moment in the order of their dependencies.

    spent_s: time that groups have taken, by their problems.
    """

    def __init__(self, moment: Moment, relaxed: RelaxedProblem) -> None:
        self.moment, self.relaxed = moment, relaxed
        self.spent_s: dict[tuple[int, ...], float] = {}

    def solve(
        self,
        reach: Sequence[Reach],
        before: Solution | None = None,
        *,
        give_up: bool = False,
        comfort: bool = False,
    ) -> Solution:
        """Return the posture in which all groups end.

        Args: reach: how much of the body each problem may move. before: a solution whose results
            stand where nothing they depend on has changed. give_up: where constraints exclude each
            other, give up the later ones.
        """
        moment = self.moment
        groups = grouped(moment.problems, reach, moment.body.anatomy, moment.options.fixed)
        q = moment.reference.copy()
        results = []
        for n, group in enumerate(groups):
            began = time.perf_counter()
            unsettled = frozenset().union(*(g.free for g in groups[n + 1 :]))
            result = self._found_before(group, q, before)
            if result is None:
                result = self._searched(group, q, unsettled, before)
            if give_up:
                result = self._without_later_tasks(group, q, unsettled, result)
            if comfort:
                result = eased(moment, group, q, unsettled, result)
            q = q.copy()
            q[sorted(group.free)] = result.q[sorted(group.free)]
            results.append(result)
            spent_s = self.spent_s.get(group.problems, 0.0) + time.perf_counter() - began
            self.spent_s[group.problems] = spent_s
        return Solution(q, tuple(reach), tuple(groups), tuple(results))

    def _found_before(self, group: Group, q: Array, before: Solution | None) -> Result | None:
        """Return an earlier result for the same group with the same surroundings."""
        around = sorted(group.reads - group.free)
        if before is None or not np.array_equal(q[around], before.q[around]):
            return None
        for other, result in zip(before.groups, before.results, strict=True):
            if (other.problems, other.free) == (group.problems, group.free):
                given_up = self._given_up(group).keys()
                return result if result.given_up >= given_up else None
        return None

    def _searched(
        self, group: Group, q: Array, unsettled: frozenset[int], before: Solution | None
    ) -> Result:
        """Solve one group; all its tasks have equal rights but those that are given up."""
        first = self.moment.start if before is None else before.q
        return solve_group(
            self.moment.body,
            self.moment.tasks_of(group),
            q,
            group.free,
            unsettled=unsettled,
            factors=self._given_up(group),
            first=[first, *self.relaxed.postures],
            further=self.moment.is_widest(group),
            finish=False,
        )

    def _without_later_tasks(
        self, group: Group, q: Array, unsettled: frozenset[int], result: Result
    ) -> Result:
        """Give up later tasks of a group as far as the earlier ones need it, and finish."""
        tasks = self.moment.tasks_of(group)

        def again(factors: Mapping[int, float], begin: Array, *, finish: bool = False) -> Result:
            return solve_group(
                self.moment.body,
                tasks,
                q,
                group.free,
                unsettled=unsettled,
                factors=factors,
                first=[begin],
                only_first=finish,
                further=False,
                finish=finish,
            )

        given_up = self._given_up(group)
        factors, found = give_up_later_tasks(result, given_up, again, self.moment.precedence)
        if factors != given_up:
            deepest_m = DEEP * self.moment.options.overlap_m
            factors, found = take_back(
                found, factors, given_up, again, result.q, deepest_m=deepest_m
            )
        if found.unmet() or factors != given_up:
            found = again(factors, found.q, finish=True)
        return found

    def _given_up(self, group: Group) -> dict[int, float]:
        """Factors of the weights of a group's tasks that the relaxed problem gave up."""
        tasks = self.moment.tasks_of(group)
        return {i: factor for i, factor in self.relaxed.given_up.items() if i in tasks}
