"""The published two-level iterations: the loop of listing 1, its chains, and how it ends."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from stick_body import stick_body
from tree_sign import DIR, NRM, UP, S, along, tasks, tree

from azee_rig.rig import Rig
from azee_solver import group_search, two_level
from azee_solver.constraint import Constraint, Morph, Orient, Place, Relation
from azee_solver.geometry import Bone, Dir, FreePoint, Side, Site, Vec
from azee_solver.handshape import straight
from azee_solver.solve_report import SolveReport
from azee_solver.tolerance import PAPER
from azee_solver.two_level import MAX_ITERATIONS, solve_two_level

TIP, NEAR = Site("I_TIP", S), FreePoint(-0.2, -0.2, 0.35)
PALM = Bone("palm", S)


def run(rig: Rig, *constraints: Constraint, fixed: frozenset[int] = frozenset()) -> SolveReport:
    idle = rig.coordinates.idle
    return solve_two_level(
        rig, tasks(*constraints), dominant=Side.RIGHT, start=idle, reference=idle, fixed=fixed
    )


def iterations(report: SolveReport) -> list[int | None]:
    return [problem.iterations for problem in report.problems]


def offsets(report: SolveReport) -> list[float]:
    """In the paper's thresholds."""
    return [c.residual / PAPER.of(c.task.constraint) for c in report.constraints]


def test_the_constants_are_the_paper_s() -> None:
    assert MAX_ITERATIONS == 35
    assert PAPER.length_m == 0.01
    assert math.degrees(PAPER.angle_rad) == pytest.approx(5)


def test_a_constraint_alone_takes_one_iteration() -> None:
    for constraint in (Place(TIP, NEAR), along(NRM, PALM, UP)):
        report = run(stick_body(), constraint)
        assert iterations(report) == [1]
        assert max(offsets(report)) < 1


def test_constraints_are_applied_one_by_one_the_place_first_until_all_are_met(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    applied: list[int] = []
    original = group_search.solve_group

    def noted(body: Any, asked: Any, *rest: Any, **options: Any) -> Any:
        applied.extend(asked)
        assert len(asked) == 1
        return original(body, asked, *rest, **options)

    monkeypatch.setattr(two_level, "solve_group", noted)
    level = Orient(DIR, PALM, Relation.ACROSS, UP)
    report = run(stick_body(), along(NRM, PALM, Vec(1, 0, 0)), level, Place(TIP, NEAR))
    (count,) = iterations(report)
    assert count is not None
    assert 1 < count < MAX_ITERATIONS
    assert max(offsets(report)) < 1
    assert applied == [2, 0, 1] * count


def test_what_cannot_be_met_ends_with_the_last_iteration() -> None:
    report = run(stick_body(), Place(TIP, FreePoint(0, 0, 3)))
    assert iterations(report) == [MAX_ITERATIONS]
    assert not report.met
    assert "two-level" in str(report.constraints[0].reason)


def test_a_chain_starts_where_that_of_an_earlier_placement_ends() -> None:
    rig = stick_body()
    elbow = Place(Site("EL", S), FreePoint(-0.25, -0.3, 0.1))
    alone = run(rig, elbow).coordinates
    both = run(rig, elbow, along(DIR, Bone("f_arm", S), UP)).coordinates
    upper = [v for v, n in enumerate(rig.coordinates.names) if n.startswith(("clav_R", "arm_R"))]
    moved = [n for n, a, b in zip(rig.coordinates.names, alone, both, strict=True) if a != b]
    np.testing.assert_array_equal(alone[upper], both[upper])
    assert set(moved) <= {"f_arm_R.flexion", "f_arm_R.pronation"}
    assert moved


def test_limits_presets_and_fixed_coordinates_hold() -> None:
    rig = stick_body()
    limits = rig.coordinates
    elbow = frozenset({limits.index["f_arm_R.flexion"]})
    report = run(
        rig, Place(TIP, FreePoint(-0.4, 0.1, 0.2)), Morph("index_bend", S, 0.5), fixed=elbow
    )
    q = report.coordinates
    assert np.all((limits.lower <= q) & (q <= limits.upper))
    assert q[limits.index["index_R_1.flexion"]] == pytest.approx(
        math.pi / 4 + straight("index_R_1.flexion")
    )
    assert all(q[v] == limits.idle[v] for v in elbow)


def test_the_tree_takes_eleven_problems_of_which_fingers_take_one_iteration(signer: Rig) -> None:
    report = run(signer, *(task.constraint for task in tree(thumb=True)))
    counts = iterations(report)
    assert len(counts) == 11
    assert counts[3:] == [1] * 8
    hardest = counts[2]
    assert hardest is not None
    assert hardest > 1


def test_the_same_bytes_twice() -> None:
    asked = (Place(TIP, NEAR), along(DIR, PALM, Dir(Bone("f_arm", S))))
    first, again = (run(stick_body(), *asked).coordinates.tobytes() for _ in range(2))
    assert first == again
