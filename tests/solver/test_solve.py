"""Solving whole moments on the body of sticks: what is met, what is not and why."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stick_solver import FOREARM, FORWARD, IDLE, MSSP, PALM, RIG, run, value
from tree_sign import DIR, NRM, UP, S, W, along, tasks, tree

from azee_solver.binding import BindingError
from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Origin,
    Place,
    Relation,
    Rotate,
)
from azee_solver.geometry import (
    Between,
    Bone,
    Cross,
    Dir,
    FreePoint,
    Nrm,
    Opp,
    Rotated,
    Side,
    Site,
    SitePoint,
    Towards,
    Vec,
    VTranslate,
    WorldPoint,
)
from azee_solver.handshape import straight
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport


def moved(report: SolveReport) -> set[str]:
    return {
        RIG.coordinates.names[v].split(".")[0] for v in np.flatnonzero(report.coordinates != IDLE)
    }


MET: dict[str, list[Constraint]] = {
    "fingertip in front": [Place(Site("I_TIP", S), MSSP)],
    "palm at the chin, by a vector": [
        Place(Site("PA", S), VTranslate(SitePoint(Site("CH")), Vec(0.0, -0.1, 0.2)))
    ],
    "hand and its axes": [
        Place(Site("H_BACK", W), FreePoint(0.1, -0.25, 0.3)),
        along(NRM, Bone("palm", W), UP),
    ],
    "between two hands": [
        Place(Site("PA", W), FreePoint(0.05, -0.25, 0.3)),
        Place(Site("I_TIP", S), Between(SitePoint(Site("PA", W)), SitePoint(Site("CH")), 0.5)),
    ],
    "at a distance along the normal": [
        Place(Site("PA", W), FreePoint(0.05, -0.2, 0.35)),
        Place(Site("PA", S), SitePoint(Site("PA", W)), 0.1),
        along(NRM, PALM, Opp(Nrm(Bone("palm", W)))),
    ],
    "anywhere at a distance": [Place(Site("PA", S), FreePoint(0.0, -0.2, 0.4), 0.1)],
    "towards a site": [
        along(DIR, PALM, Towards(SitePoint(Site("PA", S)), SitePoint(Site("CH")))),
        Place(Site("PA", S), FreePoint(-0.1, -0.2, 0.3)),
    ],
    "a turned and crossed target": [
        along(NRM, PALM, Rotated(Cross(Dir(FOREARM), UP), Dir(FOREARM), 0.4)),
        Orient(DIR, FOREARM, Relation.ACROSS, UP),
    ],
    "a rotation that reads the posture": [
        Rotate(Bone("head"), Towards(SitePoint(Site("CH")), SitePoint(Site("PA", S))), 0.2)
    ],
    "gaze at the own hand": [
        LookAt(SitePoint(Site("I_TIP", S))),
        Place(Site("I_TIP", S), FreePoint(-0.25, -0.1, 0.35)),
    ],
    "fingers by morphs under a placement": [
        Morph("index_bend", S, 0.3),
        Place(Site("I_TIP", S), SitePoint(Site("CH"))),
    ],
}


@pytest.mark.parametrize("case", MET)
def test_met(case: str) -> None:
    report = run(*MET[case])
    assert report.met, [(c.kind, c.residual, c.reason) for c in report.constraints]
    assert len(report.constraints) == len(MET[case])
    assert all(c.residual <= c.tolerance and c.reason is None for c in report.constraints)
    assert np.all(report.coordinates >= RIG.coordinates.lower)
    assert np.all(report.coordinates <= RIG.coordinates.upper)
    assert not report.coordinates.flags.writeable


def test_tree_is_met_with_the_elbow_on_the_palm() -> None:
    report = run(*(d.constraint for d in tree(FreePoint(-0.05, -0.3, 0.25))))
    assert report.met, [(c.kind, c.reason) for c in report.constraints if not c.met]
    assert len(report.problems) == 11
    first, second, third = report.problems[:3]
    assert first.merged_into is None
    assert second.merged_into in (None, first.name)
    assert third.merged_into == (second.merged_into or second.name)


def test_nothing_asked_nothing_done() -> None:
    report = solve(RIG, [], dominant=Side.RIGHT, start=IDLE, reference=IDLE)
    np.testing.assert_array_equal(report.coordinates, IDLE)
    assert report.evaluations == 0
    assert report.reached == frozenset()
    assert report.met


def test_what_no_constraint_moves_has_the_reference_s_value() -> None:
    reference = np.array(IDLE)
    reference[RIG.coordinates.index["f_arm_L.flexion"]] += 0.3
    report = solve(
        RIG,
        tasks(Place(Site("PA", S), FreePoint(-0.1, -0.2, 0.3))),
        dominant=Side.RIGHT,
        start=IDLE,
        reference=reference,
    )
    untouched = [v for v in range(len(IDLE)) if v not in report.reached]
    np.testing.assert_array_equal(report.coordinates[untouched], reference[untouched])
    assert RIG.coordinates.index["arm_R.flexion"] in report.reached


def test_facial_morphs_are_passed_over() -> None:
    report = run(Morph("smile", None, 1.0))
    assert report.constraints == ()
    np.testing.assert_array_equal(report.coordinates, IDLE)


def test_morphs_set_coordinates_and_add() -> None:
    report = run(Morph("index_bend", S, 0.25), Morph("index_bend", S, 0.5))
    assert value(report, "index_R_1.flexion") == pytest.approx(
        67.5 + math.degrees(straight("index_R_1.flexion"))
    )
    assert report.met


def test_a_binding_error_has_its_origin() -> None:
    here = Origin("x.azee", 1, 2)
    with pytest.raises(BindingError) as caught:
        run(Place(Site("NOSE"), MSSP, origin=here))
    assert caught.value.origin == here


# As little of the body as will do -------------------------------------------------------------


def test_a_place_within_reach_leaves_trunk_and_fingers_alone() -> None:
    report = run(Place(Site("I_TIP", S), FreePoint(-0.15, -0.2, 0.3)))
    assert moved(report) <= {"clav_R", "arm_R", "f_arm_R", "palm_R"}


def test_a_far_place_takes_the_trunk_and_keeps_the_head_level() -> None:
    report = run(Place(Site("I_TIP", S), FreePoint(-0.15, -0.1, 0.74)))
    assert report.met
    assert value(report, "back_1.flexion") > 1
    level = RIG.chain.frames(report.coordinates).rotations[RIG.bones["head"].node]
    assert math.degrees(math.acos(level[1, 1])) < 2
    assert moved(report) & {"head", "neck"}


def test_eyes_turn_first_then_the_head() -> None:
    near = run(Look(Vec(0.2, 0.0, 1.0)))
    assert near.met
    assert abs(value(near, "head.axial")) < 1
    far = run(Look(Vec(1.0, 0.0, 0.7)))
    assert far.met
    assert value(far, "eye_L.yaw") < 0.85 * 35
    assert value(far, "head.axial") > 2 * value(far, "neck.axial") > 0


def test_gaze_changes_little_for_little() -> None:
    angles = np.radians(np.arange(20, 45))
    heads = [value(run(Look(Vec(math.sin(a), 0.0, math.cos(a)))), "head.axial") for a in angles]
    assert np.abs(np.diff(heads)).max() < 2


def test_fixed_coordinates_keep_their_value() -> None:
    fixed = frozenset(
        v for v, name in enumerate(RIG.coordinates.names) if name.startswith(("f_arm_R", "back"))
    )
    report = run(Place(Site("PA", S), FreePoint(-0.1, -0.2, 0.25)), fixed=fixed)
    np.testing.assert_array_equal(report.coordinates[sorted(fixed)], IDLE[sorted(fixed)])


def test_the_last_joint_of_a_finger_follows_the_one_before() -> None:
    """Two thirds of its angle (Rijpkema and Girard 1991), where nothing else fixes the finger."""
    for degrees in (0.0, 30.0, 60.0):
        turn = Rotated(
            Dir(Bone("index", S, 1)), Cross(Nrm(PALM), Dir(PALM)), math.radians(-degrees)
        )
        report = run(along(DIR, Bone("index", S, 2), turn))
        bent = value(report, "index_R_2.flexion")
        assert report.met
        assert value(report, "index_R_3.flexion") == pytest.approx(2 / 3 * bent, abs=0.2)
    held = run(Morph("index_hook", S, 0.5), along(DIR, Bone("index", S, 3), Dir(PALM)))
    assert value(held, "index_R_3.flexion") != pytest.approx(30, abs=5)


# Laws -----------------------------------------------------------------------------------------

ARM = [v for v, name in enumerate(RIG.coordinates.names) if "_R" in name and "eye" not in name]


@settings(max_examples=25)
@given(st.integers(0, 10**6))
def test_what_a_posture_reaches_is_reached_again(seed: int) -> None:
    """Targets made from a posture inside the limits, without the body in the way."""
    random = np.random.default_rng(seed)
    q = np.array(IDLE)
    span = RIG.coordinates.upper - RIG.coordinates.lower
    q[ARM] = (RIG.coordinates.lower + random.uniform(0.1, 0.9, len(q)) * span)[ARM]
    frames = RIG.chain.frames(q)
    site, palm = RIG.sites["PA_R"], RIG.bones["palm_R"].node
    at = site.point(frames)
    direction = frames.rotations[palm][:, 1]
    report = run(
        Place(Site("PA", S), WorldPoint(*at)),
        along(DIR, PALM, Vec(*direction)),
        overlap=0.0,
        overlap_m=1.0,
    )
    assert report.met, [(c.residual, c.reason) for c in report.constraints]


def test_the_same_question_gets_the_same_bytes() -> None:
    asked = [d.constraint for d in tree(FreePoint(-0.05, -0.3, 0.25))]
    one, other = run(*asked), run(*asked)
    assert one.coordinates.tobytes() == other.coordinates.tobytes()
    assert (one.evaluations, one.problems, one.constraints) == (
        other.evaluations,
        other.problems,
        other.constraints,
    )


def mirrored(dominant: Side) -> SolveReport:
    x = 0.15 if dominant is Side.LEFT else -0.15
    asked = tasks(Place(Site("PA", S), FreePoint(x, -0.2, 0.3)), along(NRM, PALM, FORWARD))
    return solve(RIG, asked, dominant=dominant, start=IDLE, reference=IDLE)


def test_a_left_handed_signer_is_the_mirror_image() -> None:
    right, left = mirrored(Side.RIGHT), mirrored(Side.LEFT)
    assert right.met
    assert left.met
    for bone, axis in (("arm", "flexion"), ("arm", "abduction"), ("f_arm", "pronation")):
        assert value(left, f"{bone}_L.{axis}") == pytest.approx(
            value(right, f"{bone}_R.{axis}"), abs=0.05
        )
