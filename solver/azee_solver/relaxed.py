"""The relaxed problem: the same constraints without collision, handshapes or posture cost.

What even the relaxed problem misses is infeasible. It is cheap, so it is solved before wider or
longer searches of the whole problem: infeasible tasks are given up at once, and a posture that
meets everything there is a start for the whole problem. The published tree, whose thumb is
infeasible: 58 → 14 ms (ADR 27).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from azee_solver.body import Body
from azee_solver.footprint import Footprint
from azee_solver.group_search import NEAR_MISS, REPEAT_WEIGHT, solve_group
from azee_solver.priorities import give_up_later_tasks
from azee_solver.result import Result
from azee_solver.task import Task

Array = NDArray[np.float64]

AGREEING_ENDS = 3
"""So many other descents must end where the best one does to tell that nothing meets all."""


class RelaxedProblem:
    """What is known so far about which tasks of a moment can be met at all.

    given_up: factors of the weights of tasks that gave way to others even there. infeasible: tasks
    that were unmet even there. postures: (V,) in which it met all that it was asked for.
    """

    def __init__(
        self, body: Body, tasks: Sequence[Task], footprints: Mapping[int, Footprint]
    ) -> None:
        self._body, self._tasks, self._footprints = body, tasks, footprints
        self._asked: frozenset[int] = frozenset()
        self.given_up: dict[int, float] = {}
        self.infeasible: frozenset[int] = frozenset()
        self.postures: list[Array] = []

    def solve(self, unmet: frozenset[int], among: Mapping[int, Task], q: Array) -> None:
        """Find out whether unmet tasks can be met together with others.

        A near miss proves nothing, nor do ends that differ from start to start.

        Args: among: the tasks to meet, by index. q: (V,) the posture so far.
        """
        if unmet <= self._asked:
            return
        self._asked |= unmet
        anatomy = self._body.anatomy
        free = frozenset().union(*(self._footprints[i].affected(anatomy) for i in among))
        free -= self._body.options.fixed
        if not free:
            return
        body = self._body.relaxed(q)
        # Patience for as many repeats as it takes to agree.
        body.options = replace(body.options, finish_work=0, patience=AGREEING_ENDS * REPEAT_WEIGHT)

        def again(factors: Mapping[int, float], begin: Array) -> Result:
            return solve_group(
                body, among, q, free, factors=factors, first=[begin], further=False, finish=False
            )

        result = again({}, q)
        if result.worst() > NEAR_MISS and result.repeats >= AGREEING_ENDS:
            factors, result = give_up_later_tasks(result, {}, again, lambda i: self._tasks[i].order)
            self.given_up |= factors
            self.infeasible |= result.unmet()
        elif not result.unmet():
            self.postures.append(result.q)
        self._body.evaluations += body.evaluations
