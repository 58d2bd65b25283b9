"""Key postures by the published two-level iterations, for comparison."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.key_posture import PostureSolver, Search
from azee_rig.rig import Rig
from azee_solver.geometry import Side
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task
from azee_solver.two_level import solve_two_level


def two_level_solver(rig: Rig, dominant: Side) -> PostureSolver:
    """Return a posture solver that searches in one way, whatever `search` asks for."""

    def answer(
        ik_tasks: Sequence[Task],
        *,
        start: NDArray[np.float64],
        reference: NDArray[np.float64],
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        return solve_two_level(
            rig, ik_tasks, dominant=dominant, start=start, reference=reference, fixed=fixed
        )

    return answer
