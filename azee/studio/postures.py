"""A posture solver for a text that is being edited: it remembers, and stops when told to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.animation import default_solver
from azee.motion.tasks.key_posture import PostureSolver, Search
from azee.motion.timing.remembering import RememberingSolver
from azee_rig.rig import Rig
from azee_solver.geometry import Side
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]
MOST_BODIES = 4


@dataclass(frozen=True, slots=True)
class Checked:
    """Another solver, with a check before every posture that may raise an exception."""

    solver: PostureSolver
    check: Callable[[], None]

    def __call__(
        self,
        ik_tasks: Sequence[Task],
        *,
        start: Array,
        reference: Array,
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        """Return a posture for the tasks, as `PostureSolver` says. Raises: what `check` raises."""
        self.check()
        return self.solver(ik_tasks, start=start, reference=reference, search=search, fixed=fixed)


class Postures:
    """The solvers of some bodies. What one has solved for a text is known for the next one."""

    def __init__(self) -> None:
        self._solvers: dict[tuple[int, Side, bool], tuple[Rig, RememberingSolver]] = {}

    def solver(
        self, rig: Rig, dominant: Side, precise: bool, check: Callable[[], None]
    ) -> PostureSolver:
        """Return the solver for a body and a strong hand, with a check."""
        key = (id(rig), dominant, precise)
        if key not in self._solvers:
            if len(self._solvers) >= MOST_BODIES:
                del self._solvers[next(iter(self._solvers))]
            remembering = RememberingSolver(default_solver(rig, dominant, precise))
            self._solvers[key] = rig, remembering
        return Checked(self._solvers[key][1], check)
