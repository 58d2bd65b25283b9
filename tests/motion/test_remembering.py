"""A solver that remembers: what is asked again is solved once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from timed_scores import LEFT, NEAR, F

from azee.motion.tasks.key_posture import Search
from azee.motion.timing.remembering import RememberingSolver
from azee_solver.solve_report import ConstraintReport, SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]


class Counting:
    """A solver that answers with the reference, and counts."""

    def __init__(self) -> None:
        self.asked = 0

    def __call__(
        self,
        ik_tasks: Sequence[Task],
        *,
        start: Array,
        reference: Array,
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        self.asked += 1
        answers = (ConstraintReport(t, 0.0, "m", 1.0, True, None) for t in ik_tasks)
        return SolveReport(
            np.array(reference), (), tuple(answers), (), self.asked, 0.0, frozenset()
        )


def test_postures_that_differ_only_in_where_they_stand_are_solved_once() -> None:
    counting, here, there = Counting(), np.zeros(3), np.ones(3)
    solver = RememberingSolver(counting)
    early = (Task(LEFT, ("A",), F(0), 0), Task(NEAR, ("B",), F(1), 1))
    late = (Task(LEFT, ("C",), F(2), 4), Task(NEAR, ("C", "D"), F(5), 7))
    first = solver(early, start=here, reference=here)
    again = solver(late, start=here, reference=here)
    assert counting.asked == 1
    assert again.evaluations == first.evaluations
    assert [c.task for c in again.constraints] == [*late]

    def asked_for(
        tasks: Sequence[Task],
        *,
        start: Array = here,
        reference: Array = here,
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> int:
        solver(tasks, start=start, reference=reference, search=search, fixed=fixed)
        return counting.asked

    assert asked_for((late[1], late[0])) == 2
    assert asked_for((late[0], replace(late[1], start_s=F(1)))) == 3
    assert asked_for((late[0], replace(late[1], rank=2))) == 4
    assert asked_for((late[0], replace(late[1], phase=0.5))) == 5
    assert asked_for(late, start=there) == 6
    assert asked_for(late, reference=there) == 7
    assert asked_for(late, fixed=frozenset((1,))) == 8
    assert asked_for(late, search=Search.LOCAL) == 9
    assert asked_for(late, search=Search.LOCAL) == 10
    assert asked_for(late) == 10
