"""Proposals of digits: numbers for names, tips, metacarpals, hands alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from body_families import Body, make_body
from joint_names import FAMILIES
from numpy.typing import NDArray
from partial_bodies import part_of, renamed, with_joints, with_names

from azee_rig.importing.bone_map import BoneMap
from azee_rig.importing.propose import propose
from azee_rig.importing.skeleton_tree import Tree


@pytest.fixture(scope="module")
def body() -> Body:
    return make_body(FAMILIES["ready-player-me"])


@pytest.mark.parametrize(("dropped", "digits"), [
    ("", ("thumb", "index", "middle", "ring", "little")),
    ("finger5", ("thumb", "index", "middle", "ring")),
    ("finger5 finger4", ()),
])  # fmt: skip
def test_fingers_are_told_by_their_numbers_if_there_are_four_at_least(
    dropped: str, digits: tuple[str, ...]
) -> None:
    numbered = make_body(FAMILIES["makehuman"], eyes=False)
    found = part_of(numbered, dropped, "root")
    assert found.family == "names"
    assert found.digits("L") == found.digits("R") == digits


@pytest.mark.parametrize("root", ["LeftHand", "LeftForeArm", "LeftShoulder"])
def test_a_hand_alone_is_not_taken_for_a_figure_with_fingers_as_limbs(
    body: Body, root: str
) -> None:
    found = part_of(body, "Leg Foot", root)
    assert found.family == "names"
    assert "head" in found.lacking
    assert "palm_R" in found.lacking


def test_a_body_of_numbered_fingers_without_legs_keeps_them() -> None:
    """Most of its joints begin with the word finger then, which says something all the same."""
    found = part_of(make_body(FAMILIES["makehuman"], eyes=False), "leg foot", "root")
    assert found.family == "names"
    assert found.digits("L") == found.digits("R") == ("thumb", "index", "middle", "ring", "little")


def test_a_sixth_finger_is_no_digit() -> None:
    numbered = make_body(FAMILIES["makehuman"], eyes=False)
    hand = numbered.names[numbered.parents[numbered.names.index("finger1-1.L")]]
    assert with_joints(numbered, ("finger6-1.L", hand)).bones == with_joints(numbered).bones


def test_a_finger_of_a_metacarpal_and_two_joints_has_no_middle_one(body: Body) -> None:
    found = renamed(
        body,
        {f"LeftHandIndex{k}": f"LeftHandIndex{name}" for k, name in enumerate("M12", 1)}
        | {"LeftHandIndex1": "LeftHandIndexMetacarpal"},
    )
    assert found.bones["index_L_1"] == ("LeftHandIndex1",)
    assert found.bones["index_L_3"] == ("LeftHandIndex2",)
    assert "index_L_2" not in found.bones
    assert found.bones["middle_L_2"] == ("LeftHandMiddle2",)


def test_a_finger_of_a_metacarpal_and_one_joint_bends_at_its_last(body: Body) -> None:
    names = {"LeftHandIndex1": "LeftHandIndexMetacarpal", "LeftHandIndex2": "LeftHandIndex1"}
    found = part_of(with_names(body, names), "LeftHandIndex3", "Hips")
    assert found.bones["index_L_3"] == ("LeftHandIndex1",)
    assert not {"index_L_1", "index_L_2"} & found.bones.keys()


def test_a_thumb_of_two_joints_lacks_its_first(body: Body) -> None:
    found = part_of(body, "LeftHandThumb3", "Hips")
    assert found.bones["thumb_L_2"] == ("LeftHandThumb1",)
    assert found.bones["thumb_L_3"] == ("LeftHandThumb2",)
    assert "thumb_L_1" not in found.bones


def test_a_fourth_joint_is_a_tip_also_where_its_own_end_is_marked(body: Body) -> None:
    found = with_joints(
        body, ("LeftHandIndex4", "LeftHandIndex3"), ("LeftHandIndex4_end", "LeftHandIndex4")
    )
    assert found.bones["index_L_3"] == ("LeftHandIndex3",)
    assert found.tips["index_L"] == "LeftHandIndex4"


def test_a_third_joint_without_skin_bends_all_the_same(body: Body) -> None:
    skin = np.ones(len(body.names))
    skin[body.names.index("LeftHandIndex3")] = 0.0
    found = propose(Tree(body.names, np.array(body.parents), body.places), carried=skin)
    assert found.bones["index_L_3"] == ("LeftHandIndex3",)
    assert "index_L" not in found.tips


def test_a_finger_of_one_joint_bends_at_its_last(body: Body) -> None:
    found = part_of(body, "LeftHandIndex2 LeftHandIndex3", "Hips")
    assert found.bones["index_L_3"] == ("LeftHandIndex1",)
    assert not {"index_L_1", "index_L_2"} & found.bones.keys()


@pytest.mark.parametrize(("share", "inside"), [(0.44, True), (0.46, False)])
def test_the_first_of_four_joints_lies_in_the_palm_if_it_is_much_nearer_to_the_wrist(
    body: Body, share: float, inside: bool
) -> None:
    """Nearer than 45 % of the way to the next."""
    names, places = [*body.names, "LeftHandIndex4"], [*body.places, body.places[0]]
    last = names.index("LeftHandIndex3")
    for k, up_m in enumerate((share, 1.0, 1.2, 1.4), 1):
        places[names.index(f"LeftHandIndex{k}")] = body.places[names.index("LeftHand")] + [
            0.1 * up_m,
            0.0,
            0.0,
        ]
    tree = Tree(tuple(names), np.array([*body.parents, last]), np.array(places))
    found = propose(tree, carried=np.ones(len(names)))
    first = 2 if inside else 1
    assert [found.bones[f"index_L_{k}"] for k in (1, 2, 3)] == [
        (f"LeftHandIndex{first + k}",) for k in range(3)
    ]
    assert found.tips.get("index_L") == (None if inside else "LeftHandIndex4")


@pytest.mark.parametrize(("further", "carried", "tip"), [
    (1, 1.0, "LeftHandIndex4"), (1, 0.0, "LeftHandIndex4"), (2, 0.0, "LeftHandIndex4"),
    (2, 1.0, None), (2, 0.05, None),
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


def with_handing_joints(body: Body, away: NDArray[np.float64], apart_m: float) -> BoneMap:
    """Propose for the body with a joint before each of three digits, so far from the wrist.

    That of the middle finger is apart from the two others.
    """
    names: list[str] = []
    parents: list[str] = []
    places = []
    for name, up, place in zip(body.names, body.parents, body.places, strict=True):
        above = body.names[up] if up >= 0 else ""
        if name in ("LeftHandThumb1", "LeftHandIndex1", "LeftHandMiddle1"):
            names.append(name.replace("1", "0"))
            parents.append(above)
            places.append(body.places[up] + away + [0.0, apart_m * ("Middle" in name), 0.0])
            above = names[-1]
        names.append(name)
        parents.append(above)
        places.append(place)
    numbers = np.array([names.index(up) if up else -1 for up in parents])
    return propose(Tree(tuple(names), numbers, np.array(places)))


def test_joints_at_the_wrist_that_only_hand_digits_on_are_none_of_theirs(body: Body) -> None:
    found = with_handing_joints(body, np.zeros(3), 0.0)
    for digit in ("Thumb", "Index", "Middle"):
        chain = [found.bones[f"{digit.lower()}_L_{k}"] for k in (1, 2, 3)]
        assert chain == [(f"LeftHand{digit}{k}",) for k in (1, 2, 3)]


@pytest.mark.parametrize(("share", "first"), [
    (0.95e-3, "LeftHandThumb1"), (1.05e-3, "LeftHandThumb0")
])  # fmt: skip
def test_joints_are_in_one_place_if_apart_by_a_thousandth_of_their_way_from_the_wrist(
    body: Body, share: float, first: str
) -> None:
    found = with_handing_joints(body, np.array([0.03, 0.0, 0.0]), 0.03 * share)
    assert found.bones["thumb_L_1"] == (first,)


def test_a_digit_whose_joints_are_all_twists_leaves_the_others_alone(body: Body) -> None:
    """Of the thumb, which is looked at first, nothing that bends is there."""
    twists = {f"LeftHandThumb{k}": f"LeftHandThumb{k}_end" for k in (1, 2, 3)}
    found = renamed(body, twists)
    assert not any(bone.startswith("thumb_L") for bone in found.bones)
    assert {b for b in renamed(body, {}).bones if not b.startswith("thumb_L")} == set(found.bones)


def test_a_hand_without_a_thumb_has_its_fingers(body: Body) -> None:
    found = part_of(body, "LeftHandThumb", "Hips")
    assert not any(bone.startswith("thumb_L") for bone in found.bones)
    assert found.bones["index_L_1"] == ("LeftHandIndex1",)
    assert found.bones["little_L_3"] == ("LeftHandPinky3",)


def test_of_three_joints_none_only_hands_a_digit_on(body: Body) -> None:
    places = np.array(body.places)
    for digit in ("Thumb", "Index", "Middle"):
        places[body.names.index(f"LeftHand{digit}1")] = body.places[body.names.index("LeftHand")]
    found = with_joints(replace(body, places=places))
    for digit in ("Thumb", "Index", "Middle"):
        assert found.bones[f"{digit.lower()}_L_1"] == (f"LeftHand{digit}1",)
