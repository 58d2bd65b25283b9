"""Fingers and thumbs are on another body as they were: on the same body exactly."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from stick_signer import FINGERS, bent, stick_signer

from azee.clip.bvh import parse_bvh
from azee.clip.clip import Clip
from azee.clip.digits import DIGITS, SIDES, Digit, DigitFit, bend, thumb_turns
from azee.clip.retarget import Retargeted, retarget
from azee.clip.retarget_source import Measured, measure_clip, measure_recording
from azee.export.formats.bvh import write_bvh
from azee.export.formats.euler import EulerZXY
from azee_rig.load import load_rig
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
SAME_MM = 0.01
"""What files of millionths of a degree leave."""
ALL = ("thumb", "index", "middle", "ring", "little")
THEIRS = {
    "finger1_": "Thumb", "finger2_": "Index", "finger3_": "Middle", "finger4_": "Ring",
    "finger5_": "Pinky", "wrist_": "Hand_", "lowerarm01_": "LowerArm_", "upperarm01_": "UpperArm_",
    "spine0": "Back",
}  # fmt: skip


def palm_tips(rig: Rig, q: Floats) -> dict[str, Floats]:
    """Finger tips (T, 3) in the frame of their palm, metres, by digit and side."""
    at = rig.chain.frames(q)
    found = {}
    for side in SIDES:
        palm = rig.bones[f"palm_{side}"].node
        for digit in DIGITS:
            tip = rig.sites[f"{digit[0].upper()}_TIP_{side}"].point(at)
            found[f"{digit}_{side}"] = np.einsum(
                "tba,tb->ta", at.rotations[:, palm], tip - at.positions[:, palm]
            )
    return found


def hand_columns(rig: Rig) -> list[int]:
    return [i for i, n in enumerate(rig.coordinates.names) if n.startswith(DIGITS)]


def on_the_same_body(rig: Rig, hands: Floats, folder: Path) -> tuple[Retargeted, float]:
    """Retarget hands (T, H) to their own body by way of BVH under other names; mm off at worst."""
    c = rig.coordinates
    q = np.tile(c.idle, (len(hands), 1))
    q[:, hand_columns(rig)] = hands
    write_bvh(Clip(np.arange(len(q)) / 30, q, (), np.zeros((len(q), 0))), rig, folder / "own.bvh")
    text = (folder / "own.bvh").read_text(encoding="ascii")
    for ours, other in THEIRS.items():
        text = text.replace(f"JOINT {ours}", f"JOINT {other}")
    made = retarget(measure_recording(parse_bvh(text)), rig)
    there, here = palm_tips(rig, q), palm_tips(rig, made.clip.coordinates)
    assert sorted(there) == sorted(here) == sorted(f"{d}_{s}" for d in ALL for s in "LR")
    off = [np.linalg.norm(there[name] - here[name], axis=-1).max() for name in there]
    return made, 1e3 * float(max(off))


@pytest.mark.parametrize("body", ["signer", "child", "heavy"])
def test_under_other_joint_names_every_finger_of_the_same_body_is_where_it_was(
    body: str, tmp_path: Path
) -> None:
    rig = load_rig(body)
    c, columns = rig.coordinates, hand_columns(rig)
    random = np.random.default_rng(4)
    hands = random.uniform(c.lower[columns], c.upper[columns], (30, len(columns)))
    made, off_mm = on_the_same_body(rig, hands, tmp_path)
    assert off_mm < SAME_MM
    # Nothing is smeared: each frame has its own hands, at thirty a second.
    assert np.degrees(np.abs(made.clip.coordinates[:, columns] - hands).max()) < 0.01
    assert max(float(off.max()) for off in made.tip_m.values()) < 1e-5
    assert "finger tips are within 3 mm of where they were in the palm" in made.kept(rig)


@pytest.mark.parametrize("posture", ["bind", "idle", "lower", "upper", "zero"])
def test_hands_that_never_move_are_where_they_were(
    signer: Rig, posture: str, tmp_path: Path
) -> None:
    """Where no joint turns nothing tells about what a thumb bends, but where its bones point."""
    c = signer.coordinates
    columns = hand_columns(signer)
    still = np.zeros(len(columns)) if posture == "zero" else getattr(c, posture)[columns]
    _, off_mm = on_the_same_body(signer, np.tile(still, (3, 1)), tmp_path)
    assert off_mm < SAME_MM


@given(st.integers(0, 10**6))
@settings(max_examples=20)
def test_the_bones_of_a_digit_are_those_of_the_chain(seed: int) -> None:
    """The closed form is the chain's forward kinematics, and its inverse gives angles back."""
    rig = load_rig("child")
    c = rig.coordinates
    random = np.random.default_rng(seed)
    q = random.uniform(c.lower, c.upper, (4, len(c)))
    at = rig.chain.frames(q)
    for side in "LR":
        palm = at.rotations[:, rig.bones[f"palm_{side}"].node]
        for digit in ALL:
            fit = DigitFit(rig, f"{digit}_{side}")
            columns = [c.index[name] for name in fit.coordinates]
            nodes = [rig.bones[f"{digit}_{side}_{k}"].node for k in (1, 2, 3)]
            wanted = np.swapaxes(palm, 1, 2)[:, None] @ at.rotations[:, nodes]
            np.testing.assert_allclose(fit.posed(q[:, columns]), wanted, atol=1e-12)
            found, off = fit.angles(Digit(fit.name, wanted))
            np.testing.assert_allclose(found, q[:, columns], atol=1e-7)
            assert off.max() < 1e-8


def test_what_the_limits_take_is_told_by_digit(signer: Rig) -> None:
    """An index bent beyond its limit, 90°: the tip is off by what the chain says."""
    c = signer.coordinates
    fit = DigitFit(signer, "index_R")
    columns = [c.index[name] for name in fit.coordinates]
    asked = np.tile(c.idle[columns], (2, 1))
    asked[1, 1] = np.radians(120.0)
    found, off = fit.angles(Digit("index_R", fit.posed(asked)))
    assert np.degrees(found[1, 1]) == pytest.approx(90.0)
    q = np.tile(c.idle, (3, 1))
    q[1:, columns] = asked[1], found[1]
    tips = palm_tips(signer, q)["index_R"]
    assert off[0] == pytest.approx(0.0, abs=1e-9)
    # A site near a joint is fitted to the skin: within a few millimetres of its bone's.
    assert off[1] == pytest.approx(float(np.linalg.norm(tips[1] - tips[2])), abs=5e-3)
    assert off[1] > 0.03
    zeros = np.zeros((2, 2))
    clip = Clip(np.arange(2.0), q[:2], (), np.zeros((2, 0)))
    made = Retargeted(clip, zeros, zeros, {"index_R": off, "index_L": off / 2, "thumb_L": 0 * off})
    mm = 1e3 * off[1]
    assert made.kept(signer).endswith(
        f"finger tips are off in the palm by up to: index {mm:.0f} mm, thumb 0 mm"
    )
    assert replace(made, tip_m={}).kept(signer).endswith("; no finger is carried over")
    assert made.report(signer)["digits"]["index_R"]["tip_m"] == {
        "mean": pytest.approx(off[1] / 2), "max": off[1]
    }  # fmt: skip


FIST = {f"{finger}_{k}": angle for finger in FINGERS for k, angle in ((1, 70), (2, 60), (3, 40))}
OPEN: dict[str, float] = {}


def measured(text: str) -> Measured:
    return measure_recording(parse_bvh(text))


def degrees(source: Measured, rig: Rig) -> dict[str, Floats]:
    """Coordinates of all digits on a body, (T,) degrees by name."""
    found: dict[str, Floats] = {}
    for digit in source.digits:
        fit = DigitFit(rig, digit.name)
        angles, _ = fit.angles(digit)
        found |= dict(zip(fit.coordinates, np.degrees(angles).T, strict=True))
    return found


@pytest.mark.parametrize("phalanges", [2, 3])
def test_a_fist_is_a_fist(signer: Rig, phalanges: int) -> None:
    bends = {k: v for k, v in FIST.items() if int(k[-1]) <= phalanges}
    source = measured(stick_signer([bent(OPEN), bent(bends)], phalanges=phalanges))
    found = degrees(source, signer)
    assert len(source.digits) == 10
    for side in SIDES:
        for finger in FINGERS:
            one, two, three = (found[f"{finger}_{side}_{k}.flexion"] for k in (1, 2, 3))
            np.testing.assert_allclose(one, [0, 70], atol=1e-3)
            # Two joints share what the second bends by: 60° are 0.76 and 0.51 of it.
            np.testing.assert_allclose(two, [0, 60 if phalanges == 3 else 45.6], atol=1e-3)
            np.testing.assert_allclose(three, [0, 40 if phalanges == 3 else 30.6], atol=1e-3)
    shared = [note for note in source.notes if "two joints" in note]
    assert len(shared) == (phalanges == 2)


def test_a_joint_beyond_the_last_of_a_digit_tells_its_end_as_an_end_site_does() -> None:
    text = stick_signer([bent(OPEN), bent(FIST)])
    numbers = iter(range(99))
    joints = re.sub(
        r"End Site \{ (OFFSET [^}]+) \}",
        lambda m: f"JOINT pad{next(numbers)} {{ {m[1]} CHANNELS 0 }}",
        text,
    )
    plain, other = (measured(written).digits for written in (text, joints))
    assert len(plain) == len(other) == 10
    for one, same in zip(plain, other, strict=True):
        assert one.name == same.name
        np.testing.assert_allclose(same.frames, one.frames, atol=1e-9)


def test_trunk_and_head_are_bent_alike_however_the_whole_body_is_turned() -> None:
    bends = {"chest": (4.0, 10.0, -6.0), "head": (0.0, -8.0, 12.0)}
    one, other = {**bends}, {**bends, "hips": (15.0, 20.0, 30.0)}
    found = measured(stick_signer([bent(OPEN), one, other])).coordinates
    bones = ("back_1", "back_2", "neck", "head")
    assert found.keys() == {f"{b}.{way}" for b in bones for way in ("flexion", "axial", "lateral")}
    for name, angles in found.items():
        assert abs(angles[1] - angles[0]) > np.radians(0.3), name
        assert angles[2] == pytest.approx(angles[1], abs=1e-6), name


@pytest.mark.parametrize("lacking", ["", "middle", "ring", "middle|ring|little"])
def test_a_palm_points_to_its_middle_knuckle_or_to_the_mean_of_those_there_are(
    lacking: str,
) -> None:
    text = stick_signer([bent(OPEN)] * 2)
    if lacking:
        text = re.sub(rf"JOINT ({lacking})", r"JOINT bump\1", text)
    there = {f: z for f, z in FINGERS.items() if f not in lacking.split("|")}
    aside = there.get("middle", float(np.mean([*there.values()])))
    if len(there) < 2:
        aside = 0.0  # as the forearm points
    for s, palm in zip((1.0, -1.0), np.swapaxes(measured(text).palms, 0, 1), strict=True):
        along = np.array([9.0 * s, 0.0, aside]) / np.hypot(9.0, aside)
        np.testing.assert_allclose(palm[:, :, 1], [along] * 2, atol=1e-6)
        np.testing.assert_allclose(palm[:, :, 2], [[0.0, -1.0, 0.0]] * 2, atol=0.1)


def test_digits_without_joints_to_bend_are_told_once(signer: Rig) -> None:
    text = stick_signer([bent(OPEN), bent({"index_1": 40})])
    text = re.sub(r"JOINT (thumb|little)", r"JOINT bump\1", text)
    source = measured(text)
    assert [note for note in source.notes if "left at rest" in note] == [
        "without joints to bend, and left at rest: thumb L, little L, thumb R, little R"
    ]
    made = retarget(source, signer)
    column = signer.coordinates.index["little_L_1.flexion"]
    assert (made.clip.coordinates[:, column] == signer.coordinates.idle[column]).all()


def test_a_last_joint_that_is_turned_half_round_points_the_other_way(signer: Rig) -> None:
    """As in files of one maker, whose right hands have their last joints the other way round."""
    frames = [bent(OPEN), bent(FIST)]
    for turns, rest in zip(frames, (0.0, 40.0), strict=True):
        turns["index_R_3"] = (180.0 + rest, 0.0, 0.0)
    found = degrees(measured(stick_signer(frames)), signer)
    np.testing.assert_allclose(found["index_R_3.flexion"], [0, 40], atol=1e-3)


@pytest.mark.parametrize("side", SIDES)
def test_a_thumb_bends_about_the_axis_that_it_turns_about(signer: Rig, side: str) -> None:
    """Its roll comes of its outer joints' turns, whatever they were at the first frame."""
    s = 1.0 if side == "L" else -1.0
    frames = [
        {f"thumb_{side}_2": (0.0, 0.0, s * a), f"thumb_{side}_3": (0.0, 0.0, s * a / 2)}
        for a in (10.0, 30.0, 50.0)
    ]
    # About the vertical, the palm facing down: the thumb bends across the palm.
    source = measured(stick_signer(frames))
    thumb = next(d for d in source.digits if d.name == f"thumb_{side}")
    assert thumb.ways is None
    np.testing.assert_allclose(np.abs(thumb.frames[:, 0, :, 0]), [[0, 0, 1]] * 3, atol=1e-6)
    found = degrees(source, signer)
    np.testing.assert_allclose(found[f"thumb_{side}_2.flexion"], [10, 30, 50], atol=1e-3)
    np.testing.assert_allclose(found[f"thumb_{side}_3.flexion"], [5, 15, 25], atol=1e-3)


def thumb_turning(*axes: Floats) -> Digit:
    """A left thumb whose outer joints turn about given axes, the same where there is one."""
    frames = []
    for angle in (0.0, 0.3, 0.6):
        half = angle / 2.0
        turns = {}
        for k, axis in zip((2, 3), (*axes, *axes), strict=False):
            q = np.r_[np.cos(half), np.sin(half) * axis]
            z, x, y = np.degrees(EulerZXY.from_quaternions(q[None]).angles[0])
            turns[f"thumb_L_{k}"] = (float(z), float(x), float(y))
        frames.append(turns)
    (thumb,) = (d for d in measured(stick_signer(frames)).digits if d.name == "thumb_L")
    return thumb


@pytest.mark.parametrize(
    ("roll_deg", "believed"), [(0, True), (-60, True), (40, True), (58, False), (-110, False)]
)
def test_an_axis_that_no_thumb_bends_about_tells_no_roll(roll_deg: float, believed: bool) -> None:
    """The thumb points ahead and sideways; its roll counts from an axis that is vertical."""
    along = np.array([2.5, 0.0, 2.0]) / np.hypot(2.5, 2.0)
    up = np.array([0.0, 1.0, 0.0])
    angle = np.radians(roll_deg)
    thumb = thumb_turning(np.cos(angle) * up + np.sin(angle) * np.cross(along, up))
    assert (thumb.ways is None) == believed
    if believed:
        roll = thumb_turns(thumb.frames[:1, 0], 1.0)[2]
        assert np.degrees(roll) == pytest.approx(roll_deg, abs=1e-6)


def test_joints_that_are_no_hinges_tell_no_roll(signer: Rig) -> None:
    thumb = thumb_turning(np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    assert thumb.ways is not None
    found, _ = DigitFit(signer, "thumb_L").angles(thumb)
    assert np.degrees(found[0, 2]) == pytest.approx(-25.6, abs=10)
    last = bend(thumb.frames[:, 1], thumb.frames[:, 2])
    assert np.degrees(last).max() > 10
    np.testing.assert_allclose(found[:, 4], last, atol=1e-9)


def test_a_clip_of_one_rig_keeps_its_angles_on_another(signer: Rig) -> None:
    c, other = signer.coordinates, load_rig("game")
    columns = hand_columns(signer)
    random = np.random.default_rng(6)
    q = np.tile(c.idle, (5, 1))
    q[:, columns] = random.uniform(c.lower[columns], c.upper[columns], (5, len(columns)))
    made = retarget(measure_clip(Clip(np.arange(5) / 30, q, (), np.zeros((5, 0))), signer), other)
    assert sum(not c.names[v].endswith("roll") for v in columns) == 2 * 20
    for v in columns:
        name = c.names[v]
        if not name.endswith("roll"):  # whose limits are each body's own
            w = other.coordinates.index[name]
            assert np.degrees(np.abs(made.clip.coordinates[:, w] - q[:, v]).max()) < 0.01, name


def test_a_digit_of_which_nothing_tells_the_end_goes_straight_on() -> None:
    """Its last joint has neither an end site nor a joint beyond it."""
    text = stick_signer([bent(OPEN), bent({"index_1": 40.0, "index_2": 30.0})])
    bare = re.sub(r"End Site \{ OFFSET [^}]+ \}", "", text)
    assert bare != text
    plain, other = (
        {digit.name: digit for digit in measured(written).digits} for written in (text, bare)
    )
    assert other.keys() == plain.keys()
    one, same = plain["index_L"], other["index_L"]
    np.testing.assert_allclose(same.frames[:, :2], one.frames[:, :2], atol=1e-9)
    assert same.rest_bend is not None
