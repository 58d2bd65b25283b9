"""Solving whole moments on the body of sticks: what is met, what is not and why."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stick_body import stick_body
from tree_sign import DIR, NRM, UP, S, W, along, tasks, tree

from azee_rig.rig import Rig
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
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import (
    Between,
    Bone,
    Cross,
    Dir,
    FreePoint,
    NamedPoint,
    Nrm,
    Opp,
    Rotated,
    Scale,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Towards,
    VDiff,
    Vec,
    VSum,
    VTranslate,
    WorldPoint,
)
from azee_solver.handshape import straight
from azee_solver.options import SolveOptions
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport

RIG = stick_body()
IDLE = RIG.coordinates.idle
MSSP = NamedPoint(SigningSpace.MSSP)
FORWARD = Vec(0.0, 0.0, 1.0)
PALM, FOREARM = Bone("palm", S), Bone("f_arm", S)


def run(*constraints: Constraint, rig: Rig = RIG, **choices: object) -> SolveReport:
    options = replace(SolveOptions(), **choices)  # type: ignore[arg-type]
    return solve(
        rig,
        tasks(*constraints),
        dominant=Side.RIGHT,
        start=IDLE,
        reference=IDLE,
        options=options,
    )


def value(report: SolveReport, name: str) -> float:
    return math.degrees(report.coordinates[RIG.coordinates.index[name]])


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


# What is not met ------------------------------------------------------------------------------


def reason(report: SolveReport, i: int = 0) -> str:
    found = report.constraints[i].reason
    assert found is not None
    return found


def test_out_of_reach_is_the_nearest_pose_and_says_by_how_much() -> None:
    report = run(Place(Site("I_TIP", S), WorldPoint(-0.3, 1.45, 3.0)))
    miss = report.constraints[0]
    assert not miss.met
    by, unit = reason(report).removeprefix("out of reach by ").split()
    assert unit == "mm"
    assert float(by) == pytest.approx(1000 * miss.residual, abs=0.5)
    tip = RIG.sites["I_TIP_R"]
    frames = RIG.chain.frames(report.coordinates)
    at = tip.point(frames)
    shoulder = frames.positions[RIG.bones["arm_R"].node]
    aim = np.array([-0.3, 1.45, 3.0]) - shoulder
    stretched = (at - shoulder) @ aim / np.linalg.norm(at - shoulder) / np.linalg.norm(aim)
    assert math.degrees(math.acos(min(1.0, stretched))) < 1


def test_a_direction_that_no_limit_leaves_free_is_out_of_reach_by_an_angle() -> None:
    """The head cannot stand upside down, whichever of its limits is widened."""
    report = run(along(DIR, Bone("head"), Vec(0.0, -1.0, 0.0)))
    residual = report.constraints[0].residual
    assert residual > math.radians(60)
    assert reason(report).startswith("out of reach by ")
    assert reason(report).endswith("°")
    assert float(reason(report).split()[-1][:-1]) == pytest.approx(math.degrees(residual), abs=1.0)


def test_a_limit_in_the_way_is_named() -> None:
    report = run(Rotate(Bone("head"), UP, math.radians(50)))
    assert reason(report) == (
        "the head cannot turn further: it is at 30° to the left and needs 20.0° more"
    )
    assert value(report, "head.axial") == pytest.approx(30, abs=1e-9)
    assert report.coordinates[RIG.coordinates.index["head.axial"]] == RIG.coordinates.upper[
        RIG.coordinates.index["head.axial"]
    ]  # fmt: skip


def test_near_the_end_of_all_bones_a_limit_stops_a_place_and_beyond_it_nothing_would_help() -> None:
    """Straight bones would reach as far as their lengths say; limits stop them sooner."""
    root = RIG.chain.frames(IDLE).positions[0]
    site, chain = RIG.sites["PA_R"], RIG.chain
    carriers, node = [site.node], site.node
    while chain.parents[node] > 0:
        node = int(chain.parents[node])
        carriers.append(node)
    length = np.linalg.norm(site.position) + sum(np.linalg.norm(chain.offsets[n]) for n in carriers)
    aside, up = -0.18, 0.45

    def forward(share: float) -> WorldPoint:
        """A point in front at a share of the straight body's length from its root."""
        z = math.sqrt((share * length) ** 2 - aside**2 - up**2)
        return WorldPoint(aside, float(root[1]) + up, float(root[2]) + z)

    for share in (0.905, 0.915, 0.925):
        report = run(Place(Site("PA", S), forward(share)))
        assert reason(report).startswith("the lower back cannot bend further: it is at ")
    for share in (1.005, 1.05):
        report = run(Place(Site("PA", S), forward(share)))
        miss = 1000 * report.constraints[0].residual
        assert reason(report).startswith("out of reach by ")
        assert float(reason(report).split()[-2]) == pytest.approx(miss, abs=0.5)


def test_a_morph_beyond_its_limit_is_named() -> None:
    report = run(Morph("index_hook", S, 1.2))
    assert reason(report) == (
        "the second joint of the right index finger cannot bend further: "
        "it is at 90° of flexion and needs 24.0° more"
    )
    assert value(report, "index_R_2.flexion") == pytest.approx(90)


def test_of_two_that_exclude_each_other_the_earlier_wins() -> None:
    up_first = run(along(DIR, FOREARM, UP), along(DIR, FOREARM, FORWARD))
    assert up_first.constraints[0].met
    assert reason(up_first, 1) == "conflicts with `orient 'dir !f_arm(s) 'along ^up`"
    assert up_first.constraints[1].residual == pytest.approx(math.pi / 2, abs=0.01)
    other = run(along(DIR, FOREARM, FORWARD), along(DIR, FOREARM, UP))
    assert other.constraints[0].met


def test_a_placement_wins_over_an_orientation() -> None:
    far = WorldPoint(-0.25, 1.5, 0.75)
    report = run(along(DIR, FOREARM, Vec(0.0, -1.0, 0.0)), Place(Site("I_TIP", S), far))
    assert report.constraints[1].met
    assert reason(report, 0) == "conflicts with the path of `@I_TIP(s)`"


def test_the_body_in_the_way_is_named() -> None:
    fixed = frozenset(
        v for v, name in enumerate(RIG.coordinates.names) if name.startswith(("back", "clav"))
    )
    inside = WorldPoint(0.0, 1.2, 0.0)
    report = run(Place(Site("PA", S), inside), fixed=fixed)
    assert reason(report).startswith("the body is in the way: ")
    assert "the trunk" in reason(report)
    assert "_" not in reason(report)
    assert 0.01 < report.constraints[0].residual < 0.2


def test_coordinates_that_are_held_are_said_to_be() -> None:
    held = frozenset(v for v, n in enumerate(RIG.coordinates.names) if n.startswith("head"))
    report = run(Rotate(Bone("head"), UP, 0.2), fixed=held)
    assert reason(report) == "the joints that could meet it are held still"
    stiff = frozenset(
        v for v, n in enumerate(RIG.coordinates.names) if n.startswith(("f_arm_R", "back"))
    )
    far = run(Place(Site("PA", S), FreePoint(-0.16, -0.05, 0.53)), fixed=stiff)
    assert reason(far) == ("needs the lower back, the upper back and the right forearm, held still")
    beyond = run(Place(Site("PA", S), FreePoint(-0.16, -0.05, 3.0)), fixed=stiff)
    assert reason(beyond).startswith("out of reach by "), "and would be if nothing were held"
    morph = run(
        Morph("index_bend", S, 0.5), fixed=frozenset({RIG.coordinates.index["index_R_1.flexion"]})
    )
    assert reason(morph) == "the first joint of the right index finger is held still"


def test_coordinates_that_a_morph_fixes_are_named() -> None:
    """The fingertip must come in front of its own palm, and the finger is held straight."""
    q = np.array(IDLE)
    for joint, angle in ((1, 1.0), (2, 0.9), (3, 0.6)):
        q[RIG.coordinates.index[f"index_R_{joint}.flexion"]] = angle
    frames = RIG.chain.frames(q)
    R = frames.rotations[RIG.bones["palm_R"].node]
    evaluator = Evaluator(RIG, Side.RIGHT)
    tip, palm = (evaluator.site(Site(name, S), frames) for name in ("I_TIP", "PA"))
    x, y, z = (R.T @ (tip - palm) / evaluator.scale).tolist()
    across = Cross(Dir(PALM), Nrm(PALM))
    there = VSum((Scale(across, x), Scale(Dir(PALM), y), Scale(Nrm(PALM), z)))
    place = Place(Site("I_TIP", S), VTranslate(SitePoint(Site("PA", S)), there))
    assert run(place).met
    report = run(place, Morph("index_bend", S, 0.0), Morph("index_hook", S, 0.0))
    assert reason(report).startswith("needs joints that `morph 'index_bend s` sets")
    assert "morph 'index_hook s" in reason(report)


def test_an_undefined_direction_is_a_reason_and_spoils_nothing_else() -> None:
    report = run(along(DIR, PALM, VDiff(UP, UP)), along(NRM, PALM, UP))
    assert math.isnan(report.constraints[0].residual)
    assert reason(report) == "its direction is undefined: a vector in it has no length"
    assert report.constraints[1].met


def test_a_redundant_set_is_met() -> None:
    h = math.sqrt(0.5)
    report = run(
        along(DIR, FOREARM, FORWARD),
        Orient(DIR, FOREARM, Relation.ACROSS, UP),
        Orient(DIR, FOREARM, Relation.ACROSS, Vec(1.0, 0.0, 0.0)),
        along(DIR, FOREARM, Vec(0.0, 0.0, h)),
    )
    assert report.met


def test_reasons_can_be_left_out() -> None:
    report = run(Place(Site("I_TIP", S), WorldPoint(0.0, 1.0, 9.0)), explain=False)
    assert reason(report) == "not looked into"
    assert report.explain_s == 0.0
    looked_into = run(Place(Site("I_TIP", S), WorldPoint(0.0, 1.0, 9.0)))
    assert looked_into.explain_s > 0.0


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
