"""Key postures, and the interface of what solves them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.limbs import TRUNK
from azee.motion.tasks.timed_task import TimedTask, limbs_used
from azee_solver.task import Task

if TYPE_CHECKING:
    from azee_solver.solve_report import SolveReport

Array = NDArray[np.float64]


class Search(Enum):
    """How a solver searches."""

    GLOBAL = "global"
    """From several starts, for the best posture that any of them leads to."""
    LOCAL = "local"
    """From `start` alone: inside a movement each posture must be near the one before."""


class PostureSolver(Protocol):
    """An inverse-kinematics solver: it turns the tasks of one moment into a posture."""

    def __call__(
        self,
        ik_tasks: Sequence[Task],
        *,
        start: Array,
        reference: Array,
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        """Return the posture nearest to `reference` that meets the tasks, found from `start`.

        Args: start, reference: (V,) coordinates inside the limits, radians. fixed: coordinates
            that stay as in `start`.
        """


class Origin(Enum):
    """Why a key posture exists."""

    BOUNDARY = "boundary"
    """A block begins or ends."""
    EARLY_END = "early end"
    """A block ends where another begins that no posture can join with it."""
    PATH = "path"
    """A sample of a controlled movement."""


@dataclass(frozen=True, slots=True, eq=False)
class KeyPosture:
    """A posture at an instant, and the limbs that it is a key of.

    time: on the score's time line. coordinates: (V,) radians. limbs: the limbs that it keys.
    passing: those of them that move through it without stopping. timed_tasks: the tasks of the
    score that it serves. ik_tasks: what the solver was given. report: the solver's answer; where
    `reused` is set, the answer that an earlier instant got for the same tasks.
    """

    time: Fraction
    coordinates: Array
    limbs: frozenset[str]
    passing: frozenset[str]
    timed_tasks: tuple[TimedTask, ...]
    ik_tasks: tuple[Task, ...]
    report: SolveReport
    origin: Origin
    reused: bool = False

    def holds(self, limb: str, needed: frozenset[str]) -> bool:
        """Whether a limb stays where this posture has it while other limbs are needed.

        A keyed limb that no task uses was moved by the solver to suit the trunk, as a head is
        levelled over a bent one. It stays as long as the trunk is needed.
        """
        return limb in needed or (
            TRUNK in needed and limb in self.limbs and limb not in limbs_used(self.timed_tasks)
        )

    @property
    def met(self) -> bool:
        """Whether every task is met or eased."""
        return self.unmet_count == 0

    @property
    def unmet_count(self) -> int:
        """How many tasks are missed."""
        return sum(c.missed for c in self.report.constraints)
