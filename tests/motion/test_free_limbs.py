"""Limbs that nothing asks for: at rest, on their way to it, held, or released."""

from __future__ import annotations

import math

import numpy as np
import pytest
from played_scores import (
    MIDDLE,
    NEARLY_RAD,
    TIP,
    TWO_KEYS,
    UP,
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

from azee.animation import animate
from azee.motion.keys.rest import DEFAULT, RESTS, Rest, rest_posture
from azee_solver.constraint import (
    BoneAxis,
    LookAt,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
)
from azee_solver.geometry import (
    Bone,
    FreePoint,
    Side,
    Site,
    Vec,
    VTranslate,
)


@pytest.mark.parametrize("rest", RESTS)
def test_the_signer_stands_at_rest_before_and_after(rest: Rest) -> None:
    clip = animate(TWO_KEYS, rig(), life=False, rest=rest).clip
    standing = rest_posture(rig(), rest, Side.RIGHT)
    assert clip.coordinates[0] == pytest.approx(standing, abs=NEARLY_RAD)
    assert clip.coordinates[-1] == pytest.approx(standing, abs=NEARLY_RAD)
    with pytest.raises(ValueError, match=r"no rest 'asleep'; .* are: folded, hanging, ready"):
        animate(TWO_KEYS, rig(), rest="asleep")  # type: ignore[arg-type]


@pytest.mark.parametrize("rest", RESTS)
def test_ways_from_and_to_rest_are_calm(rest: Rest) -> None:
    high = sync(block("HIGH", "0", ".4", at(TIP, -0.2, 0.45, 0.1)))
    animation = animate(high, rig(), life=False, rest=rest, fps=120.0)
    frames = rig().chain.frames(animation.clip.coordinates)
    wrist = frames.positions[:, rig().bones["palm_R"].origin_node]
    assert np.linalg.norm(wrist[0] - wrist.mean(axis=0)) > 0.1
    speeds = np.linalg.norm(np.diff(wrist, axis=0), axis=1) * 120.0
    assert 0.8 < speeds.max() < 2.0


def test_an_idle_hand_stays_at_rest_while_the_other_signs() -> None:
    standing = rest_posture(rig(), DEFAULT, Side.RIGHT)
    weak = [i for i, n in enumerate(rig().coordinates.names) if "_L" in n and n[:3] != "eye"]
    clip = played(TWO_KEYS).clip
    assert clip.coordinates[:, weak] == pytest.approx(
        np.tile(standing[weak], (len(clip.times), 1)), abs=NEARLY_RAD
    )


@pytest.mark.parametrize(
    "raised", [Morph("shoulder_raise", W, 1.0), Rotate(Bone("clav", W), UP, 0.1)], ids=type
)
def test_an_arm_hangs_from_a_shoulder_that_moves(raised: Morph | Rotate) -> None:
    names = rig().coordinates.names
    arm = [i for i, n in enumerate(names) if n.startswith(("arm_L", "f_arm_L"))]
    clavicle = [i for i, n in enumerate(names) if n.startswith("clav_L")]
    standing = rest_posture(rig(), DEFAULT, Side.RIGHT)
    animation = played(sync(block("SHRUG", "0", "1", raised)))
    shrugged = animation.clip.coordinates[frame_at(animation, 0.5)]
    assert np.abs(shrugged[clavicle] - standing[clavicle]).max() > 0.05
    assert shrugged[arm] == pytest.approx(standing[arm], abs=0.05)


def test_a_hold_keeps_the_hands_and_lets_the_head_go() -> None:
    sign = block("A", "0", ".5", at(TIP, 0, 0, 0), Rotate(Bone("head"), UP, 0.4))
    animation = played(sync(sign, hold("H", ".5", "1.5", "A")))
    found = results(animation)
    assert found["H place"].met
    assert "H rotate" not in found
    axial = rig().coordinates.index["head.axial"]
    end = frame_at(animation, 1.9)
    assert abs(animation.clip.coordinates[end, axial]) < 0.01
    assert tip_track(animation)[end] == pytest.approx(
        tip_track(animation)[frame_at(animation, 0.5)], abs=1e-3
    )


def test_a_free_hand_goes_down_while_the_other_signs_on() -> None:
    weak = Place(Site("I_TIP", W), VTranslate(MIDDLE, Vec(0.1, 0.3, 0)))
    animation = played(
        sync(
            block("BOTH", "0", ".5", at(TIP, -0.1, 0, 0), weak),
            block("ONE", ".8", "2", at(TIP, -0.1, 0.1, 0)),
        )
    )
    left = [i for i, n in enumerate(rig().coordinates.names) if n.startswith(("arm_L", "f_arm_L"))]
    late = animation.clip.coordinates[frame_at(animation, 2.0)]
    standing = rest_posture(rig(), DEFAULT, Side.RIGHT)
    assert late[left] == pytest.approx(standing[left], abs=NEARLY_RAD)
    both = animation.clip.coordinates[frame_at(animation, 0.5)]
    assert np.abs(both[left] - standing[left]).max() > 0.2


def test_a_key_of_the_head_does_not_stop_a_free_arm() -> None:
    sign = (
        block("A", "0", ".2", at(TIP, 0, 0.1, 0)),
        block("B", ".7", ".2", at(TIP, -0.15, -0.1, 0)),
    )
    nod = block("NOD", ".45", "0", Rotate(Bone("head"), Vec(1, 0, 0), 0.1))
    arm = [i for i, n in enumerate(rig().coordinates.names) if n.startswith(("arm_R", "f_arm_R"))]
    with_nod, without = played(sync(*sign, nod)), played(sync(*sign))
    assert with_nod.clip.coordinates[:, arm] == pytest.approx(without.clip.coordinates[:, arm])
    flexion = rig().coordinates.index["head.flexion"]
    assert np.ptp(with_nod.clip.coordinates[:, flexion]) > 0.05


def test_a_look_turns_eyes_and_lids_and_leaves_the_arms_at_rest() -> None:
    score = sync(
        block("GAZE", "0", "1", LookAt(FreePoint(-0.3, 0.1, 1.0))),
        block("FACE", "0", "1", Morph("AU1", None, 0.7)),
    )
    animation = played(score)
    assert animation.report.met, animation.report.constraints
    arms = [i for i, n in enumerate(rig().coordinates.names) if n.startswith(("arm", "f_arm"))]
    idle = rest_posture(rig(), DEFAULT, Side.RIGHT)[arms]
    assert animation.clip.coordinates[:, arms] == pytest.approx(
        np.broadcast_to(idle, (len(animation.clip.times), len(arms))), abs=NEARLY_RAD
    )
    middle = frame_at(animation, 0.5)
    wanted = {unit: 0.7 * share for unit, share in rig().face_morphs["AU1"].items()}
    for unit, weight in rig().lid_weights(animation.clip.coordinates[middle]).items():
        wanted[unit] = wanted.get(unit, 0.0) + float(weight)
    weights = animation.clip.unit_weights[middle]
    for unit, weight in zip(animation.clip.units, weights, strict=True):
        assert weight == pytest.approx(wanted.pop(unit, 0.0))
    assert not any(wanted.values())
    assert any("eyeLook" in unit for unit in animation.clip.units)


def test_a_glance_is_over_though_the_chin_stays_up() -> None:
    chin = Rotate(Bone("head"), Vec(-1, 0, 0), math.radians(6))
    score = sync(
        block("GAZE", "0", ".2", LookAt(FreePoint(-0.5, 0.05, 0.5))),
        block("CHIN", ".1", "1.9", chin),
        block("LATER", "1", ".2", at(TIP, 0, 0, 0)),
    )
    animation = played(score)
    assert animation.report.met, animation.report.constraints
    index = rig().coordinates.index
    turned = animation.clip.coordinates[:, [index["neck.axial"], index["head.axial"]]].sum(axis=1)
    raised = animation.clip.coordinates[:, index["head.flexion"]]
    assert abs(turned[frame_at(animation, 0.2)]) > math.radians(10)
    assert abs(turned[frame_at(animation, 1.0)]) < math.radians(1)
    for time in (0.2, 1.0, 1.9):
        assert raised[frame_at(animation, time)] < -math.radians(3.5)


def test_a_levelled_head_goes_straight_to_where_something_turns_it() -> None:
    lean = Orient(BoneAxis.DIR, Bone("back_2"), Relation.ALONG, Vec(0, 1, 0.4))
    turn = Rotate(Bone("head"), UP, math.radians(15))
    score = sync(block("LEAN", "0", "2", lean), block("TURN", "1.2", ".4", turn))
    animation = played(score)
    assert animation.report.met, animation.report.constraints
    neck = animation.clip.coordinates[:, rig().coordinates.index["neck.flexion"]]
    assert neck[frame_at(animation, 0.0)] < -math.radians(8)
    assert neck[frame_at(animation, 0.4)] < 0.6 * neck[frame_at(animation, 0.0)]
