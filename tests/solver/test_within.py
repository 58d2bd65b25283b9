"""A constraint with a bound is met anywhere inside it, and drawn to the middle."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from test_comfort import lean_deg, run
from tree_sign import DIR, NRM, UP, S, along

from azee_rig.rig import Rig
from azee_solver.constraint import Orient, Place, Relation
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Bone, FreePoint, Side, Site, Vec
from azee_solver.outcome import Outcome
from azee_solver.solve_report import SolveReport
from azee_solver.tolerance import Tolerance

PALM, TIP = Bone("palm", S), Site("I_TIP", S)
FORWARD = Place(TIP, FreePoint(-0.1, -0.05, 0.35))
EXACT = along(DIR, PALM, Vec(0.0, 0.0, 1.0))
STEEP = along(NRM, PALM, UP)
TOLERANCE = Tolerance()


def off_deg(rig: Rig, report: SolveReport, constraint: Orient) -> float:
    """Angle from the middle of the bound."""
    exact = replace(constraint, within_rad=0.0)
    q = report.coordinates
    residual, _ = evaluator(rig, Side.RIGHT).residual(exact, rig.chain.frames(q), q)
    return math.degrees(float(residual))


@pytest.mark.parametrize("relation", list(Relation))
@pytest.mark.parametrize("bound_deg", [10.0, 25.0, 60.0])
def test_an_orientation_is_met_inside_its_bound(
    signer: Rig, relation: Relation, bound_deg: float
) -> None:
    vector = Vec(1.0, 0.0, 0.0) if relation is Relation.ALONG else Vec(0.0, 0.6, 0.8)
    bounded = Orient(NRM, PALM, relation, vector, math.radians(bound_deg))
    report = run(signer, FORWARD, EXACT, bounded)
    assert all(c.residual <= c.tolerance for c in report.constraints)
    assert off_deg(signer, report, bounded) <= bound_deg + math.degrees(TOLERANCE.angle_rad)


@pytest.mark.parametrize("bound_deg", [25.0, 40.0, 90.0])
def test_it_is_drawn_to_the_middle(signer: Rig, bound_deg: float) -> None:
    wide = replace(STEEP, within_rad=math.radians(bound_deg))
    report = run(signer, FORWARD, wide)
    assert report.constraints[1].residual == 0.0
    assert off_deg(signer, report, wide) < 0.9 * bound_deg


def test_what_is_asked_exactly_costs_more_than_what_is_bounded(signer: Rig) -> None:
    """A flat hand before the breastbone, fingers forward: exact, neither of its axes is met."""
    place, sideways = Place(Site("PA", S), FreePoint(0, 0, 0.2)), along(NRM, PALM, Vec(1, 0, 0))
    bounded = (replace(c, within_rad=math.radians(25)) for c in (EXACT, sideways))
    strict, free = run(signer, place, EXACT, sideways), run(signer, place, *bounded)
    assert [c.outcome for c in strict.constraints[1:]] == [Outcome.MISSED, Outcome.MISSED]
    assert [c.outcome for c in free.constraints] == [Outcome.MET] * 3
    assert lean_deg(signer, free) < 0.1 < lean_deg(signer, strict)


def test_a_place_is_met_inside_its_bound(signer: Rig) -> None:
    away = FreePoint(-0.15, -0.1, 0.74)
    report = run(signer, Place(TIP, away, within_m=0.06))
    frames = signer.chain.frames(report.coordinates)
    measure = evaluator(signer, Side.RIGHT)
    gap = np.linalg.norm(measure.site(TIP, frames) - measure.point(away, frames))
    assert 0.0 < gap <= 0.06 * measure.scale + TOLERANCE.length_m
    assert report.constraints[0].residual == pytest.approx(max(gap - 0.06 * measure.scale, 0.0))
    assert lean_deg(signer, report) < 0.1 < lean_deg(signer, run(signer, Place(TIP, away)))


def test_a_bound_is_a_length_of_the_reference_signer(signer: Rig) -> None:
    measure = evaluator(signer, Side.RIGHT)
    q = signer.coordinates.idle
    frames = signer.chain.frames(q)
    exact, _ = measure.residual(FORWARD, frames, q)
    bounded, _ = measure.residual(replace(FORWARD, within_m=0.1), frames, q)
    assert float(exact - bounded) == pytest.approx(0.1 * measure.scale)
