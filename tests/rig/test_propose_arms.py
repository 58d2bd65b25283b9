"""Proposals of arms: where they begin and bend, by names or without."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from body_families import Body, make_body
from joint_names import FAMILIES
from partial_bodies import FINGERS, inserted, part_of, renamed, with_joints, with_names

from azee_rig.importing.bone_map import BoneMap
from azee_rig.importing.propose import propose
from azee_rig.importing.skeleton_tree import Tree


@pytest.fixture(scope="module")
def body() -> Body:
    return make_body(FAMILIES["ready-player-me"])


@pytest.mark.parametrize(("side", "other"), [("Left", "Right"), ("Right", "Left")])
def test_a_body_of_one_arm_has_what_is_there(body: Body, side: str, other: str) -> None:
    """Its chest, whatever it is called, is where the arm leaves the way to the head."""
    found = part_of(with_names(body, {"Spine2": "Blob"}), f"{other} Leg Foot Eye {FINGERS}", "Hips")
    assert found.bones == {
        "back_1": ("Spine", "Spine1"), "back_2": ("Blob",), "neck": ("Neck",), "head": ("Head",),
        f"clav_{side[0]}": (f"{side}Shoulder",), f"arm_{side[0]}": (f"{side}Arm",),
        f"f_arm_{side[0]}": (f"{side}ForeArm",), f"palm_{side[0]}": (f"{side}Hand",),
    }  # fmt: skip
    assert found.lacking == tuple(f"{bone}_{other[0]}" for bone in ("arm", "f_arm", "palm"))


def test_of_an_arm_without_a_head_no_joint_of_the_trunk_is_a_part(body: Body) -> None:
    found = part_of(body, f"Right Leg Foot Eye Neck Head {FINGERS}", "Hips")
    assert found.bones == {
        "clav_L": ("LeftShoulder",), "arm_L": ("LeftArm",), "f_arm_L": ("LeftForeArm",),
        "palm_L": ("LeftHand",),
    }  # fmt: skip
    assert found.root == "Hips"


def test_two_arms_without_a_head_begin_where_they_part(body: Body) -> None:
    blob = with_names(body, {"Spine1": "Blob"})
    found = part_of(blob, f"Leg Foot Eye Neck Head {FINGERS}", "Hips")
    assert (found.bones["clav_L"], found.bones["clav_R"]) == (("LeftShoulder",), ("RightShoulder",))


def test_a_joint_of_an_arm_that_is_called_a_hip_is_none_of_a_leg(body: Body) -> None:
    found = renamed(body, {"LeftShoulder": "LeftHip"})
    assert found.bones["clav_L"] == ("LeftHip",)
    assert "LeftHip" not in found.kept


def straight_arm(body: Body, shares: Mapping[str, float]) -> Body:
    """Put joints at shares of the way from shoulder to wrist."""
    places, at = np.array(body.places), {name: j for j, name in enumerate(body.names)}
    shoulder, wrist = places[at["LeftArm"]], places[at["LeftHand"]]
    for name, share in shares.items():
        places[at[name]] = shoulder + share * (wrist - shoulder)
    return replace(body, places=places)


def _arm(found: BoneMap) -> list[tuple[str, ...]]:
    return [found.bones.get(bone, ()) for bone in ("clav_L", "arm_L", "f_arm_L", "palm_L")]


def test_a_forearm_begins_where_a_name_says_so_wherever_that_is(body: Body) -> None:
    """Half way to the wrist there is a joint that shares the upper arm's turn."""
    arm = straight_arm(
        inserted(body, "LeftMuscle", "LeftForeArm"), {"LeftMuscle": 0.5, "LeftForeArm": 0.7}
    )
    assert _arm(with_joints(arm)) == [
        ("LeftShoulder",), ("LeftArm", "LeftMuscle"), ("LeftForeArm",), ("LeftHand",)
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("child", "shares", "upper", "fore"),
    [
        ("Blob", {"Lump": 0.3, "Blob": 0.5}, ("LeftArm", "Lump"), ("Blob",)),
        ("LeftHand", {"Blob": 0.5, "Lump": 0.8}, ("LeftArm",), ("Blob", "Lump")),
    ],
)
@pytest.mark.parametrize("names", [{}, {"LeftArm": "Thing", "LeftShoulder": "Ball"}])
def test_a_forearm_without_a_name_begins_half_way_from_the_shoulder_to_the_wrist(
    body: Body,
    child: str,
    shares: Mapping[str, float],
    upper: tuple[str, ...],
    fore: tuple[str, ...],
    names: Mapping[str, str],
) -> None:
    blob = inserted(with_names(body, {"LeftForeArm": "Blob"}), "Lump", child)
    found = renamed(straight_arm(blob, shares), names)
    called = [tuple(names.get(j, j) for j in chain) for chain in (("LeftShoulder",), upper, fore)]
    assert _arm(found) == [*called, ("LeftHand",)]


def test_before_an_arm_that_has_a_name_all_is_clavicle(body: Body) -> None:
    found = with_joints(inserted(with_names(body, {"LeftForeArm": "Blob"}), "LeftPlate", "LeftArm"))
    assert _arm(found) == [
        ("LeftShoulder", "LeftPlate"), ("LeftArm",), ("Blob",), ("LeftHand",)
    ]  # fmt: skip


def test_an_arm_whose_upper_part_has_no_name_begins_at_its_second_joint(body: Body) -> None:
    found = renamed(body, {"LeftShoulder": "Ball", "LeftArm": "Thing"})
    assert _arm(found) == [("Ball",), ("Thing",), ("LeftForeArm",), ("LeftHand",)]


def test_names_of_an_arm_in_the_wrong_order_tell_nothing(body: Body) -> None:
    found = renamed(body, {"LeftArm": "LeftElbow", "LeftForeArm": "LeftUpperArm"})
    assert _arm(found) == [("LeftShoulder",), ("LeftElbow",), ("LeftUpperArm",), ("LeftHand",)]


def test_an_arm_alone_begins_with_its_first_joint(body: Body) -> None:
    found = part_of(body, FINGERS, "LeftShoulder")
    assert _arm(found) == [("LeftShoulder",), ("LeftArm",), ("LeftForeArm",), ("LeftHand",)]


def test_an_arm_without_that_name_begins_at_the_joint_called_shoulder(body: Body) -> None:
    found = renamed(body, {"LeftArm": "LeftBlob"})
    assert found.bones["arm_L"] == ("LeftShoulder", "LeftBlob")
    assert found.bones["f_arm_L"] == ("LeftForeArm",)
    assert "clav_L" not in found.bones


@pytest.mark.parametrize(
    ("name", "above"), [("LeftHandTwist", "LeftArm"), ("LeftHand_end", "LeftArm"),
    ("HeadTwist", "Spine2"), ("HeadTop_End", "Spine2")],
)  # fmt: skip
def test_twists_and_ends_nearer_to_the_trunk_are_no_hand_and_no_head(
    body: Body, name: str, above: str
) -> None:
    found = with_joints(body, (name, above))
    assert found.bones["palm_L"] == ("LeftHand",)
    assert found.bones["head"] == ("Head",)


def test_of_two_joints_without_names_before_a_hand_one_is_the_upper_arm(body: Body) -> None:
    names = {"LeftArm": "LeftBlob", "LeftForeArm": "LeftLump"}
    kept = [j for j, name in enumerate(body.names) if name != "LeftShoulder"]
    shoulder = body.names.index("LeftShoulder")
    above = [body.parents[shoulder] if p == shoulder else p for p in body.parents]
    parents = np.array([kept.index(above[j]) if above[j] >= 0 else -1 for j in kept])
    joints = tuple(names.get(body.names[j], body.names[j]) for j in kept)
    found = propose(Tree(joints, parents, body.places[kept]))
    assert found.bones["arm_L"] == ("LeftBlob",)
    assert found.bones["f_arm_L"] == ("LeftLump",)
    assert "clav_L" not in found.bones
