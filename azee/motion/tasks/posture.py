"""Solved key postures, and who solves them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.limbs import TRUNK
from azee.motion.tasks.timed_task import Bound, limbs_asked
from azee_solver.task import Task

if TYPE_CHECKING:
    from azee_solver.solve_report import SolveReport

Array = NDArray[np.float64]


class Search(Enum):
    """How far a solver looks."""

    WIDE = "wide"
    """From several postures, for the best there is."""
    NEAR = "near"
    """From `start` alone: on the way of a movement the next posture must follow from the last."""


class PostureSolver(Protocol):
    """Whatever turns the tasks of one moment into a posture."""

    def __call__(
        self,
        tasks: Sequence[Task],
        *,
        start: Array,
        reference: Array,
        search: Search = Search.WIDE,
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
    ADDED = "added"
    """Interpolation would have left a constraint here."""


@dataclass(frozen=True, slots=True, eq=False)
class KeyPosture:
    """A posture at an instant, and the limbs that it fixes then.

    time: on the score's time line. coordinates: (V,). limbs: those it is a key of. passing: those
    of them that move through it without stopping. bounds: the requirements it serves. tasks:
    what the solver was given. report: its answer; for a posture that was taken over from an
    earlier instant with the same tasks, the answer given then, and `reused` is set.
    """

    time: Fraction
    coordinates: Array
    limbs: frozenset[str]
    passing: frozenset[str]
    bounds: tuple[Bound, ...]
    tasks: tuple[Task, ...]
    report: SolveReport
    origin: Origin
    reused: bool = False

    def holds(self, limb: str, needed: frozenset[str]) -> bool:
        """Whether a limb stays where this posture has it while others are needed.

        A limb that no requirement asked for was moved by the solver to suit the trunk, as a head
        is levelled over a bent one: it stays as long as the trunk does.
        """
        return limb in needed or (
            TRUNK in needed and limb in self.limbs and limb not in limbs_asked(self.bounds)
        )

    @property
    def met(self) -> bool:
        """Whether every task is within its tolerance."""
        return all(c.met for c in self.report.constraints)

    def misses(self) -> int:
        """Count the tasks out of tolerance."""
        return sum(not c.met for c in self.report.constraints)
