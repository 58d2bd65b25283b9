"""What reports and drawings print of geometry and constraints is AZee: it evaluates to the same."""

from __future__ import annotations

import pytest
from evaluations import constraints, problems
from every_member import CONSTRAINTS, OTHER_TIP, PALM, PATHS, POINTS, TIP, VECTORS, title

from azee.lang.constants import CONSTANTS
from azee.lang.values import Kind
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Look,
    LookAt,
    Orient,
    Relation,
    Transpath,
)
from azee_solver.geometry import Swing, Was, WorldPoint
from azee_solver.notation import constraint_text

WRITTEN: list[Constraint] = [
    *CONSTRAINTS,
    *map(Look, VECTORS),
    *(LookAt(point) for point in POINTS if not isinstance(point, WorldPoint | Was)),
    LookAt(Was("A", OTHER_TIP)),
    Orient(BoneAxis.NRM, PALM, Relation.ALONG, Swing(None, None)),
    *(Transpath(TIP, path) for path in PATHS),
]


@pytest.mark.parametrize("constraint", WRITTEN, ids=title)
def test_what_is_printed_evaluates_to_the_same(constraint: Constraint) -> None:
    assert constraints(constraint_text(constraint)) == (constraint,)


@pytest.mark.parametrize("name", [n for n, c in CONSTANTS.items() if c.value.kind is Kind.VECTOR])
def test_a_named_direction_is_printed_by_its_name(name: str) -> None:
    assert [constraint_text(c) for c in constraints(f"look ^{name}")] == [f"look ^{name}"]


def test_a_place_that_no_text_makes_is_not_taken_for_another() -> None:
    (problem,) = problems(f"key 1 ({constraint_text(LookAt(WorldPoint(0.0, 1.5, 0.25)))})")
    assert problem.code == "unknown-operator"
