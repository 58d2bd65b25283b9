"""The published way to solve a keyframe: two nested iterations, for comparison with `solve`.

Nunnari, Filhol and Heloir (2018, listing 1) solve the ordered problems one by one. Within one they
apply its constraints one at a time, each with an inverse-kinematics solver that knows nothing of
the others, first the placement, then the rotations; then they measure all of them, and begin again
as long as one is out of its threshold. Their inner solver is Blender's iTaSC; here it is the
descent that `solve` makes too, on the one constraint, to the posture nearest to where it stood.

Nothing keeps the body out of itself, nothing prefers one elbow to another, and a problem that has
been solved is not looked at again: these are the method's faults, kept on purpose.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_solver.anatomy import Part
from azee_solver.body import Body
from azee_solver.constraint import (
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.evaluate import Evaluator
from azee_solver.group_search import solve_group
from azee_solver.options import SolveOptions
from azee_solver.problems import Problem, ProblemBuilder, Reach
from azee_solver.solve_report import ConstraintReport, ProblemReport, SolveReport
from azee_solver.task import Task
from azee_solver.tolerance import PAPER

if TYPE_CHECKING:
    from azee_rig.rig import Rig
    from azee_solver.geometry import Side

Array = NDArray[np.float64]

MAX_ITERATIONS = 35
"""MAX_ITER of the paper's §4.5."""

STAY = 1e-3
"""Per squared radian away from where a constraint found the body: chooses among the postures that
meet it, and costs a thousandth of a threshold."""

CONTENT = "within 1 cm or 5°, where the two-level iterations stop"
GIVEN_UP = "where the two-level iterations left it; they look for no reason"


def solve_two_level(
    rig: Rig,
    tasks: Sequence[Task],
    *,
    dominant: Side,
    start: Array,
    reference: Array,
    fixed: frozenset[int] = frozenset(),
) -> SolveReport:
    """Return the posture in which the two nested iterations end.

    Arguments and report are those of `azee_solver.solve.solve`. A problem of the report tells how
    many outer iterations it took, as the paper's figures 5 and 8 count them: one if its first
    round met all. They end at the paper's thresholds; the report measures with our tolerances.

    Args: fixed: coordinates that must not move from the start.
    Raises: BindingError: the rig lacks a bone, site or morph.
    """
    began = time.perf_counter()
    keyframe = _Keyframe(rig, tasks, dominant, start, reference, fixed)
    reports = []
    for problem, chain in zip(keyframe.problems, keyframe.chains, strict=True):
        started = time.perf_counter()
        iterations = keyframe.iterate(problem, chain)
        spent_s = time.perf_counter() - started
        reports.append(keyframe.problem_report(problem, chain, iterations, spent_s))
    return keyframe.report(reports, began)


class _Keyframe:
    """The problems of one moment, and the body as they leave it one after the other."""

    def __init__(
        self,
        rig: Rig,
        tasks: Sequence[Task],
        dominant: Side,
        start: Array,
        reference: Array,
        fixed: frozenset[int],
    ) -> None:
        self.rig, self.tasks, self.fixed = rig, tasks, fixed
        limits = rig.coordinates
        evaluator = Evaluator(rig, dominant)
        self.constraints = [task.constraint for task in tasks]
        for constraint in self.constraints:
            evaluator.binding.check(constraint)
        self.presets = evaluator.binding.presets(self.constraints)
        options = SolveOptions(
            tolerance=PAPER, posture=STAY, comfort=0.0, overlap=0.0, overlap_m=math.inf
        )
        self.q = np.clip(reference, limits.lower, limits.upper)
        self.body = Body(rig, evaluator, self.q, {}, options, self.constraints)
        self.problems = ProblemBuilder(tasks, evaluator.binding, self.body.anatomy).build()
        self.chains = self._chains()
        kept = sorted(fixed.union(*self.chains))
        self.q[kept] = np.clip(start, limits.lower, limits.upper)[kept]
        for v, angle in self.presets.items():
            if v not in fixed:
                self.q[v] = np.clip(angle, limits.lower[v], limits.upper[v])

    def _chains(self) -> list[frozenset[int]]:
        """Coordinates of each problem's chain; it starts where an earlier placement's ends."""
        placed: frozenset[int] = frozenset()
        chains = []
        for problem in self.problems:
            own = problem.steps[Reach.OWN] - self.fixed - frozenset(self.presets)
            chains.append(own - placed or own)
            if any(isinstance(self.constraints[i], Place) for i in problem.tasks):
                placed |= own
        return chains

    def iterate(self, problem: Problem, chain: frozenset[int]) -> int:
        """Solve one problem and return how many rounds that took (listing 1)."""
        for iteration in range(1, MAX_ITERATIONS):
            self._round(problem, chain)
            if all(self._offset(i) < 1.0 for i in problem.tasks):
                return iteration
        self._round(problem, chain)
        return MAX_ITERATIONS

    def _round(self, problem: Problem, chain: frozenset[int]) -> None:
        for i in problem.tasks:
            self._apply(i, chain)

    def _apply(self, i: int, chain: frozenset[int]) -> None:
        """Let one constraint have its way (`apply_to`)."""
        if chain:
            self.body.reference = self.q
            alone = {i: self.tasks[i]}
            found = solve_group(
                self.body, alone, self.q, chain, first=[self.q], only_first=True, further=False
            )
            self.q = np.array(found.q)

    def _offset(self, i: int) -> float:
        """How far a constraint is from its goal, in thresholds (`offset_to_goal`); NaN: nowhere."""
        residual, _ = self._residual(i)
        return residual / PAPER.of(self.constraints[i])

    def _residual(self, i: int) -> tuple[float, str]:
        task = self.tasks[i]
        frames = self.body.frames(self.q)
        residual, unit = self.body.evaluator.residual(
            task.constraint, frames, self.q, task.phase, self.constraints
        )
        return float(residual), unit

    def problem_report(
        self, problem: Problem, chain: frozenset[int], iterations: int, spent_s: float
    ) -> ProblemReport:
        """Report what came of one problem."""
        parts = {self.body.anatomy.parts[v] for v in chain}
        moved = tuple(part.value for part in Part if part in parts)
        return ProblemReport(
            problem.tasks,
            tuple(self.constraints[i] for i in problem.tasks),
            problem.chain,
            None,
            moved,
            iterations=iterations,
            solve_s=spent_s,
        )

    def report(self, problems: Sequence[ProblemReport], began: float) -> SolveReport:
        """Measure everything on the final posture."""
        self.q.setflags(write=False)
        return SolveReport(
            self.q,
            tuple(problems),
            tuple(self._constraint_reports()),
            self.body.obstacles.overlaps(self.q),
            self.body.evaluations,
            time.perf_counter() - began,
            frozenset(self.presets).union(*self.chains) - self.fixed,
        )

    def _constraint_reports(self) -> list[ConstraintReport]:
        binding = self.body.evaluator.binding
        reports = []
        for i, task in enumerate(self.tasks):
            match task.constraint:
                case Transpath() | Trill():
                    continue
                case Morph() as morph:
                    if not binding.is_skeletal(morph):
                        continue
                case Place() | Orient() | Look() | LookAt() | Rotate():
                    pass
            residual, unit = self._residual(i)
            tolerance = SolveOptions().tolerance.of(task.constraint)
            met = residual <= tolerance
            reason = CONTENT if residual < PAPER.of(task.constraint) else GIVEN_UP
            reports.append(
                ConstraintReport(
                    task,
                    residual,
                    "m" if unit == "m" else "rad",
                    tolerance,
                    met,
                    None if met else reason,
                )
            )
        return reports
