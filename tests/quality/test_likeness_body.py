"""Joints, limits, trunk, head and eyes, on postures and movements known in closed form."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from movements import ARM_L, ARM_R, drawn, moves, span, still, then
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.quality.head_and_gaze import (
    head_roll_deg,
    head_under_gaze,
    longest_far_gaze_s,
    trunk_displacement,
)
from azee.quality.joints import (
    at_limits,
    largest_joint_speed,
    longest_stillness_s,
    unasked_turns,
)
from azee.quality.kinematics import angle_deg
from azee.quality.symmetry import elbow_asymmetry_cm
from azee_rig.rig import Rig
from azee_solver.constraint import BoneAxis, LookAt, Orient, Relation, Rotate
from azee_solver.geometry import Bone, Dir, NamedPoint, Side, SigningSpace, Vec

Array = NDArray[np.float64]
GAZE = LookAt(NamedPoint(SigningSpace.RSSP))
FRAME = 1.0 / 120.0


def test_each_part_of_the_body_has_its_fastest_joint(signer: Rig) -> None:
    k = drawn(
        signer,
        1.5,
        {
            "arm_R.flexion": moves(60.0, 0.2, 0.4, 12.0),
            "palm_L.flexion": moves(30.0, 0.2, 0.8),
            "back_1.flexion": moves(8.0, 0.3, 0.5),
            "neck.axial": moves(-20.0, 0.3, 0.5),
            "index_L_2.flexion": moves(60.0, 0.5, 0.4, 25.0),
            "eye_L.yaw": moves(30.0, 0.5, 0.05),
        },
    )
    for part, coordinate, wanted in (
        ("arm", "arm_R.flexion", 1.875 * 60.0 / 0.4),
        ("trunk", "back_1.flexion", 1.875 * 8.0 / 0.5),
        ("head", "neck.axial", 1.875 * 20.0 / 0.5),
        ("fingers", "index_L_2.flexion", 1.875 * 60.0 / 0.4),
    ):
        found = largest_joint_speed(k, part)  # type: ignore[arg-type]
        assert found is not None
        assert found.of == coordinate
        assert found.value == pytest.approx(wanted, rel=2e-3)
    arm = largest_joint_speed(k, "arm")
    assert arm is not None
    assert arm.at_s == pytest.approx(0.4, abs=FRAME)


def test_a_jump_inside_a_block_that_asks_for_none_is_found(signer: Rig) -> None:
    """10° between two frames at 120 frames/s are 1,200 °/s."""
    k = drawn(signer, 2.0, {"palm_L.flexion": lambda t: np.where(t > 1.001, 10.0, 0.0)})
    buoy = span(0.5, 1.5, limb="index_L", limbs=ARM_L, path=("BUOY",))
    (found,) = unasked_turns(k, [buoy])
    assert found.coordinate == "palm_L.flexion"
    assert found.speed_deg_s == pytest.approx(1200.0)
    assert found.at_s == pytest.approx(1.0, abs=FRAME)
    assert found.path == ("BUOY",)


def test_a_jump_is_not_unasked_where_movement_or_another_posture_is_asked(signer: Rig) -> None:
    k = drawn(signer, 2.0, {"palm_L.flexion": lambda t: np.where(t > 1.001, 10.0, 0.0)})
    buoy = span(0.5, 1.5, limb="index_L", limbs=ARM_L)
    path = span(0.8, 1.2, limb="palm_L", limbs=ARM_L, moving=True)
    other = span(0.8, 1.2, limb="index_R", limbs=ARM_R, moving=True)
    follows = span(0.6, 1.4, limb="palm_L", limbs=ARM_L, reads=frozenset({"index_R"}))
    next_one = span(1.005, 1.5, limb="palm_L", limbs=ARM_L)
    assert unasked_turns(k, [buoy, path]) == ()
    assert len(unasked_turns(k, [buoy, other])) == 1
    assert unasked_turns(k, [buoy, other, follows]) == ()
    for start, end in ((1.005, 1.2), (0.8, 1.004)):  # begins or ends with the jump
        beside = span(start, end, limb="index_R", limbs=ARM_R, moving=True)
        assert unasked_turns(k, [buoy, beside, follows]) == ()
    assert unasked_turns(k, [buoy, next_one]) == ()
    assert unasked_turns(k, [span(0.5, 1.5, limb="head")]) == ()
    assert unasked_turns(k, []) == ()


def test_slower_turns_are_not_told(signer: Rig) -> None:
    k = drawn(signer, 2.0, {"palm_L.flexion": lambda t: np.where(t > 1.001, 4.9, 0.0)})
    assert unasked_turns(k, [span(0.5, 1.5, limb="palm_L", limbs=ARM_L)]) == ()


def test_a_still_head_is_still_for_its_time(signer: Rig) -> None:
    """A swing of amplitude A is below v while |cos ωt| < v / Aω: 2 arcsin(v / Aω) / ω at a time."""
    amplitude, omega, start = 1.0, 2.0 * math.pi, 1.5

    def swings(t: Array) -> Array:
        return np.where(t < start, amplitude * np.sin(omega * t), 0.0)

    k = drawn(signer, 2.25, {"head.axial": swings, "back_1.axial": lambda t: 0.5 * t})
    assert longest_stillness_s(k, "head") == pytest.approx(0.75, abs=2 * FRAME)
    assert longest_stillness_s(k, "trunk") < 2 * FRAME
    assert longest_stillness_s(k, "body") < 2 * FRAME
    for speed, still_s in ((0.19, 1.0), (0.21, 0.0)):
        drifts = drawn(signer, 1.0, {"head.axial": partial(np.multiply, speed)})
        assert longest_stillness_s(drifts, "head") == pytest.approx(still_s)
    always = drawn(signer, 2.0, {"neck.flexion": lambda t: 0.1 * np.sin(omega * t)})
    wanted = 2.0 * math.asin(0.2 / (0.1 * omega)) / omega
    assert longest_stillness_s(always, "head") == pytest.approx(wanted, abs=2 * FRAME)
    assert longest_stillness_s(always, "trunk") == pytest.approx(2.0)


def test_coordinates_near_their_limits_are_named_with_their_share(signer: Rig) -> None:
    upper = math.degrees(signer.coordinates.upper[signer.coordinates.index["back_1.flexion"]])
    lower = math.degrees(signer.coordinates.lower[signer.coordinates.index["clav_L.elevation"]])

    def bows(t: Array) -> Array:
        return np.where(t < 0.25, upper - 0.9, upper - 1.1)

    k = drawn(
        signer,
        1.0 - FRAME,
        {
            "back_1.flexion": bows,
            "clav_L.elevation": lambda t: np.where(t >= 0.5, lower, 0.0),
            "index_R_2.flexion": still(0.0),
        },
    )
    found = at_limits(k)
    assert found.coordinates == pytest.approx({"back_1.flexion": 0.25, "clav_L.elevation": 0.5})
    assert found.share == pytest.approx(0.75)


def test_the_trunk_s_displacement_is_the_sum_of_its_bends(signer: Rig) -> None:
    k = drawn(
        signer,
        2.0,
        {"back_1.flexion": moves(10.0, 0.5, 0.5), "back_2.flexion": moves(5.0, 0.5, 0.5)},
    )
    found = trunk_displacement(k)
    assert found.value == pytest.approx(15.0, abs=1e-6)
    assert found.at_s >= 1.0 - FRAME


def test_a_tilted_head_rolls_and_one_that_looks_about_does_not(signer: Rig) -> None:
    assert head_roll_deg(drawn(signer, 0.1, {"head.lateral": still(8.0)})) == pytest.approx(-8.0)
    about = drawn(signer, 0.1, {"head.axial": still(25.0), "head.flexion": still(12.0)})
    assert head_roll_deg(about) == pytest.approx(0.0, abs=1e-9)


def test_the_head_under_a_gaze_and_its_return(signer: Rig) -> None:
    """From 20° back by minimum jerk in .6 s: below 5° when three quarters of the way are done."""
    course = then(moves(20.0, 0.4, 0.4), moves(-20.0, 1.2, 0.6))
    k = drawn(signer, 2.5, {"head.lateral": course})
    gaze = span(0.8, 1.2, limb="eyes", constraint=GAZE)
    found = head_under_gaze(k, [gaze])
    assert found.roll_deg is not None
    assert found.roll_deg.value == pytest.approx(20.0)
    taus = np.linspace(0.0, 1.0, 100_001)
    wanted = 0.6 * taus[np.searchsorted(minimum_jerk(taus), 0.75)]
    assert found.return_s == pytest.approx(wanted, abs=FRAME)


LEVEL = Orient(BoneAxis.DIR, Bone("head"), Relation.ALONG, Vec(0, 1, 0))


@pytest.mark.parametrize(
    ("axis", "roll"), [(Vec(0, 0, 1), 8.0), (Vec(1, 0, 0), 20.0), (Vec(0, 3, 4), 20.0 - 0.8 * 12.0)]
)
def test_a_roll_that_is_asked_for_is_allowed(signer: Rig, axis: Vec, roll: float) -> None:
    k = drawn(signer, 2.5, {"head.lateral": then(moves(20.0, 0.4, 0.4), moves(-20.0, 1.2, 0.6))})
    gaze = span(0.8, 1.2, limb="eyes", constraint=GAZE)
    rotation = Rotate(Bone("head"), axis, math.radians(-12.0))
    found = head_under_gaze(k, [gaze, span(0.7, 3.0, limb="head", constraint=rotation)])
    assert found.roll_deg is not None
    assert found.roll_deg.value == pytest.approx(roll)
    # Back below 5° + 12°: three twentieths of the way are done.
    taus = np.linspace(0.0, 1.0, 100_001)
    wanted = 0.6 * taus[np.searchsorted(minimum_jerk(taus), 0.15)]
    assert found.return_s == pytest.approx(wanted, abs=FRAME)


def test_where_the_head_is_fixed_or_looks_on_nothing_is_measured(signer: Rig) -> None:
    k = drawn(signer, 2.5, {"head.lateral": then(moves(20.0, 0.4, 0.4), moves(-20.0, 1.2, 0.6))})
    gaze = span(0.8, 1.2, limb="eyes", constraint=GAZE)
    found = head_under_gaze(k, [gaze, span(0.7, 1.3, limb="head", constraint=LEVEL)])
    assert (found.roll_deg, found.return_s) == (None, None)
    soon = span(1.25, 1.6, limb="eyes", constraint=GAZE)
    until_next = head_under_gaze(k, [gaze, soon])
    assert until_next.return_s is not None
    assert until_next.return_s < 0.2
    on = span(1.0, 1.6, limb="eyes", constraint=GAZE)
    assert head_under_gaze(k, [gaze, on]).return_s == head_under_gaze(k, [on]).return_s
    never = drawn(signer, 2.0, {"head.lateral": still(20.0)})
    assert head_under_gaze(never, [gaze]).return_s == pytest.approx(0.8, abs=FRAME)
    nothing = head_under_gaze(k, [])
    assert (nothing.roll_deg, nothing.return_s) == (None, None)


def test_a_head_that_is_back_already_returns_at_once(signer: Rig) -> None:
    k = drawn(signer, 1.0)
    assert head_under_gaze(k, [span(0.2, 0.5, limb="eyes", constraint=GAZE)]).return_s == 0.0


@pytest.mark.parametrize(("turned_deg", "return_s"), [(4.9, 0.0), (5.1, 0.5)])
def test_a_head_turned_by_five_degrees_is_not_back(
    signer: Rig, turned_deg: float, return_s: float
) -> None:
    """Until the clip ends."""
    k = drawn(signer, 1.0, {"head.lateral": still(turned_deg)})
    found = head_under_gaze(k, [span(0.2, 0.5, limb="eyes", constraint=GAZE)]).return_s
    assert found == pytest.approx(return_s, abs=FRAME)


def test_a_lean_of_the_trunk_is_no_turn_of_the_head_against_it(signer: Rig) -> None:
    k = drawn(signer, 1.0, {"back_2.lateral": still(10.0)})
    assert head_under_gaze(k, [span(0.2, 0.5, limb="eyes", constraint=GAZE)]).return_s == 0.0


def test_eyes_that_look_far_aside_do_so_for_their_time(signer: Rig) -> None:
    def looks(degrees: float, start: float, end: float) -> object:
        return lambda t: np.where((t >= start - 1e-9) & (t < end - 1e-9), degrees, 0.0)

    yaw = looks(25.0, 0.5, 0.9)
    k = drawn(signer, 2.0, {"eye_L.yaw": yaw, "eye_R.pitch": looks(19.0, 0.2, 1.9)})  # type: ignore[dict-item]
    assert longest_far_gaze_s(k) == pytest.approx(0.4)
    slant = drawn(signer, 0.5, {"eye_L.yaw": still(15.0), "eye_L.pitch": still(15.0)})
    assert longest_far_gaze_s(slant) == pytest.approx(0.5 + FRAME)  # 21.1°


def forearm_level(side: Side) -> Orient:
    """The hand in line with its forearm: met in every posture without a bend of the wrist."""
    arm = Dir(Bone("f_arm", side))
    return Orient(BoneAxis.DIR, Bone("palm", side), Relation.ALONG, arm)


def test_elbows_of_a_symmetric_sign_are_mirror_images(signer: Rig) -> None:
    """One arm is raised 10° farther: as far as an elbow goes when its arm is raised so far."""
    q = {
        f"{bone}_{side}.{movement}": still(0.0)
        for side in "LR"
        for bone, movement in (("palm", "flexion"), ("palm", "deviation"), ("arm", "flexion"))
    }
    q |= {"arm_L.abduction": still(30.0), "arm_R.abduction": still(20.0)}
    k = drawn(signer, 2.0, q)
    both = [
        span(0.5, 1.5, limb="palm_L", limbs=ARM_L, constraint=forearm_level(Side.LEFT)),
        span(0.5, 1.5, limb="palm_R", limbs=ARM_R, constraint=forearm_level(Side.RIGHT)),
    ]
    found = elbow_asymmetry_cm(k, both)
    assert found is not None
    raised = drawn(signer, 2.0, q | {"arm_R.abduction": still(30.0)})
    chord = np.linalg.norm(raised.joint("f_arm_R")[0] - k.joint("f_arm_R")[0])
    assert chord == pytest.approx(
        2 * signer.landmarks.upper_arm_m * math.sin(math.pi / 36), rel=0.1
    )
    assert found.value == pytest.approx(100.0 * k.scale * chord, abs=0.01)
    assert found.at_s == pytest.approx(1.0, abs=FRAME)
    assert elbow_asymmetry_cm(k, both[:1]) is None
    nod = span(0.6, 0.8, limb="head", constraint=LEVEL)
    assert elbow_asymmetry_cm(k, [*both, nod]) == found  # the arms hold on meanwhile
    level = forearm_level(Side.LEFT)
    moving = span(0.5, 1.5, limb="palm_L", limbs=ARM_L, constraint=level, moving=True)
    assert elbow_asymmetry_cm(k, [*both, moving]) is None
    first = span(0.1, 0.5, limb="palm_L", limbs=ARM_L, constraint=level, moving=True)
    assert elbow_asymmetry_cm(k, [first, *both]) == found  # it is still symmetric afterwards


def test_a_sign_that_its_mirror_image_does_not_meet_is_not_symmetric(signer: Rig) -> None:
    k = drawn(signer, 2.0, {"arm_L.abduction": still(30.0), "f_arm_R.flexion": still(90.0)})
    axes = {s: k.frames.rotations[0, signer.bones[f"f_arm_{s}"].node, :, 1] for s in "LR"}
    asked = [
        span(
            0.5,
            1.5,
            limb=f"arm_{s}",
            limbs=ARM_L if s == "L" else ARM_R,
            constraint=Orient(
                BoneAxis.DIR, Bone("f_arm", Side(s)), Relation.ALONG, Vec(*axes[s].tolist())
            ),
        )
        for s in "LR"
    ]
    assert elbow_asymmetry_cm(k, asked) is None
    level = drawn(signer, 2.0)
    axis = level.frames.rotations[0, signer.bones["f_arm_R"].node, :, 1].tolist()
    mirror = [-axis[0], axis[1], axis[2]]
    asked = [
        span(
            0.5,
            1.5,
            limb=f"arm_{s}",
            limbs=ARM_L if s == "L" else ARM_R,
            constraint=Orient(BoneAxis.DIR, Bone("f_arm", Side(s)), Relation.ALONG, Vec(*v)),
        )
        for s, v in (("L", mirror), ("R", axis))
    ]
    found = elbow_asymmetry_cm(level, asked)
    assert found is not None
    assert found.value == pytest.approx(0.0, abs=0.05)


def test_a_trunk_that_leans_takes_both_elbows_along(signer: Rig) -> None:
    q = {
        f"{bone}_{side}.{movement}": still(0.0)
        for side in "LR"
        for bone, movement in (("palm", "flexion"), ("palm", "deviation"), ("arm", "flexion"))
    }
    q |= {f"arm_{side}.abduction": still(30.0) for side in "LR"}
    leaning = drawn(signer, 2.0, q | {"back_1.axial": still(12.0), "back_1.flexion": still(8.0)})
    both = [
        span(0.5, 1.5, limb="palm_L", limbs=ARM_L, constraint=forearm_level(Side.LEFT)),
        span(0.5, 1.5, limb="palm_R", limbs=ARM_R, constraint=forearm_level(Side.RIGHT)),
    ]
    found = elbow_asymmetry_cm(leaning, both)
    assert found is not None
    assert found.value == pytest.approx(0.0, abs=0.05)
    shifted = span(0.0, 2.0, limb="trunk", constraint=LEVEL)
    assert elbow_asymmetry_cm(leaning, [*both, shifted]) is None


@pytest.mark.parametrize(("degrees", "symmetric"), [(2.4, True), (2.65, False)])
def test_a_trunk_turned_by_five_degrees_from_its_mirror_image_is_turned(
    signer: Rig, degrees: float, symmetric: bool
) -> None:
    """A turn is twice as far from its mirror image as from no turn."""
    k = drawn(signer, 2.0, {"back_1.axial": still(degrees)})
    both = [
        span(0.5, 1.5, limb="palm_L", limbs=ARM_L, constraint=forearm_level(Side.LEFT)),
        span(0.5, 1.5, limb="palm_R", limbs=ARM_R, constraint=forearm_level(Side.RIGHT)),
    ]
    shifted = span(0.0, 2.0, limb="trunk", constraint=LEVEL)
    assert elbow_asymmetry_cm(k, both) is not None
    assert (elbow_asymmetry_cm(k, [*both, shifted]) is not None) == symmetric


def test_from_the_front_the_nose_is_seen_or_else_the_joint_of_the_head(signer: Rig) -> None:
    k = drawn(signer, 0.1, {"head.axial": moves(20.0, 0.0, 0.1)})
    joints = [k.joint(bone)[:, :2] for bone in ("arm_L", "arm_R", "palm_L", "palm_R")]
    nose = signer.sites["NO"].point(k.frames)[:, :2]
    assert np.ptp(nose, axis=0).max() > 0.01
    np.testing.assert_array_equal(k.frontal, np.stack([*joints, nose], axis=1))
    sites = {name: site for name, site in signer.sites.items() if name != "NO"}
    without = replace(k, rig=replace(signer, sites=sites))
    head = k.joint("head")[:, :2]
    np.testing.assert_array_equal(without.frontal, np.stack([*joints, head], axis=1))


def test_angles_of_no_turn_and_of_a_half_turn_are_numbers() -> None:
    """Rounding takes the cosine of some of them beyond ±1."""
    axes = np.random.default_rng(1).normal(size=(200, 3))
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    half = 2.0 * axes[:, :, None] * axes[:, None, :] - np.eye(3)
    np.testing.assert_allclose(angle_deg(half), 180.0, atol=1e-5)
    np.testing.assert_allclose(angle_deg(half @ np.swapaxes(half, -1, -2)), 0.0, atol=1e-5)
