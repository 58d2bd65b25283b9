"""The relaxed problem: the same constraints without collision, handshapes and joint-limit cost.

Of the posture cost a thousandth is left (`Body.relaxed`).

What even the relaxed problem misses is infeasible. It is cheap, so it is solved before wider or
longer searches of the whole problem: infeasible tasks are given up at once, and a posture that
meets everything there is a start for the whole problem. The published tree, whose thumb is
infeasible: 58 → 14 ms (ADR 27).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from azee_solver.group_search import NEAR_MISS, REPEAT_WEIGHT, solve_group
from azee_solver.moment import Moment
from azee_solver.priorities import give_up_later_tasks
from azee_solver.result import Result
from azee_solver.solution import Solution
from azee_solver.task import Task

Array = NDArray[np.float64]

DEEP_M = 0.02
"""Where capsules overlap by more than a finger's thickness, the body is in the way. Asking the
relaxed problem there too takes 748 evaluations instead of 271 for the published tree (ADR 29)."""
AGREEING_ENDS = 3
"""If so many other descents end where the best one does, nothing meets all tasks."""


class RelaxedProblem:
    """What is known so far about which tasks of a moment can be met at all.

    given_up: factors of the weights of tasks that could not be met with the others even there.
    postures: (V,) in which it met all that it was asked for.
    """

    def __init__(self, moment: Moment) -> None:
        self._moment = moment
        self._asked: frozenset[int] = frozenset()
        self.given_up: dict[int, float] = {}
        self.postures: list[Array] = []

    def solve(self, solution: Solution) -> None:
        """Find out whether the unmet tasks of a solution can be met together with their groups.

        Groups that overlap deeply are left out: there the body is in the way, and more of it will
        be moved first. Neither a near miss nor ends that differ from start to start prove that
        tasks are infeasible.
        """
        moment = self._moment
        unmet: frozenset[int] = frozenset()
        among: dict[int, Task] = {}
        for group, result in zip(solution.groups, solution.results, strict=True):
            if result.unmet() and result.overlap_m < DEEP_M:
                unmet |= result.unmet()
                among |= moment.tasks_of(group)
        if unmet <= self._asked:
            return
        self._asked |= unmet
        free = frozenset().union(
            *(moment.footprints[i].affected(moment.body.anatomy) for i in among)
        )
        free -= moment.options.fixed
        if not free:
            return
        body = moment.body.relaxed(solution.q)
        # Patience for as many repeats as it takes to agree.
        body.options = replace(body.options, finish_work=0, patience=AGREEING_ENDS * REPEAT_WEIGHT)

        def again(factors: Mapping[int, float], begin: Array) -> Result:
            return solve_group(
                body,
                among,
                solution.q,
                free,
                factors=factors,
                first=[begin],
                further=False,
                finish=False,
            )

        result = again({}, solution.q)
        if result.worst() > NEAR_MISS and result.repeats >= AGREEING_ENDS:
            factors, result = give_up_later_tasks(result, {}, again, moment.precedence)
            self.given_up |= factors
        elif not result.unmet():
            self.postures.append(result.q)
        moment.body.evaluations += body.evaluations
