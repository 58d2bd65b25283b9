"""Soft morphs: fingers that curl until they touch, instead of by exact angles."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from test_comfort import run
from tree_sign import S, W

from azee_rig.rig import Rig
from azee_solver.binding import Binding
from azee_solver.constraint import Constraint, Morph, Place
from azee_solver.geometry import Side, Site, SitePoint
from azee_solver.solve_report import SolveReport

SOFT_RAD = math.radians(40.0)


def pinch(finger: str) -> Place:
    """Return the contact of the tips of thumb and finger."""
    return Place(Site("T_TIP", S), SitePoint(Site(f"{finger[0].upper()}_TIP", S)), contact=True)


def curled(finger: str, bend: float, hook: float, within_rad: float) -> tuple[Constraint, ...]:
    return (
        Morph(f"{finger}_bend", S, bend, within_rad),
        Morph(f"{finger}_hook", S, hook, within_rad),
    )


def degrees(rig: Rig, report: SolveReport, name: str) -> float:
    return math.degrees(report.coordinates[rig.coordinates.index[name]])


@pytest.mark.parametrize(
    ("finger", "bend", "hook"), [("index", 0.8, 0.1), ("middle", 0.5, 0.1), ("ring", 0.6, 0.1)]
)
def test_a_soft_curl_yields_to_a_contact_that_an_exact_one_misses(
    signer: Rig, finger: str, bend: float, hook: float
) -> None:
    exact = run(signer, pinch(finger), *curled(finger, bend, hook, 0.0))
    soft = run(signer, pinch(finger), *curled(finger, bend, hook, SOFT_RAD))
    assert not all(c.met for c in exact.constraints)
    assert all(c.met for c in soft.constraints)
    moved = degrees(signer, soft, f"{finger}_R_2.flexion") - degrees(
        signer, run(signer, *curled(finger, bend, hook, 0.0)), f"{finger}_R_2.flexion"
    )
    assert abs(moved) < math.degrees(SOFT_RAD)


def test_a_soft_curl_that_nothing_stops_is_the_exact_one(signer: Rig) -> None:
    exact, soft = (run(signer, *curled("index", 0.7, 0.6, bound)) for bound in (0.0, SOFT_RAD))
    np.testing.assert_allclose(soft.coordinates, exact.coordinates, atol=math.radians(0.5))


def test_it_misses_only_what_is_beyond_its_bound(signer: Rig) -> None:
    """The thumb does not reach the tip of a straight finger."""
    few, many = (
        run(signer, pinch("ring"), *curled("ring", 0.0, 0.0, math.radians(bound)))
        for bound in (15, 90)
    )
    assert [c.met for c in few.constraints] == [False, True, True]
    assert all(c.met for c in many.constraints)
    straight = run(signer, *curled("ring", 0.0, 0.0, 0.0))
    yielded = degrees(signer, few, "ring_R_2.flexion") - degrees(
        signer, straight, "ring_R_2.flexion"
    )
    assert 10 < yielded <= 15 + 0.1


def test_coordinates_yield_only_where_all_morphs_are_soft(signer: Rig) -> None:
    binding = Binding(signer, Side.RIGHT)
    soft = Morph("index_bend", S, 0.5, SOFT_RAD)
    wider = replace(soft, within_rad=1.0)
    v = signer.coordinates.index["index_R_1.flexion"]
    assert binding.yielding([soft]) == {v: SOFT_RAD}
    assert binding.yielding([soft, wider]) == {v: 1.0}
    assert binding.yielding([soft, Morph("index_bend", S, 0.2)]) == {}
    assert binding.yielding([soft, Morph("index_bend", W, 0.2)]) == {v: SOFT_RAD}
