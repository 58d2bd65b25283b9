"""A posture solver that remembers its answers.

Bending a score asks for most postures again, and so does a sign that comes back in a text.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.key_posture import PostureSolver, Search
from azee_solver.constraint import Constraint
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]

_Question: TypeAlias = tuple[
    tuple[tuple[Constraint, float, int, int], ...], bytes, bytes, frozenset[int]
]


MOST_ANSWERS = 2000
"""Answers that are remembered; beyond, the oldest go."""


@dataclass(slots=True)
class RememberingSolver:
    """Gives the answer of another solver, once more without solving where only times differ.

    When a task starts and in which block it stands does not matter for a posture; which of two
    tasks starts first, or was written first, does. Only global searches are remembered: local ones
    belong to the frames of one movement. It may serve several movements of one body with one strong
    hand, as while a text is edited.
    """

    solver: PostureSolver
    _answers: dict[_Question, tuple[tuple[Task, ...], SolveReport]] = field(
        init=False, default_factory=dict
    )

    def __call__(
        self,
        ik_tasks: Sequence[Task],
        *,
        start: Array,
        reference: Array,
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        """Return a posture for the tasks, as `PostureSolver` says."""
        if search is not Search.GLOBAL:
            return self.solver(
                ik_tasks, start=start, reference=reference, search=search, fixed=fixed
            )
        question = _question(ik_tasks, start, reference, fixed)
        if question not in self._answers:
            report = self.solver(ik_tasks, start=start, reference=reference, fixed=fixed)
            self._answers[question] = tuple(ik_tasks), report
            if len(self._answers) > MOST_ANSWERS:
                del self._answers[next(iter(self._answers))]
            return report
        asked, report = self._answers[question]
        now = dict(zip(asked, ik_tasks, strict=True))
        return replace(
            report, constraints=tuple(replace(c, task=now[c.task]) for c in report.constraints)
        )


def _question(
    ik_tasks: Sequence[Task], start: Array, reference: Array, fixed: frozenset[int]
) -> _Question:
    """Return all that an answer depends on."""
    starts = {t: n for n, t in enumerate(sorted({t.start_s for t in ik_tasks}))}
    ranks = {rank: n for n, rank in enumerate(sorted({t.rank for t in ik_tasks}))}
    asked = tuple((t.constraint, t.phase, ranks[t.rank], starts[t.start_s]) for t in ik_tasks)
    return asked, start.tobytes(), reference.tobytes(), fixed
