"""What came of a moment: everything measured again, outside the kernels, and why some is missed."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from azee_solver import kinematics
from azee_solver.anatomy import Part
from azee_solver.body import Body
from azee_solver.constraint import Morph, Transpath, Trill
from azee_solver.moment import Moment
from azee_solver.notation import constraint_text
from azee_solver.outcome import Price, Reason, Strain
from azee_solver.reasons import Diagnosis
from azee_solver.solution import Solution
from azee_solver.solve_report import ConstraintReport, ProblemReport, SolveReport
from azee_solver.task import Task
from azee_solver.tolerance import PAPER

Array = NDArray[np.float64]


def report(
    moment: Moment, solution: Solution, spent_s: Mapping[tuple[int, ...], float], began: float
) -> SolveReport:
    """Return the report of a solved moment.

    Args: spent_s: time that groups have taken, by their problems. began: when solving began, by
        `time.perf_counter`.
    """
    body, limits = moment.body, moment.body.rig.coordinates
    q = np.clip(solution.q, limits.lower, limits.upper)
    undefined = frozenset().union(*(r.undefined for r in solution.results))
    free = frozenset().union(*(group.free for group in solution.groups))
    diagnosis = Diagnosis(body, moment.tasks, moment.footprints, q, free)
    prices = {i: price for result in solution.results for i, price in result.eased.items()}
    constraints = tuple(_constraints(body, moment.tasks, q, diagnosis, undefined, prices))
    q.setflags(write=False)
    return SolveReport(
        q,
        _problems(moment, solution, spent_s),
        constraints,
        body.obstacles.overlaps(q),
        body.evaluations,
        time.perf_counter() - began,
        free | frozenset(body.presets) - body.options.fixed,
        strains=tuple(_strains(moment, solution)),
    )


def _constraints(
    body: Body,
    tasks: Sequence[Task],
    q: Array,
    diagnosis: Diagnosis,
    undefined: frozenset[int],
    prices: Mapping[int, Price],
) -> Iterator[ConstraintReport]:
    """Yield what became of each constraint that joints can meet.

    Args: prices: what it would have cost to meet tasks that comfort has not met.
    """
    measure, asked = body.evaluator, [task.constraint for task in tasks]
    frames = kinematics.frames(body.rig.chain, q)
    for i, task in enumerate(tasks):
        constraint = task.constraint
        if isinstance(constraint, Transpath | Trill) or (
            isinstance(constraint, Morph) and not measure.binding.is_skeletal(constraint)
        ):
            continue
        residual, unit = measure.residual(constraint, frames, q, task.phase, asked)
        tolerance = body.options.tolerance.of(constraint)
        met, price = bool(residual <= tolerance), prices.get(i)
        why: str | Reason | None = None
        if price and residual > PAPER.of(constraint):
            why = f"given up for comfort: it would take {price}"
        elif not met and not price:
            miss = float(residual) / tolerance
            why = Reason(partial(diagnosis.reason, i, miss, i in undefined))
        yield ConstraintReport(task, float(residual), unit, tolerance, met, why, price)


def _strains(moment: Moment, solution: Solution) -> Iterator[Strain]:
    """Yield what is beyond the comfortable, and for whose sake."""
    for result in solution.results:
        if result.strain:
            subjects = (constraint_text(moment.constraints[i]) for i in sorted(result.strained_for))
            yield Strain(result.strain, tuple(subjects))


def _problems(
    moment: Moment,
    solution: Solution,
    spent_s: Mapping[tuple[int, ...], float],
) -> tuple[ProblemReport, ...]:
    """Return what became of each problem, in the order of their dependencies."""
    out: dict[int, ProblemReport] = {}
    body, problems = moment.body, moment.problems
    for group in solution.groups:
        first = group.problems[0]
        parts = {body.anatomy.parts[v] for v in group.free}
        for p in group.problems:
            problem = problems[p]
            out[p] = ProblemReport(
                problem.tasks,
                tuple(moment.constraints[i] for i in problem.tasks),
                problem.chain,
                out[first] if p != first else None,
                tuple(part.value for part in Part if part in parts),
                solve_s=spent_s[group.problems] if p == first else 0.0,
            )
    return tuple(out[p] for p in sorted(out))
