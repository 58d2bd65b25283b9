"""Numbers that retargeting goes by, each from both sides: thresholds, shares and weights."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from carried_over import posed, stick_figure
from numpy.typing import NDArray

from azee.clip import retarget as retargeting
from azee.clip.bvh import parse_bvh
from azee.clip.clip import Clip
from azee.clip.retarget import eased, retarget, smoothed
from azee.clip.retarget_source import (
    Measured,
    RetargetError,
    measure_clip,
    measure_recording,
)
from azee_rig.rig import Rig
from azee_rig.rotation import about_axis, rotation_vectors

Floats = NDArray[np.float64]

TURNING = "CHANNELS 3 Zrotation Xrotation Yrotation "
STILL = "0 0 0 "


def with_spine(first: str, second: str, head_at: str, frames: list[str]) -> str:
    """BVH of the figure with two joints of a spine, and a head, at offsets from below.

    frames: rotations of hips, both joints of the spine and head, three each; arms are held out.
    """
    text = stick_figure(1, ("JOINT Head { OFFSET 0 60 0", (
        f"JOINT Spine {{ OFFSET {first} {TURNING} JOINT Spine1 {{ OFFSET {second} {TURNING} "
        f"JOINT Head {{ OFFSET {head_at}"
    ))).replace("15 45 0", "15 5 0")  # fmt: skip
    head = text.split("\nMOTION\n")[0].rstrip()
    rows = [f"0 95 0 {frame} {STILL * 6}" for frame in frames]
    motion = f"MOTION\nFrames: {len(rows)}\nFrame Time: 0.04\n" + "\n".join(rows) + "\n"
    return f"{head} }} }}\n{motion}"


def test_turns_of_trunk_and_head_are_shared_among_their_joints() -> None:
    """45 % and 55 % in the back, half and half in neck and head, about every axis."""
    bent = f"{STILL}0 20 0 {STILL}0 10 0"
    turned = f"{STILL}0 0 20 {STILL}0 0 10"
    leaning = f"{STILL}20 0 0 {STILL}10 0 0"
    text = with_spine("0 20 0", "0 20 0", "0 20 0", [STILL * 4, bent, turned, leaning])
    found = measure_recording(parse_bvh(text)).coordinates
    shares = {"back_1": 9.0, "back_2": 11.0, "neck": 5.0, "head": 5.0}
    for bone, most in shares.items():
        for frame, turn, sign in ((1, "flexion", 1), (2, "axial", 1), (3, "lateral", -1)):
            expected = np.zeros(4)
            expected[frame] = sign * most
            assert np.degrees(found[f"{bone}.{turn}"]) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(("share", "counted_from_rest"), [(0.91, True), (0.89, False)])
def test_a_posture_of_rest_stands_if_its_head_is_as_high(
    share: float, counted_from_rest: bool
) -> None:
    """The trunk of the file's rest is bent so that the head comes to a share of its height."""
    half = np.arccos(share)
    up, ahead = 30 * np.cos(2 * half), 30 * np.sin(2 * half)
    bent = f"0 {up / 3:.9f} {ahead / 3:.9f}"
    above = f"0 {2 * up / 3:.9f} {2 * ahead / 3:.9f}"
    straightened = f"{STILL}0 {-np.degrees(2 * half):.9f} 0 {STILL}{STILL}"
    text = with_spine("0 30 0", bent, above, [straightened])
    found = measure_recording(parse_bvh(text)).coordinates
    moved = max(float(np.abs(values).max()) for values in found.values())
    assert (moved > np.radians(5)) == counted_from_rest


@pytest.mark.parametrize(("share", "counted_from_rest"), [(0.81, True), (0.79, False)])
def test_a_posture_of_rest_stands_if_its_shoulders_are_as_wide(
    share: float, counted_from_rest: bool
) -> None:
    """The first frame moves the arms apart, and turns the head by 20°."""
    text = stick_figure(1).split("\nMOTION\n")[0]
    for side in ("Left", "Right"):
        text = text.replace(
            f"JOINT {side}Arm {{ OFFSET {'-' if side == 'Right' else ''}15 45 0 CHANNELS 3",
            f"JOINT {side}Arm {{ OFFSET {'-' if side == 'Right' else ''}15 45 0 CHANNELS 6 "
            "Xposition Yposition Zposition",
        )
    wide = 15 / share
    row = f"0 95 0 {STILL} 0 0 20 {wide:.9f} 45 0 {STILL * 3} {-wide:.9f} 45 0 {STILL * 3}"
    found = measure_recording(
        parse_bvh(f"{text}\nMOTION\nFrames: 1\nFrame Time: 0.04\n{row}\n")
    ).coordinates
    assert float(np.degrees(found["head.axial"][0])) == pytest.approx(
        10.0 if counted_from_rest else 0.0, abs=1e-6
    )


@pytest.mark.parametrize(("forearm", "told"), [("20.1", False), ("19.9", True)])
def test_arms_that_differ_by_a_fifth_may_be_misread(forearm: str, told: bool) -> None:
    text = stick_figure(1, ("OFFSET -25 0 0", f"OFFSET -{forearm} 0 0"))
    notes = measure_recording(parse_bvh(text)).notes
    assert any("joints may be misread" in note for note in notes) == told


@pytest.mark.parametrize(
    ("unit", "change", "refused"),
    [
        ("cm", ("28 0 0", "1.26 0 0"), False),
        ("cm", ("28 0 0", "1.24 0 0"), True),
        ("mm", ("28 0 0", "0.105 0 0"), False),
        ("mm", ("28 0 0", "0.095 0 0"), True),
        ("m", ("28 0 0", "1 0 0"), True),
    ],
)
def test_a_part_without_length_is_told_by_a_twentieth_and_by_a_tenth_of_a_millimetre(
    unit: str, change: tuple[str, str], refused: bool
) -> None:
    """Of a forearm of 25 cm, a twentieth is 1.25 cm; of one of 1 mm, less than a tenth.

    A twentieth exactly, as of one of 20 m, is no length, either.
    """
    text = stick_figure(1).replace(*change)
    text = text.replace("25 0 0", {"mm": "1 0 0", "m": "20 0 0", "cm": "25 0 0"}[unit])
    recording = parse_bvh(text, unit)
    if refused:
        with pytest.raises(RetargetError, match="the upper arm L has no length"):
            measure_recording(recording)
    else:
        assert measure_recording(recording).arm_m > 0.0


@pytest.mark.parametrize(("across_share", "refused"), [(0.051, False), (0.049, True)])
def test_shoulders_above_each_other_tell_no_left(across_share: float, refused: bool) -> None:
    height = 15 * np.sqrt(1 / across_share**2 - 1)
    text = stick_figure(1, ("OFFSET 15 45 0", f"OFFSET 15 {45 + height:.6f} 0"))
    text = text.replace("OFFSET -15 45 0", f"OFFSET -15 {45 - height:.6f} 0")
    if refused:
        with pytest.raises(RetargetError, match="one shoulder stands above the other"):
            measure_recording(parse_bvh(text))
    else:
        assert measure_recording(parse_bvh(text)).arm_m > 0.0


@pytest.mark.parametrize(
    ("speed", "spread"), [(24.5, False), (25.5, True), (-24.5, False), (-25.5, True)]
)
def test_turns_faster_than_25_rad_a_second_are_spread(speed: float, spread: bool) -> None:
    """Those alone, and no farther than 0.15 s from them is anything smoothed wholly."""
    times = np.arange(101) / 100
    q = np.zeros((101, 2))
    q[51:, 0] = speed / 100
    q[:, 1] = np.sin(4 * times)
    found = eased(q, times)
    assert (found[:, 1] == q[:, 1]).all()
    assert (np.abs(found[:, 0] - q[:, 0]).max() > 0.01) == spread


def test_a_turn_is_spread_over_as_few_as_three_frames() -> None:
    """The first and the last stay as they are, so that of two frames there is nothing to spread."""
    q = np.array([[0.0], [0.0], [0.9]])
    times = np.arange(3) / 30
    np.testing.assert_allclose(eased(q, times), [[0.0], [0.3], [0.9]])
    np.testing.assert_array_equal(eased(q[1:], times[1:]), q[1:])


def test_smoothing_takes_frames_up_to_0_15_s_away_and_fewer_near_an_end() -> None:
    times = np.arange(101) / 100
    for at, reach in ((50, 15), (7, 7)):
        q = np.zeros((101, 1))
        q[at] = 1.0
        touched = np.flatnonzero(smoothed(q, times)[:, 0])
        assert touched[0] == -(-at // 2) if at < 15 else at - reach
        assert touched[-1] == at + 15
        assert smoothed(q, times)[at, 0] == pytest.approx(1 / (2 * reach + 1))


def test_a_posture_out_of_reach_is_the_one_of_least_cost(signer: Rig) -> None:
    """4 mm of a wrist, 1° of a palm, 2 cm of an elbow and 60° of a joint weigh the same.

    No joint that is free to move makes the sum of squares less.
    """
    source = measure_clip(posed(signer, 1, {
        "arm_{}.flexion": 60, "arm_{}.abduction": 30, "arm_{}.rotation": 30,
        "f_arm_{}.flexion": 70, "f_arm_{}.pronation": 60,
    }), signer)  # fmt: skip
    wanted = replace(
        source,
        wrists=source.wrists + np.array([0.0, 0.03, 0.02]),
        elbows=source.elbows + np.array([0.0, 0.02, -0.02]),
    )
    wish = np.array(signer.coordinates.idle)[None]
    arms = retargeting._Arms(signer, wanted, wish)
    q = wish
    for _ in range(5):
        q = arms.solved(q, wish)
    for s, columns in enumerate(arms.columns):
        inside = (q[0] > signer.coordinates.lower + 1e-6) & (q[0] < signer.coordinates.upper - 1e-6)
        free = [v for v in columns if inside[v]]
        assert len(free) >= 6
        slopes = np.array([
            (_terms(signer, wanted, wish, q, v, 1e-5, s)
             - _terms(signer, wanted, wish, q, v, -1e-5, s)) / 2e-5
            for v in free
        ])  # fmt: skip
        total, least = np.abs(slopes.sum(axis=1)), np.linalg.norm(slopes, axis=0)
        assert least.min() > 0.1
        assert total.max() < 0.02 * least.min()


def _terms(
    rig: Rig, wanted: Measured, wish: Floats, q: Floats, v: int, step: float, s: int
) -> Floats:
    """Squares of the errors of a side's wrist, palm, elbow and joints, each in its unit."""
    moved = q.copy()
    moved[0, v] += step
    seen = measure_clip(Clip(np.zeros(1), moved, (), np.zeros((1, 0))), rig)
    turn = rotation_vectors(wanted.palms[0, s] @ seen.palms[0, s].T)
    joints = [rig.coordinates.index[name.format(S="LR"[s])] for name in retargeting.ARM]
    return np.array([
        (((seen.wrists - wanted.wrists)[0, s] / 0.004) ** 2).sum(),
        ((turn / np.radians(1.0)) ** 2).sum(),
        (((seen.elbows - wanted.elbows)[0, s] / 0.02) ** 2).sum(),
        (((moved - wish)[0, joints] / np.radians(60.0)) ** 2).sum(),
    ])  # fmt: skip


def test_the_body_itself_is_found_again_from_far_away(signer: Rig) -> None:
    """The steps grow where they gain: after few of them next to nothing is off."""
    source = measure_clip(posed(signer, 1, {
        "arm_{}.flexion": 60, "arm_{}.abduction": 50, "arm_{}.rotation": 50,
        "f_arm_{}.flexion": 120, "f_arm_{}.pronation": 80, "palm_{}.flexion": -30,
    }), signer)  # fmt: skip
    idle = np.array(signer.coordinates.idle)[None]
    arms = retargeting._Arms(signer, source, idle)
    wrists, palms = arms.off(arms.solved(idle, idle))
    assert wrists.max() < 0.0002
    assert np.degrees(palms).max() < 0.03
    made = retarget(source, signer)
    assert made.wrist_m.max() < 0.0002


FAR: dict[str, dict[str, float]] = {
    "aside": {
        "clav_{}.elevation": 23, "arm_{}.flexion": 7, "arm_{}.abduction": 109,
        "arm_{}.rotation": 71, "f_arm_{}.flexion": 42, "palm_{}.deviation": 14,
    },
    "bent": {
        "clav_{}.elevation": 21, "clav_{}.protraction": -10, "arm_{}.flexion": 10,
        "arm_{}.abduction": 110, "arm_{}.rotation": 3, "f_arm_{}.flexion": 122,
        "f_arm_{}.pronation": 14, "palm_{}.flexion": 40, "palm_{}.deviation": -19,
    },
}  # fmt: skip
"""Degrees of arms that are raised, so that not every step on the way from rest gains."""


@pytest.mark.parametrize("arm", FAR)
@pytest.mark.parametrize("sides", ["LR", "R"])
def test_where_a_step_goes_too_far_shorter_ones_are_tried(
    signer: Rig, arm: str, sides: str
) -> None:
    """Of one arm too, while the other is at its place from the start."""
    clip = posed(signer, 1, FAR[arm])
    idle = np.array(signer.coordinates.idle)[None]
    q = idle.copy()
    for side in sides:
        columns = [signer.coordinates.index[name.format(S=side)] for name in retargeting.ARM]
        q[:, columns] = clip.coordinates[:, columns]
    arms = retargeting._Arms(signer, measure_clip(replace(clip, coordinates=q), signer), idle)
    wrists, _ = arms.off(arms.solved(idle, idle))
    assert wrists.max() < 0.02


def test_forearms_are_tried_turned_out_and_in(signer: Rig) -> None:
    clip = posed(signer, 2, {"f_arm_{}.flexion": 60})
    arms = retargeting._Arms(signer, measure_clip(clip, signer), clip.coordinates)
    given, *others = arms.starts(clip.coordinates)
    np.testing.assert_array_equal(given, clip.coordinates)
    turned = arms.columns[:, retargeting.PRONATION]
    lower, upper = signer.coordinates.lower[turned], signer.coordinates.upper[turned]
    shares = [(start[:, turned] - lower) / (upper - lower) for start in others]
    assert len(shares) == 2
    assert ((shares[0] > 0.1) & (shares[0] < 0.3)).all()
    assert ((shares[1] > 0.7) & (shares[1] < 0.9)).all()
    for start in others:
        rest = np.delete(start, turned, axis=1)
        np.testing.assert_array_equal(rest, np.delete(clip.coordinates, turned, axis=1))


def test_errors_are_told_of_each_hand(signer: Rig) -> None:
    """The left wrist is 3 cm off, and the right palm by half a right angle."""
    clip = posed(signer, 3, {"f_arm_{}.flexion": 60})
    source = measure_clip(clip, signer)
    moved, palms = source.wrists.copy(), source.palms.copy()
    moved[:, 0, 1] += 0.03
    palms[:, 1] = about_axis(0, np.radians(45.0)) @ palms[:, 1]
    away = replace(source, wrists=moved, palms=palms)
    wrists, turns = retargeting._Arms(signer, away, clip.coordinates).off(clip.coordinates)
    np.testing.assert_allclose(wrists, np.tile([0.03, 0.0], (3, 1)), atol=1e-9)
    np.testing.assert_allclose(np.degrees(turns), np.tile([0.0, 45.0], (3, 1)), atol=1e-5)


def test_face_units_that_a_body_has_are_kept_with_their_weights(signer: Rig) -> None:
    source = measure_clip(posed(signer, 2, {}), signer)
    one, two = sorted(signer.units)[:2]
    weights = np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]])
    made = retarget(replace(source, units=((one, "no unit of it", two), weights)), signer).clip
    assert made.units == (one, two)
    np.testing.assert_array_equal(made.unit_weights, weights[:, [0, 2]])


@pytest.mark.parametrize(("gain", "changes"), [(3.7, False), (4.2, True)])
def test_a_degree_of_haste_weighs_as_one(signer: Rig, gain: float, changes: bool) -> None:
    """Two degrees in one frame cost 4: an arm changes to another way where it gains more."""
    still = posed(signer, 2, {"f_arm_{}.flexion": 60})
    arms = retargeting._Arms(signer, measure_clip(still, signer), still.coordinates)
    one, other = still.coordinates, still.coordinates.copy()
    turned = arms.columns[:, retargeting.PRONATION]
    other[:, turned] += np.radians(2.0)
    costs = [np.array([[0.0, 0.0], [gain, gain]]), np.array([[100.0, 100.0], [0.0, 0.0]])]
    asked = iter(costs)
    arms._residual = lambda q, wish: (next(asked), q)  # type: ignore[method-assign]
    found = arms.steadiest([one, other], one)
    moved = np.degrees(found[1, turned] - found[0, turned])
    assert moved == pytest.approx([2.0, 2.0] if changes else [0.0, 0.0])


def test_what_is_measured_of_a_clip_holds_no_angles_of_arms_and_fingers(signer: Rig) -> None:
    """Those are another body's own; trunk, head and eyes turn as they did."""
    names = set(measure_clip(posed(signer, 1, {}), signer).coordinates)
    bones = {name.split(".")[0] for name in names}
    assert bones == {"back_1", "back_2", "neck", "head", "eye_L", "eye_R", "jaw"} & bones
    assert {"back_1", "back_2", "neck", "head", "eye_L", "eye_R"} <= bones


def test_a_figure_stands_straight_whichever_axis_of_its_file_is_up() -> None:
    """Up may be against an axis; the head is 10° ahead of the hips."""
    upright = stick_figure(2, ("OFFSET 0 60 0", f"OFFSET 0 60 {60 * np.tan(np.radians(10)):.6f}"))
    head, motion = upright.split("\nMOTION\n")
    words, turned = head.split(), []
    while words:
        turned.append(words.pop(0))
        if turned[-1] == "OFFSET":  # half a turn about the axis ahead
            x, y, z = (float(words.pop(0)) for _ in range(3))
            turned += [f"{-x:.9f}", f"{-y:.9f}", f"{z:.9f}"]
    first, second, *rows = motion.splitlines()
    against = [" ".join(str(-float(number)) for number in row.split()) for row in rows]
    other = "\n".join([" ".join(turned), "MOTION", first, second, *against, ""])
    found = [measure_recording(parse_bvh(text, "cm")) for text in (upright, other)]
    for name in ("palms", "wrists", "elbows"):
        np.testing.assert_allclose(getattr(found[1], name), getattr(found[0], name), atol=1e-9)


def test_a_step_turns_no_joint_by_more_than_half_a_radian(signer: Rig) -> None:
    """Either way: what is linear near a posture tells little farther away."""
    source = measure_clip(posed(signer, 1, {
        "arm_{}.flexion": 60, "arm_{}.rotation": 50, "f_arm_{}.flexion": 120,
        "f_arm_{}.pronation": 80, "palm_{}.flexion": -30,
    }), signer)  # fmt: skip
    idle = np.array(signer.coordinates.idle)[None]
    arms = retargeting._Arms(signer, source, idle)
    for start in (idle, arms.solved(idle, idle)):
        away = replace(source, wrists=source.wrists[:, ::-1] * [-1.0, 1.0, 1.0] + [0.0, 0.3, -0.2])
        there = retargeting._Arms(signer, away, idle)
        _, r = there._residual(start, idle)
        turned = (there._step(start, idle, r, np.full((1, 2), 1e-8)) - start)[0]
        assert np.abs(turned).max() <= 0.5 + 1e-12


@pytest.mark.parametrize("name", ["arm_m", "wrists", "elbows", "palms"])
def test_a_source_without_numbers_is_refused(signer: Rig, name: str) -> None:
    """Arms without an end cannot be compared, whatever else is known of the movement."""
    source = measure_clip(posed(signer, 2, {}), signer)
    with pytest.raises(ValueError, match=name):
        replace(source, **{name: np.full_like(getattr(source, name), np.inf)})
