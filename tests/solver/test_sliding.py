"""Paths laid on the skin of a part of the body."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from azee_rig.load import load_rig, shipped_rigs
from azee_rig.rig import Rig
from azee_solver.constraint import Place
from azee_solver.evaluate import Evaluator, evaluator
from azee_solver.footprint import footprint
from azee_solver.geometry import (
    Between,
    Bone,
    Circle,
    Moving,
    Side,
    Site,
    SitePoint,
    Slide,
    Straight,
    Vec,
)
from azee_solver.winding import distances

W = Side.WEAK
FOREARM = Slide(Bone("f_arm", W), Straight())
ELBOW, WRIST = Site("EL", W), Site("WR", W)
T = np.linspace(0.0, 1.0, 41)


def skin_distance(rig: Rig, q: np.ndarray, points: np.ndarray) -> np.ndarray:
    vertices = rig.skin(rig.pose(q))
    return distances(points, vertices[rig.mesh.triangles])


def bent(rig: Rig) -> np.ndarray:
    q = np.array(rig.coordinates.idle)
    q[rig.coordinates.index["f_arm_L.flexion"]] = 1.5
    q[rig.coordinates.index["f_arm_L.pronation"]] = -0.6
    return q


@pytest.mark.parametrize("body", shipped_rigs())
def test_a_sliding_path_keeps_to_the_skin(body: str) -> None:
    rig = load_rig(body)
    measure, q = Evaluator(rig, Side.RIGHT), bent(rig)
    frames = rig.chain.frames(q)
    start, end = (measure.site(site, frames) for site in (ELBOW, WRIST))
    curve = measure.path(FOREARM, start, end, T, frames)
    np.testing.assert_allclose(curve[[0, -1]], [start, end], atol=1e-9)
    straight = measure.path(Straight(), start, end, T)
    assert skin_distance(rig, q, curve).max() < 0.008
    assert skin_distance(rig, q, straight).max() > skin_distance(rig, q, curve).max()
    assert np.linalg.norm(np.diff(curve, axis=0), axis=1).max() < 0.05


def test_a_circle_is_rubbed_on_a_chest_that_turns(signer: Rig) -> None:
    measure = evaluator(signer, Side.RIGHT)
    q = np.array(signer.coordinates.idle)
    q[signer.coordinates.index["back_1.axial"]] = 0.3
    frames = signer.chain.frames(q)
    here = measure.site(Site("ST", Side.LEFT), frames)
    path = Slide(Bone("back_2"), Circle(Vec(0, 0, 1), 0.04, 1.0))
    curve = measure.path(path, here, here, T, frames)
    assert skin_distance(signer, q, curve).max() < 0.004
    assert np.ptp(curve, axis=0)[:2].min() > 0.05


@given(st.floats(0.0, 1.0), st.integers(0, 5))
def test_many_postures_at_once_are_those_one_by_one(share: float, seed: int) -> None:
    rig = load_rig()
    measure = evaluator(rig, Side.RIGHT)
    drawn = np.random.default_rng(seed).uniform(size=(3, len(rig.coordinates)))
    q = rig.coordinates.lower + drawn * (rig.coordinates.upper - rig.coordinates.lower)
    point = Moving(FOREARM, SitePoint(ELBOW), SitePoint(WRIST))
    together = measure.point(point, rig.chain.frames(q), share)
    alone = [measure.point(point, rig.chain.frames(one), share) for one in q]
    np.testing.assert_allclose(together, alone, atol=1e-9)


def test_it_reads_the_part_that_it_lies_on(signer: Rig) -> None:
    measure = evaluator(signer, Side.RIGHT)
    place = Place(Site("I_TIP", Side.STRONG), Moving(FOREARM, SitePoint(ELBOW), SitePoint(WRIST)))
    found = footprint(place, measure.binding)
    assert signer.bones["f_arm_L"].node in found.target


@pytest.mark.parametrize(
    ("one", "other"), [("ST", "ST_R"), ("CK_L", "MO"), ("ABST", "ST"), ("LOBE_L", "ST_L")]
)
def test_a_contact_between_two_sites_is_on_the_skin(signer: Rig, one: str, other: str) -> None:
    measure, q = evaluator(signer, Side.RIGHT), np.array(signer.coordinates.idle)
    frames = signer.chain.frames(q)
    start, end = (SitePoint(_named(name)) for name in (one, other))
    on = measure.point(Between(start, end, 0.5, on_skin=True), frames)
    assert skin_distance(signer, q, on[None]).max() < 0.003
    plain = measure.point(Between(start, end, 0.5), frames)
    nearest = skin_distance(signer, q, plain[None]).max()
    assert np.linalg.norm(on - plain) == pytest.approx(nearest, abs=0.004)


def test_between_sites_of_a_hand_no_skin_is_meant(signer: Rig) -> None:
    measure = evaluator(signer, Side.RIGHT)
    frames = signer.chain.frames(np.array(signer.coordinates.idle))
    start, end = (SitePoint(Site(name, W)) for name in ("M_TIP", "R_TIP"))
    on, plain = (
        measure.point(Between(start, end, 0.5, on_skin=skin), frames) for skin in (True, False)
    )
    np.testing.assert_array_equal(on, plain)


def _named(name: str) -> Site:
    base, _, side = name.partition("_")
    return Site(base, {"L": Side.LEFT, "R": Side.RIGHT}[side] if side else None)
