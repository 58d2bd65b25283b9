"""Bones, limits and capsules in words: no name of a rig's is among them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from azee_rig.rig import Rig
from azee_solver.body_words import bone_words, capsule_words, limit_words, listed


@pytest.mark.parametrize(
    ("bone", "words"),
    [
        ("f_arm_R", "the right forearm"),
        ("arm_L", "the left upper arm"),
        ("palm_R", "the right hand"),
        ("back_1", "the lower back"),
        ("back_2", "the upper back"),
        ("head", "the head"),
        ("eye_L", "the left eye"),
        ("index_L_2", "the second joint of the left index finger"),
        ("thumb_R_1", "the first joint of the right thumb"),
    ],
)
def test_bones_are_called_what_people_call_them(bone: str, words: str) -> None:
    assert bone_words(bone) == words


@pytest.mark.parametrize(
    ("capsule", "words"),
    [
        ("trunk_3", "the trunk"),
        ("trunk", "the trunk"),
        ("skull", "the head"),
        ("jaw_L", "the left jaw"),
        ("upper_arm_R", "the right upper arm"),
        ("hand_L_radial", "the left hand"),
        ("little_R_3", "the right little finger"),
    ],
)
def test_capsules_are_called_by_what_they_hold(capsule: str, words: str) -> None:
    assert capsule_words(capsule) == words


@pytest.mark.parametrize(
    ("name", "degrees", "upper", "words"),
    [
        ("f_arm_R.pronation", 85, True, "the right forearm cannot turn further: it is at 85° of"),
        ("f_arm_R.pronation", -90, False, "it is at 90° of supination and needs 2.5° more"),
        ("f_arm_L.flexion", 0, False, "it is at 0° of extension and needs 2.5° more"),
        ("head.axial", 40, True, "the head cannot turn further: it is at 40° to the left and"),
        ("neck.lateral", -25, False, "the neck cannot bend further: it is at 25° to the right and"),
        ("eye_R.pitch", -25, False, "the right eye cannot turn further: it is at 25° down and"),
        ("f_arm_L.flexion", 0.4, False, "cannot bend further: it is at 0° of extension and needs"),
    ],
)
def test_a_limit_is_told_in_degrees_and_by_direction(
    name: str, degrees: float, upper: bool, words: str
) -> None:
    told = limit_words(name, math.radians(degrees), upper=upper, more_rad=math.radians(2.5))
    assert words in told
    assert told.endswith(" and needs 2.5° more")


@pytest.mark.parametrize(
    ("name", "degrees", "upper", "words"),
    [
        ("f_arm_L.flexion", 9, False, "the left forearm cannot bend less: it is at 9° of flexion"),
        ("head.axial", 5, False, "the head cannot turn less: it is at 5° to the left"),
        ("eye_R.pitch", -3, True, "the right eye cannot turn less: it is at 3° down"),
    ],
)
def test_beyond_a_limit_on_the_other_side_of_zero_a_joint_moves_less(
    name: str, degrees: float, upper: bool, words: str
) -> None:
    told = limit_words(name, math.radians(degrees), upper=upper, more_rad=math.radians(2.5))
    assert told == f"{words} and needs 2.5° less"


def test_directions_in_words_are_those_of_the_body(signer: Rig) -> None:
    """Left is +x and up +y in the signer's frame; `to the left` has the face look that way."""
    zero = dict.fromkeys(signer.coordinates.names, 0.0)
    for name, axis in (("head.axial", 0), ("neck.axial", 0), ("eye_L.yaw", 0), ("eye_L.pitch", 1)):
        bone = "head" if axis == 0 and not name.startswith("eye") else "eye_L"
        turned = signer.chain.frames(_vector(signer, {**zero, name: 0.3}))
        still = signer.chain.frames(_vector(signer, zero))
        node = signer.bones[bone].node
        forward = turned.rotations[node] @ still.rotations[node].T @ (0.0, 0.0, 1.0)
        assert forward[axis] > 0.2
        assert ("to the left", "up")[axis] in limit_words(name, 0.3, upper=True, more_rad=0.1)


def _vector(rig: Rig, q: dict[str, float]) -> NDArray[np.float64]:
    return np.array([q[name] for name in rig.coordinates.names])


@pytest.mark.parametrize("upper", [True, False])
def test_every_joint_of_the_signer_has_words(signer: Rig, upper: bool) -> None:
    told = {limit_words(n, 0.1, upper=upper, more_rad=0.1) for n in signer.coordinates.names}
    assert len(told) == len(signer.coordinates)
    assert not [text for text in told if "_" in text or "rad" in text]
    named = {capsule_words(name) for name in signer.capsules.names}
    assert not [text for text in named if "_" in text or not text.startswith("the ")]


def test_parts_are_listed() -> None:
    assert [listed(list("abc"[:n])) for n in range(4)] == ["", "a", "a and b", "a, b and c"]
