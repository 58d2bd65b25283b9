"""Key postures by the published two-level iterations, for comparison."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.posture import PostureSolver, Search
from azee_rig.rig import Rig
from azee_solver.geometry import Side
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task
from azee_solver.two_level import solve_two_level


def two_level_solver(rig: Rig, dominant: Side) -> PostureSolver:
    """Return a solver of key postures that knows one way to search, wherever it is to look."""

    def answer(
        tasks: Sequence[Task],
        *,
        start: NDArray[np.float64],
        reference: NDArray[np.float64],
        search: Search = Search.WIDE,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        return solve_two_level(
            rig, tasks, dominant=dominant, start=start, reference=reference, fixed=fixed
        )

    return answer
