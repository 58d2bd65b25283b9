"""Sites on paths and at moving points: where they are, when, and what else holds meanwhile."""

from __future__ import annotations

import math

import numpy as np
import pytest
from played_scores import (
    MIDDLE,
    PATH,
    TIP,
    UP,
    S,
    W,
    at,
    block,
    frame_at,
    hold,
    played,
    results,
    rig,
    sync,
    tip_track,
)

from azee_solver.constraint import (
    BoneAxis,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
)
from azee_solver.geometry import (
    Arc,
    Bone,
    Circle,
    Moving,
    Path,
    Site,
    SitePoint,
    Straight,
    Vec,
    VTranslate,
)


@pytest.mark.parametrize(
    "path", [Straight(), Arc(Vec(0.08, 0, 0)), Circle(Vec(0, 0, 1), 0.05, 1.0)]
)
def test_a_site_travels_on_its_path_within_2_mm(path: Path) -> None:
    score = sync(
        block("START", "0", ".2", at(TIP, 0, 0.1, 0)),
        block("MOVE", ".2", ".6", Transpath(TIP, path)),
        block("END", ".8", ".2", at(TIP, 0, 0.02, 0)),
    )
    animation = played(score)
    move = results(animation)["MOVE transpath"]
    assert move.met, move
    assert move.residual is not None
    assert move.residual < 2e-3


def test_a_straight_path_is_straight_and_has_the_profile_of_minimum_jerk() -> None:
    animation = played(PATH)
    tip = tip_track(animation)
    first, last = tip[frame_at(animation, 0.2)], tip[frame_at(animation, 0.8)]
    assert first - last == pytest.approx([0, 0.2 * _scale(), 0], abs=2e-3)
    for tau in (0.25, 0.5, 0.75):
        s = 10 * tau**3 - 15 * tau**4 + 6 * tau**5
        now = tip[frame_at(animation, 0.2 + 0.6 * tau)]
        exact = animation.clip.times[frame_at(animation, 0.2 + 0.6 * tau)] - animation.lead_s
        assert exact == pytest.approx(0.2 + 0.6 * tau, abs=0.017)
        tau = (exact - 0.2) / 0.6
        s = 10 * tau**3 - 15 * tau**4 + 6 * tau**5
        assert now == pytest.approx(first + s * (last - first), abs=2e-3)


def _scale() -> float:
    return rig().landmarks.arm_m / rig().landmarks.reference_arm_m


def test_other_constraints_hold_on_the_way() -> None:
    score = sync(
        *PATH.blocks,
        block(
            "PERM", "0", "1", Orient(BoneAxis.NRM, Bone("palm", S), Relation.ALONG, Vec(1, 0, 0))
        ),
    )
    perm = results(played(score))["PERM orient"]
    assert perm.met, perm


def test_both_hands_travel_at_once_and_a_key_falls_on_the_way() -> None:
    weak = Site("I_TIP", W)
    score = sync(
        block("START", "0", ".2", at(TIP, -0.05, 0.1, 0), at(weak, 0.05, 0.1, 0)),
        block("MOVE", ".2", ".6", Transpath(TIP, Straight()), Transpath(weak, Straight())),
        block("END", ".8", ".2", at(TIP, -0.2, 0.1, 0), at(weak, 0.2, 0.1, 0)),
        block("NOD", ".4", ".2", Rotate(Bone("head"), Vec(1, 0, 0), 0.2)),
    )
    animation = played(score)
    assert animation.report.met, [c for c in animation.report.constraints if not c.met]
    speed = np.linalg.norm(np.diff(tip_track(animation), axis=0), axis=1)
    assert speed[frame_at(animation, 0.4)] > 0.003
    assert speed[frame_at(animation, 0.6)] > 0.003


def test_a_place_follows_a_moving_point() -> None:
    moving = Moving(Arc(Vec(0, 0.05, 0)), MIDDLE, VTranslate(MIDDLE, Vec(-0.15, 0, 0)))
    score = sync(
        block("MVT", "0", ".8", Place(TIP, moving)),
        hold("HOLD", ".8", ".4", "MVT"),
    )
    found = results(played(score))
    assert found["MVT place"].met, found["MVT place"]
    assert found["HOLD place"].met, found["HOLD place"]
    tip = tip_track(played(score))
    first, last = frame_at(played(score), 0.8), frame_at(played(score), 1.2)
    assert np.ptp(tip[first : last + 1], axis=0).max() < 1e-3


def test_a_hand_that_rests_on_the_head_follows_it() -> None:
    forehead = Place(TIP, SitePoint(Site("FH")), contact=True)
    score = sync(
        block("TOUCH", "0", "1.2", forehead),
        block("TURN", ".4", ".3", Rotate(Bone("head"), UP, math.radians(20))),
    )
    touch = results(played(score))["TOUCH place"]
    assert touch.met, touch
