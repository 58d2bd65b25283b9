"""Every kind of vector, point, path and constraint means the same to all that read it.

mypy finds a match that leaves a member out; these tests find one that takes it for another.
"""

from __future__ import annotations

from typing import get_args

import numpy as np
import pytest
from every_member import (
    CONSTRAINTS,
    MOVING_POINTS,
    PALM,
    PATHS,
    POINTS,
    RIGHT_SPACE,
    TIP,
    VECTORS,
    title,
)
from kernel_case import Case
from stick_body import stick_body
from tree_sign import tasks

from azee_solver.anatomy import Part, anatomy
from azee_solver.binding import Binding
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Morph,
    Orient,
    Place,
    Relation,
    Transpath,
    Trill,
)
from azee_solver.evaluate import Evaluator
from azee_solver.footprint import footprint, part_constrained
from azee_solver.geometry import FreePoint, Moving, Path, Point, Side, Slide, Vector
from azee_solver.residuals import lower
from azee_solver.solve import solve
from azee_solver.task import Task
from azee_solver.tolerance import Tolerance

RIG = stick_body()
BODY = anatomy(RIG.chain, RIG.coordinates)
BINDING = Binding(RIG, Side.RIGHT)
MEASURE = Evaluator(RIG, Side.RIGHT)
MOVEMENTS = Transpath | Trill
"""What takes time: no posture meets one."""

PATHS_OF_STICKS = [path for path in PATHS if not isinstance(path, Slide)]
"""Sticks have no skin to slide on; test_sliding.py has bodies."""

TARGETS: list[Constraint] = [
    *(c for c in CONSTRAINTS if not isinstance(c, MOVEMENTS | Morph)),
    *(Orient(BoneAxis.DIR, PALM, Relation.ACROSS, vector) for vector in VECTORS),
    *(Place(TIP, point) for point in (*POINTS, *MOVING_POINTS)),
    *(
        Place(TIP, Moving(path, FreePoint(0.25, -0.25, 0.375), RIGHT_SPACE))
        for path in PATHS_OF_STICKS
    ),
]
"""Constraints that the kernels optimise, with every vector, point and path as a target."""


@pytest.mark.parametrize(
    ("union", "examples"),
    [(Vector, VECTORS), (Point, POINTS), (Path, PATHS), (Constraint, CONSTRAINTS)],
    ids=["vectors", "points", "paths", "constraints"],
)
def test_every_member_has_an_example(union: object, examples: tuple[object, ...]) -> None:
    assert {type(example) for example in examples} == {*get_args(union)}


@pytest.mark.parametrize("constraint", TARGETS, ids=title)
@pytest.mark.parametrize("seed", [1, 2])
def test_the_kernels_see_what_is_measured(constraint: Constraint, seed: int) -> None:
    case = Case(seed)
    frames = case.rig.chain.frames(case.q)
    measured, _ = case.evaluator.residual(constraint, frames, case.q, 0.3)
    asked, tolerance = {0: Task(constraint, phase=0.3)}, Tolerance(1.0, 1.0)
    residuals = lower(case.tape, asked, tolerance, {})
    program = case.program(list(residuals.rows))
    program(case.q, np.empty(0))
    seen = residuals.ratios(program.lengths(), asked, tolerance)[0]
    assert seen == pytest.approx(float(measured), rel=1e-9)


@pytest.mark.parametrize("constraint", TARGETS, ids=title)
def test_a_footprint_holds_all_that_changes_the_residual(constraint: Constraint) -> None:
    changing: set[int] = set()
    for seed in range(3):
        q = Case(seed).q
        moved = np.vstack([q, q + 1e-4 * np.eye(len(q))])
        residuals, _ = MEASURE.residual(constraint, RIG.chain.frames(moved), moved, 0.3)
        changing |= {int(v) for v in np.flatnonzero(np.abs(residuals[1:] - residuals[0]) > 1e-9)}
    assert changing
    assert changing <= footprint(constraint, BINDING).affected(BODY)


@pytest.mark.parametrize("constraint", TARGETS, ids=title)
def test_a_posture_is_found(constraint: Constraint) -> None:
    idle = RIG.coordinates.idle
    report = solve(RIG, tasks(constraint), dominant=Side.RIGHT, start=idle, reference=idle)
    (found,) = report.constraints
    assert found.met, found.reason


@pytest.mark.parametrize("constraint", CONSTRAINTS, ids=title)
def test_a_constraint_is_measured_or_a_movement(constraint: Constraint) -> None:
    frames = RIG.chain.frames(RIG.coordinates.idle)
    BINDING.check(constraint)
    if isinstance(constraint, MOVEMENTS):
        with pytest.raises(ValueError, match="no posture meets"):
            MEASURE.residual(constraint, frames, RIG.coordinates.idle)
        assert part_constrained(constraint, BINDING) is None
    else:
        assert np.isfinite(MEASURE.residual(constraint, frames, RIG.coordinates.idle)[0])
        assert isinstance(part_constrained(constraint, BINDING), Part | None)


@pytest.mark.parametrize("path", PATHS_OF_STICKS, ids=title)
def test_a_path_leads_from_its_start_to_its_end(path: Path) -> None:
    frames = RIG.chain.frames(RIG.coordinates.idle)
    ends = np.array([0.1, 1.2, 0.4]), np.array([-0.1, 1.3, 0.3])
    way = MEASURE.path(path, *ends, np.linspace(0, 1, 5), frames)
    np.testing.assert_allclose(way[[0, -1]], ends, atol=1e-9)
