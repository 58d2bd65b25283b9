"""Joints of many makers' BVH are told by their names and places, both sides alike."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from stick_signer import FINGERS, bent, stick_signer

from azee.clip.bvh import parse_bvh
from azee.clip.digits import DigitFit
from azee.clip.retarget_source import Measured, measure_recording
from azee_rig.importing.names import read_name
from azee_rig.rig import Rig

FIST = {f"{finger}_{k}": angle for finger in FINGERS for k, angle in ((1, 70), (2, 60), (3, 40))}


def motive(joint: str) -> str:
    """OptiTrack Motive's names, such as `LUArm` and `LFArm`."""
    words = {
        "hips": "Hip", "spine": "Ab", "chest": "Chest", "neck": "Neck", "head": "Head",
        "clav": "Shoulder", "arm": "UArm", "f_arm": "FArm", "palm": "Hand", "thigh": "Thigh",
        "calf": "Shin", "foot": "Foot", "little": "Pinky",
    }  # fmt: skip
    return _sided(joint, words, "{side}{word}{number}", {"L": "L", "R": "R"})


def xsens(joint: str) -> str:
    """Xsens' names: fingers are counted, their bones abbreviated."""
    finger, _, k = joint.rpartition("_")
    part, _, side = finger.rpartition("_")
    ordinals = {"thumb": "First", "index": "Second", "middle": "Third", "ring": "Fourth"}
    ordinals["little"] = "Fifth"
    if part in ordinals:
        bones = ("MC", "PP", "DP") if part == "thumb" else ("PP", "MP", "DP")
        return f"{'Left' if side == 'L' else 'Right'}{ordinals[part]}{bones[int(k) - 1]}"
    words = {
        "hips": "Hips", "spine": "Chest", "chest": "Chest4", "neck": "Neck", "head": "Head",
        "clav": "Collar", "arm": "Shoulder", "f_arm": "Elbow", "palm": "Wrist", "thigh": "Hip",
        "calf": "Knee", "foot": "Ankle",
    }  # fmt: skip
    return _sided(joint, words, "{side}{word}{number}", {"L": "Left", "R": "Right"})


def makehuman(joint: str) -> str:
    """Names of MakeHuman's older rigs, `UpArm_L`."""
    words = {
        "hips": "Root", "spine": "Spine1", "chest": "Spine2", "neck": "Neck", "head": "Head",
        "clav": "Clavicle", "arm": "UpArm", "f_arm": "LoArm", "palm": "Hand", "thigh": "UpLeg",
        "calf": "LoLeg", "foot": "Foot", "little": "Pinky",
    }  # fmt: skip
    return _sided(joint, words, "{word}{number}_{side}", {"L": "L", "R": "R"})


def _sided(joint: str, words: dict[str, str], form: str, sides: dict[str, str]) -> str:
    parts = joint.split("_")
    number = parts.pop() if parts[-1].isdigit() else ""
    side = sides[parts.pop()] if parts[-1] in sides else ""
    part = "_".join(parts)
    word = words.get(part, part.capitalize())
    return form.format(side=side, word=word, number=number) if side else word


def check(source: Measured, rig: Rig) -> None:
    """Wrists 70 cm to the sides of the shoulders' middle; a fist in the last frame."""
    assert source.arm_m == pytest.approx(0.53, abs=1e-6)
    np.testing.assert_allclose(source.wrists[0], [[0.7, 0, 0], [-0.7, 0, 0]], atol=1e-6)
    assert len(source.digits) == 10
    for digit in source.digits:
        angles, off = DigitFit(rig, digit.name).angles(digit)
        if not digit.name.startswith("thumb"):
            np.testing.assert_allclose(np.degrees(angles[-1, 1:]), [70, 60, 40], atol=1e-3)
            assert off.max() < 2e-3


@pytest.mark.parametrize("name", [motive, xsens, makehuman])
def test_names_of_other_makers(name: Callable[[str], str], signer: Rig) -> None:
    text = stick_signer([bent({}), bent(FIST)], name)
    check(measure_recording(parse_bvh(text)), signer)


def test_metacarpals_of_xsens_are_no_phalanges(signer: Rig) -> None:
    between = {
        f"{finger}_{side}_1": [
            (f"{'Left' if side == 'L' else 'Right'}{ordinal}MC", (2.0 * s, 0.0, 0.3 * z))
        ]
        for side, s in (("L", 1), ("R", -1))
        for (finger, z), ordinal in zip(
            FINGERS.items(), ("Second", "Third", "Fourth", "Fifth"), strict=True
        )
    }
    text = stick_signer([bent({}), bent(FIST)], xsens, between=between)
    assert "LeftSecondMC" in text
    check(measure_recording(parse_bvh(text)), signer)


def test_connectors_at_one_point_of_the_palm_are_no_phalanges(signer: Rig) -> None:
    """MakeHuman's exporter ends the hand's bone at one knuckle and goes back from there."""
    between = {
        f"{digit}_{side}_1": [
            (f"__{'Pinky' if digit == 'little' else digit.capitalize()}1_{side}", (9.0 * s, 0, 1.0))
        ]
        for side, s in (("L", 1), ("R", -1))
        for digit in ("thumb", "index", "ring", "little")
    }
    text = stick_signer([bent({}), bent(FIST)], makehuman, between=between)
    assert text.count("__") == 8
    source = measure_recording(parse_bvh(text))
    check(source, signer)
    thumb = next(d for d in source.digits if d.name == "thumb_L")
    assert thumb.ways is not None
    # Its bones point sideways and ahead, as they are written: none goes back into the palm.
    np.testing.assert_allclose(thumb.ways[0], thumb.ways[0, :1].repeat(2, axis=0), atol=1e-6)


def test_joints_of_one_name_are_told_by_where_they_stand(signer: Rig) -> None:
    def name(joint: str) -> str:
        return "UpArm_L" if joint == "f_arm_L" else makehuman(joint)

    source = measure_recording(parse_bvh(stick_signer([bent({}), bent(FIST)], name)))
    assert "2 joints are called `UpArm_L`" in source.notes[0]
    check(source, signer)


def test_arms_of_different_length_are_told() -> None:
    text = stick_signer([bent({})]).replace(
        "forearm_R { OFFSET -28 0 0", "forearm_R { OFFSET -13 0 0"
    )
    source = measure_recording(parse_bvh(text))
    assert "upper arms are 28 cm (L) and 13 cm (R) long: joints may be misread" in source.notes
    assert not any("misread" in n for n in measure_recording(parse_bvh(stick_signer([{}]))).notes)


@pytest.mark.parametrize(
    ("name", "kind", "side"),
    [
        ("LUArm", "arm", "L"), ("RUArm", "arm", "R"), ("LFArm", "f_arm", "L"),
        ("Ted:RFArm", "f_arm", "R"), ("LF_Arm", "arm", "L"), ("lf_hand", "palm", "L"),
        ("Ab", "spine", ""), ("FirstSpine", "", ""), ("LeftFirstMC", "finger", "L"),
    ],
)  # fmt: skip
def test_what_a_name_says(name: str, kind: str, side: str) -> None:
    read = read_name(name)
    assert (read.kind, read.side) == (kind, side)


def test_counted_fingers() -> None:
    """By their bones, as Xsens' segments, or by their joints."""
    for bone in ("PP", "MCP"):
        found = [read_name(f"Right{n}{bone}") for n in ("First", "Second", "Fifth")]
        assert [(read.kind, read.digit) for read in found] == [
            ("finger", "1"), ("finger", "2"), ("finger", "5")
        ]  # fmt: skip
        assert not any(read.metacarpal for read in found)
    for bone in ("MC", "CMC"):
        assert read_name(f"LeftSecond{bone}").metacarpal
