"""Constraints on the body of sticks that cannot be met: the nearest posture, and the reason."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from stick_solver import FOREARM, FORWARD, IDLE, PALM, RIG, reason, run, value
from tree_sign import DIR, NRM, UP, S, along

from azee_solver.constraint import (
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
)
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import (
    Bone,
    Cross,
    Dir,
    FreePoint,
    Nrm,
    Scale,
    Side,
    Site,
    SitePoint,
    VDiff,
    Vec,
    VSum,
    VTranslate,
    WorldPoint,
)


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
    scale = Evaluator(RIG, Side.RIGHT).scale

    def forward(share: float) -> WorldPoint:
        """A point in front at a share of the straight body's length from its root."""
        z = math.sqrt((share * length) ** 2 - aside**2 - up**2)
        return WorldPoint(aside, float(root[1]) + up, float(root[2]) + z)

    for share in (0.905, 0.915, 0.925):
        report = run(Place(Site("PA", S), forward(share)))
        assert reason(report).startswith("the lower back cannot bend further: it is at ")
    beside = Place(Site("PA", S), forward(0.915 + 0.1 * scale / float(length)), 0.1)
    assert reason(run(beside)).startswith("the lower back cannot bend further: it is at ")
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
    back = run(Morph("index_bend", S, -0.8))
    assert reason(back) == (
        "the first joint of the right index finger cannot bend further: "
        "it is at 45° of extension and needs 24.0° more"
    )
    assert value(back, "index_R_1.flexion") == pytest.approx(-45)


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


def test_reasons_are_found_once_when_they_are_asked_for() -> None:
    report = run(Place(Site("I_TIP", S), WorldPoint(0.0, 1.0, 9.0)))
    assert report.missed
    assert report.explain_s == 0.0
    found = reason(report)
    took_s = report.explain_s
    assert took_s > 0.0
    assert reason(report) == found
    assert report.explain_s == took_s


def test_a_pickle_has_the_words_of_reasons_not_what_finds_them() -> None:
    (answer,) = run(Place(Site("I_TIP", S), WorldPoint(0.0, 1.0, 9.0))).constraints
    data = pickle.dumps(answer)
    assert len(data) < 5000
    assert pickle.loads(data).reason == answer.reason
