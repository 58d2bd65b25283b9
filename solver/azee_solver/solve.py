"""From the constraints of one moment to a posture: docs/solver.md has these steps in words."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_solver.geometry import Side
from azee_solver.moment import Moment
from azee_solver.options import SolveOptions
from azee_solver.relaxed import RelaxedProblem
from azee_solver.reporting import report
from azee_solver.sequence import GroupSequence
from azee_solver.solve_report import SolveReport
from azee_solver.symmetry import symmetric
from azee_solver.task import Task
from azee_solver.widening import least_reach, widened

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

    Facial morphs, trills and transpaths are ignored: the face and the movement meet them, not a
    posture.

    Args: start: (V,) radians, where to start looking. reference: (V,) the posture to stay near;
        what no constraint moves has its value.
    Raises: BindingError: the rig lacks a bone, site or morph.
    """
    began = time.perf_counter()
    moment = Moment(rig, tasks, dominant, start, reference, options or SolveOptions())  # 1, 2
    relaxed = RelaxedProblem(moment)
    groups = GroupSequence(moment, relaxed)
    solution = groups.solve(least_reach(moment))  # 3, 4, 5
    while reach := widened(moment, solution):  # 6
        relaxed.solve(solution)  # 7
        solution = groups.solve(reach, solution)  # 4, 5
    if solution.missed():
        solution = groups.solve(solution.reach, solution, give_up=True)  # 8
    solution = symmetric(moment, solution)  # 9
    if not moment.options.precise:
        solution = groups.solve(solution.reach, solution, comfort=True)  # 10
    return report(moment, solution, groups.spent_s, began)  # 11
