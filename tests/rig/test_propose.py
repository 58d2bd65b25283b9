"""Proposals for skeletons that have more, or less, than most: twist joints, no pelvis, no legs."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from body_families import Body, make_body
from joint_names import FAMILIES
from numpy.typing import NDArray

from azee_rig.importing.bone_map import BoneMap
from azee_rig.importing.propose import propose
from azee_rig.importing.skeleton_tree import Tree


@pytest.fixture(scope="module")
def body() -> Body:
    return make_body(FAMILIES["ready-player-me"])


def _with(body: Body, *more: tuple[str, str]) -> BoneMap:
    """Propose for the body with further joints, each a name and the joint that it hangs on."""
    names, parents, places = list(body.names), list(body.parents), list(body.places)
    for name, above in more:
        up = names.index(above)
        names.append(name)
        parents.append(up)
        places.append(places[up] + np.array([0.03, 0.0, 0.0]))
    return propose(Tree(tuple(names), np.array(parents), np.array(places)))


@pytest.mark.parametrize(
    "names",
    [("LeftArmTwist", "LeftForeArmTwist"), ("LeftArmRoll", "LeftForeArmRoll"),
     ("upperarm_twist_01_l", "lowerarm_twist_01_l"), ("LeftUpperArm2", "LeftLowerArm2")],
)  # fmt: skip
def test_joints_that_share_a_limbs_turn_are_twists(body: Body, names: tuple[str, str]) -> None:
    plain = _with(body)
    found = _with(body, (names[0], "LeftArm"), (names[1], "LeftForeArm"))
    assert found.twists == {"arm_L": (names[0],), "f_arm_L": (names[1],)}
    assert found.bones == plain.bones


def test_other_joints_on_a_limb_are_no_twists(body: Body) -> None:
    found = _with(
        body,
        ("LeftElbowPad", "LeftArm"),
        ("LeftSleeve", "LeftForeArm"),
        ("LeftArmTwist_end", "LeftArm"),
        ("LeftHandTwist", "LeftHand"),
        ("LeftLegTwist", "LeftLeg"),
    )
    assert found.twists == {}
    assert set(found.kept) == set(_with(body).kept)


def test_twists_of_both_sides_stay_apart(body: Body) -> None:
    found = _with(body, ("LeftArmTwist", "LeftArm"), ("RightForeArmTwist", "RightForeArm"))
    assert found.twists == {"arm_L": ("LeftArmTwist",), "f_arm_R": ("RightForeArmTwist",)}


def _only(body: Body, keep: str, root: str) -> BoneMap:
    """Propose for a part of the body: what hangs on `root`, without joints that `keep` drops."""
    tree = Tree(body.names, np.array(body.parents), body.places)
    below = tree.below(body.names.index(root))
    kept = [j for j in below if not any(word in body.names[j] for word in keep.split())]
    number = {j: i for i, j in enumerate(kept)}
    parents = [number.get(body.parents[j], -1) for j in kept]
    return propose(Tree(tree.named(kept), np.array(parents), body.places[kept]))


def test_a_body_without_legs_keeps_its_pelvis(body: Body) -> None:
    found = _only(body, "Leg Foot", "Hips")
    assert found.root == "Hips"
    assert (found.bones["back_1"], found.bones["back_2"]) == (("Spine", "Spine1"), ("Spine2",))
    assert found.kept == ()


def test_a_skeleton_that_begins_with_its_spine_stands_on_its_first_joint(body: Body) -> None:
    found = _only(body, "Leg Foot", "Spine")
    assert found.root == "Spine"
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine1", "Spine2")
    assert found.lacking == ()


def test_a_skeleton_that_begins_with_its_chest_has_one_joint_for_all(body: Body) -> None:
    found = _only(body, "Leg Foot", "Spine2")
    assert found.root == "Spine2"
    assert found.lacking == ()
    assert "back_1" not in found.bones


def test_a_pelvis_without_a_name_is_where_the_legs_part() -> None:
    body = make_body(FAMILIES["ready-player-me"])
    names = tuple("Lowest" if name == "Hips" else name for name in body.names)
    found = propose(Tree(names, np.array(body.parents), body.places))
    assert found.root == "Lowest"
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1", "Spine2")


def _renamed(body: Body, names: Mapping[str, str]) -> BoneMap:
    """Propose for the body with other names for some joints."""
    assert names.keys() <= set(body.names)
    new = tuple(names.get(name, name) for name in body.names)
    return propose(Tree(new, np.array(body.parents), body.places))


def test_the_last_of_the_joints_called_spine_is_a_head(body: Body) -> None:
    found = _renamed(body, {"Neck": "Spine3", "Head": "Spine4"})
    assert found.family == "names"
    assert found.bones["head"] == ("Spine4",)
    assert found.bones["palm_L"] == ("LeftHand",)


def test_a_skeleton_without_a_head_stands_on_its_first_joint(body: Body) -> None:
    found = _only(body, "Leg Foot Head Neck Eye", "Hips")
    assert "head" not in found.bones
    assert found.root == "Hips"


def test_a_finger_of_a_metacarpal_and_two_joints_has_no_middle_one(body: Body) -> None:
    found = _renamed(
        body,
        {f"LeftHandIndex{k}": f"LeftHandIndex{name}" for k, name in enumerate("M12", 1)}
        | {"LeftHandIndex1": "LeftHandIndexMetacarpal"},
    )
    assert found.bones["index_L_1"] == ("LeftHandIndex1",)
    assert found.bones["index_L_3"] == ("LeftHandIndex2",)
    assert "index_L_2" not in found.bones
    assert found.bones["middle_L_2"] == ("LeftHandMiddle2",)


def test_a_finger_of_one_joint_bends_at_its_last(body: Body) -> None:
    found = _only(body, "LeftHandIndex2 LeftHandIndex3", "Hips")
    assert found.bones["index_L_3"] == ("LeftHandIndex1",)
    assert not {"index_L_1", "index_L_2"} & found.bones.keys()


@pytest.mark.parametrize(("further", "carried", "tip"), [
    (1, 1.0, "LeftHandIndex4"), (1, 0.0, "LeftHandIndex4"), (2, 0.0, "LeftHandIndex4"),
    (2, 1.0, None),
])  # fmt: skip
def test_a_fourth_joint_is_a_tip_unless_skin_hangs_on_a_fifth(
    body: Body, further: int, carried: float, tip: str | None
) -> None:
    names, parents, places = list(body.names), list(body.parents), list(body.places)
    skin = np.ones(len(names) + further)
    for k in range(4, 4 + further):
        up = names.index(f"LeftHandIndex{k - 1}")
        names.append(f"LeftHandIndex{k}")
        parents.append(up)
        places.append(places[up] + 0.5 * (places[up] - places[parents[up]]))
    skin[-1] = carried
    tree = Tree(tuple(names), np.array(parents), np.array(places))
    found = propose(tree, carried=skin)
    assert found.bones["index_L_3"] == ("LeftHandIndex3",)
    assert found.tips.get("index_L") == tip


def test_joints_at_the_wrist_that_only_hand_digits_on_are_none_of_theirs(body: Body) -> None:
    names: list[str] = []
    parents: list[str] = []
    places = []
    for name, up, place in zip(body.names, body.parents, body.places, strict=True):
        above = body.names[up] if up >= 0 else ""
        if name in ("LeftHandThumb1", "LeftHandIndex1", "LeftHandMiddle1"):
            names.append(name.replace("1", "0"))
            parents.append(above)
            places.append(body.places[up])
            above = names[-1]
        names.append(name)
        parents.append(above)
        places.append(place)
    numbers = np.array([names.index(up) if up else -1 for up in parents])
    found = propose(Tree(tuple(names), numbers, np.array(places)))
    for digit in ("Thumb", "Index", "Middle"):
        chain = [found.bones[f"{digit.lower()}_L_{k}"] for k in (1, 2, 3)]
        assert chain == [(f"LeftHand{digit}{k}",) for k in (1, 2, 3)]


def test_a_chest_that_carries_the_legs_is_the_pelvis_and_no_part_of_the_back(body: Body) -> None:
    legs = [n for n, name in enumerate(body.names) if name.endswith("UpLeg")]
    parents = np.array(body.parents)
    parents[legs] = body.names.index("Spine2")
    names = tuple("Spine0" if name == "Hips" else name for name in body.names)
    order = sorted(range(len(names)), key=lambda j: len(_above(parents, j)))
    number = {j: i for i, j in enumerate(order)}
    tree = Tree(
        tuple(names[j] for j in order),
        np.array([number.get(int(parents[j]), -1) for j in order]),
        body.places[order],
    )
    found = propose(tree)
    assert found.root == "Spine2"
    back = found.bones.get("back_1", ()) + found.bones["back_2"]
    assert back == ("Spine0", "Spine", "Spine1")


def _above(parents: NDArray[np.int64], joint: int) -> list[int]:
    """All that a joint hangs on."""
    return [] if parents[joint] < 0 else [joint, *_above(parents, int(parents[joint]))]


def test_a_digit_whose_joints_are_all_twists_leaves_the_others_alone(body: Body) -> None:
    """Of the thumb, which is looked at first, nothing that bends is there."""
    renamed = {f"LeftHandThumb{k}": f"LeftHandThumb{k}_end" for k in (1, 2, 3)}
    found = _renamed(body, renamed)
    assert not any(bone.startswith("thumb_L") for bone in found.bones)
    assert {b for b in _renamed(body, {}).bones if not b.startswith("thumb_L")} == set(found.bones)


def test_a_hand_without_a_thumb_has_its_fingers(body: Body) -> None:
    found = _only(body, "LeftHandThumb", "Hips")
    assert not any(bone.startswith("thumb_L") for bone in found.bones)
    assert found.bones["index_L_1"] == ("LeftHandIndex1",)
    assert found.bones["little_L_3"] == ("LeftHandPinky3",)


def test_a_joint_between_the_chest_and_the_neck_belongs_to_the_neck(body: Body) -> None:
    """Arms hang on the chest: what comes after it carries the head alone."""
    names, parents, places = [*body.names, "Spine3"], [*body.parents], [*body.places]
    chest, neck = names.index("Spine2"), names.index("Neck")
    parents.append(chest)
    places.append((places[chest] + places[neck]) / 2.0)
    parents[neck] = len(names) - 1
    found = propose(Tree(tuple(names), np.array(parents), np.array(places)))
    assert found.bones["neck"] == ("Spine3", "Neck")
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1", "Spine2")


def test_an_arm_without_that_name_begins_at_the_joint_called_shoulder(body: Body) -> None:
    found = _renamed(body, {"LeftArm": "LeftBlob"})
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
    found = _with(body, (name, above))
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
