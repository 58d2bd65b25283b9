"""From the constraints of one moment to a posture: docs/solver.md has these steps in words."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_solver.choice import best_of, fewest_able
from azee_solver.geometry import Side
from azee_solver.moment import Moment
from azee_solver.options import SolveOptions
from azee_solver.relaxed import RelaxedProblem
from azee_solver.reporting import report
from azee_solver.sequence import GroupSequence
from azee_solver.solution import Solution
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task
from azee_solver.widening import FINGER_M, least_reach, widened

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]


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

    Args: start: (V,) radians, where to start looking. reference: (V,) the posture to stay near;
        what no constraint moves has its value.
    Raises: BindingError: the rig lacks a bone, site or morph.
    """
    began = time.perf_counter()
    moment = Moment(rig, tasks, dominant, start, reference, options or SolveOptions())  # 1, 2
    relaxed = RelaxedProblem(moment.body, tasks, moment.footprints)
    groups = GroupSequence(moment, relaxed)

    solutions = [groups.solve(least_reach(moment))]  # 3, 4, 5
    while reach := widened(moment, solutions[-1]):  # 7
        _solve_relaxed(moment, relaxed, solutions[-1])  # 6
        solutions.append(groups.solve(reach, solutions[-1]))
    if not all(groups.is_well(result) for result in solutions[-1].results):  # 8
        _solve_relaxed(moment, relaxed, solutions[-1], whatever_overlaps=True)
        solutions[-1] = groups.solve(solutions[-1].reach, solutions[-1], further=True)

    best = _met(moment, solutions)  # 9
    if best is None:
        widest = groups.solve(solutions[-1].reach, solutions[-1], give_up=True)  # 10
        able = fewest_able(solutions[:-1], widest)
        narrower = [groups.solve(s.reach, s, give_up=True) for s in able]
        best = best_of(moment, [*narrower, widest])
    return report(moment, best, groups.spent_s, began)  # 11


def _solve_relaxed(
    moment: Moment, relaxed: RelaxedProblem, solution: Solution, *, whatever_overlaps: bool = False
) -> None:
    """Ask the relaxed problem which of the unmet tasks can be met at all.

    Args: whatever_overlaps: ask too where it may well be that the body is in the way.
    """
    asked = [
        (group, result)
        for group, result in zip(solution.groups, solution.results, strict=True)
        if result.unmet() and (whatever_overlaps or result.overlap_m < FINGER_M)
    ]
    among: dict[int, Task] = {}
    for group, _ in asked:
        among |= moment.tasks_of(group)
    relaxed.solve(frozenset().union(*(r.unmet() for _, r in asked)), among, solution.q)


def _met(moment: Moment, solutions: Sequence[Solution]) -> Solution | None:
    """Return a solution that misses nothing, if there is one.

    Along a movement that is the one that jumps least, else the last, which nothing overlaps.
    """
    met = [solution for solution in solutions if not solution.missed()]
    if met and moment.options.inertia:
        return min(met, key=lambda solution: moment.jump(solution.q))
    return solutions[-1] if met else None
