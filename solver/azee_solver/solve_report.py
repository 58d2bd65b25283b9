"""What came of solving a moment: the posture, each constraint measured again, and why some miss."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from azee_solver.collisions import Overlap
from azee_solver.constraint import Constraint
from azee_solver.evaluate import LengthOrAngle
from azee_solver.notation import problem_text, subject_text, target_text
from azee_solver.outcome import Outcome, Price, Reason, Strain
from azee_solver.task import Task


@dataclass(frozen=True, slots=True)
class ProblemReport:
    """One of the ordered problems.

    constraints: indices of its tasks, as given. asked: those tasks' constraints. chain: AZee
    bones from the root to its end. merged: the problem that it was solved together with, the first
    of its group; none for that one and for a problem solved alone. moved: parts of the body that
    were free. iterations: rounds of the two-level method; none where another solved it. solve_s:
    wall-clock time that it took, with those merged into it; it differs from run to run.
    """

    constraints: tuple[int, ...]
    asked: tuple[Constraint, ...]
    chain: tuple[str, ...]
    merged: ProblemReport | None
    moved: tuple[str, ...]
    iterations: int | None = None
    solve_s: float = field(default=0.0, compare=False)

    @property
    def name(self) -> str:
        """What its constraints speak of."""
        return problem_text(self.asked)

    @property
    def merged_into(self) -> str | None:
        """Name of the problem that it was solved together with."""
        return None if self.merged is None else self.merged.name


@dataclass(frozen=True, slots=True)
class ConstraintReport:
    """A constraint, measured on the final posture by forward kinematics outside the kernels.

    residual and tolerance in `unit`; NaN where the target has no direction. why: it is missed, in
    words or to be found; else none. price: what meeting it would have cost, if comfort has eased
    it or given it up.
    """

    task: Task
    residual: float
    unit: LengthOrAngle
    tolerance: float
    met: bool
    why: str | Reason | None
    price: Price | None = None

    @property
    def missed(self) -> bool:
        """Whether it is neither met nor eased."""
        return self.outcome is Outcome.MISSED

    @property
    def reason(self) -> str | None:
        """Why it is missed, else none; it is found when it is first asked for."""
        return self.why.text if isinstance(self.why, Reason) else self.why

    @property
    def outcome(self) -> Outcome:
        """What became of it."""
        if self.met:
            return Outcome.MET
        return Outcome.MISSED if self.why is not None else Outcome.EASED

    @property
    def kind(self) -> str:
        """What it speaks of, such as `place @EL(s)`."""
        return subject_text(self.task.constraint)

    @property
    def target(self) -> str:
        """What it wants of that."""
        return target_text(self.task.constraint)


@dataclass(frozen=True, slots=True, eq=False)
class SolveReport:
    """A solved moment.

    coordinates: (V,) radians, inside the limits. problems: in the order of their dependencies.
    constraints: those that joints can meet, in the order of the tasks. penetration: capsules
    that overlap beyond meant contacts, deepest first. reached: coordinates that the constraints
    may move. solve_s: wall-clock time of finding the posture; no other than times differs from
    run to run. strains: where the posture is beyond the comfortable.
    """

    coordinates: NDArray[np.float64]
    problems: tuple[ProblemReport, ...]
    constraints: tuple[ConstraintReport, ...]
    penetration: tuple[Overlap, ...]
    evaluations: int
    solve_s: float
    reached: frozenset[int]
    strains: tuple[Strain, ...] = ()

    @property
    def met(self) -> bool:
        """Whether every constraint is met."""
        return all(constraint.met for constraint in self.constraints)

    @property
    def missed(self) -> bool:
        """Whether a constraint is missed: neither met nor eased."""
        return any(constraint.missed for constraint in self.constraints)

    @property
    def explain_s(self) -> float:
        """Wall-clock time that it has taken so far to find out why constraints are missed."""
        return sum(c.why.spent_s for c in self.constraints if isinstance(c.why, Reason))
