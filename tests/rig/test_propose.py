"""Proposals for skeletons that have more, or less, than most: twist joints, no pelvis, no legs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from body_families import Body, make_body
from joint_names import FAMILIES
from numpy.typing import NDArray

from azee_rig.importing.bone_map import BoneMap
from azee_rig.importing.propose import propose
from azee_rig.importing.skeleton_tree import Tree

FINGERS = "Thumb Index Middle Ring Pinky"
ARMS = f"Shoulder Arm Hand {FINGERS}"
LEG_JOINTS = tuple(f"{side}{joint}" for side in ("Left", "Right")
                   for joint in ("UpLeg", "Leg", "Foot"))  # fmt: skip


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
        ("LeftFoot_end", "LeftFoot"),
    )
    assert found.twists == {}
    assert found.kept == LEG_JOINTS == _with(body).kept


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
    assert found.bones["back_2"] == ("Spine2",)
    assert "back_1" not in found.bones


def test_a_pelvis_below_a_back_of_one_joint_is_no_part_of_the_neck(body: Body) -> None:
    found = _only(body, "Leg Foot", "Spine1")
    assert found.root == "Spine1"
    assert (found.bones["back_2"], found.bones["neck"]) == (("Spine2",), ("Neck",))


def test_a_pelvis_without_a_name_and_legs_is_the_joint_before_the_spine(body: Body) -> None:
    kept = [j for j, name in enumerate(body.names) if "Leg" not in name and "Foot" not in name]
    names = ["Base", *("Lowest" if body.names[j] == "Hips" else body.names[j] for j in kept)]
    parents = [-1, *(kept.index(body.parents[j]) + 1 if j else 0 for j in kept)]
    places = np.vstack([np.zeros(3), body.places[kept]])
    found = propose(Tree(tuple(names), np.array(parents), places))
    assert found.root == "Lowest"
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1", "Spine2")


def test_a_pelvis_without_a_name_is_where_the_legs_part() -> None:
    body = make_body(FAMILIES["ready-player-me"])
    names = tuple("Lowest" if name == "Hips" else name for name in body.names)
    found = propose(Tree(names, np.array(body.parents), body.places))
    assert found.root == "Lowest"
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1", "Spine2")


def _called(body: Body, names: Mapping[str, str]) -> Body:
    """Return the body with other names for some joints."""
    assert names.keys() <= set(body.names)
    return replace(body, names=tuple(names.get(name, name) for name in body.names))


def _renamed(body: Body, names: Mapping[str, str]) -> BoneMap:
    return _with(_called(body, names))


def test_the_last_of_the_joints_called_spine_is_a_head(body: Body) -> None:
    found = _renamed(body, {"Neck": "Spine3", "Head": "Spine4"})
    assert found.family == "names"
    assert found.bones["head"] == ("Spine4",)
    assert found.bones["palm_L"] == ("LeftHand",)


def test_the_last_of_the_joints_called_spine_is_a_head_also_above_a_chest_that_is_the_root(
    body: Body,
) -> None:
    found = _only(_called(body, {"Neck": "Spine3", "Head": "Spine4"}), "Eye", "Spine2")
    assert (found.family, found.root) == ("names", "Spine2")
    assert found.bones["head"] == ("Spine4",)


@pytest.mark.parametrize(("side", "other"), [("Left", "Right"), ("Right", "Left")])
def test_a_body_of_one_arm_has_what_is_there(body: Body, side: str, other: str) -> None:
    """Its chest, whatever it is called, is where the arm leaves the way to the head."""
    found = _only(_called(body, {"Spine2": "Blob"}), f"{other} Leg Foot Eye {FINGERS}", "Hips")
    assert found.bones == {
        "back_1": ("Spine", "Spine1"), "back_2": ("Blob",), "neck": ("Neck",), "head": ("Head",),
        f"clav_{side[0]}": (f"{side}Shoulder",), f"arm_{side[0]}": (f"{side}Arm",),
        f"f_arm_{side[0]}": (f"{side}ForeArm",), f"palm_{side[0]}": (f"{side}Hand",),
    }  # fmt: skip
    assert found.lacking == tuple(f"{bone}_{other[0]}" for bone in ("arm", "f_arm", "palm"))


def test_of_an_arm_without_a_head_no_joint_of_the_trunk_is_a_part(body: Body) -> None:
    found = _only(body, f"Right Leg Foot Eye Neck Head {FINGERS}", "Hips")
    assert found.bones == {
        "clav_L": ("LeftShoulder",), "arm_L": ("LeftArm",), "f_arm_L": ("LeftForeArm",),
        "palm_L": ("LeftHand",),
    }  # fmt: skip
    assert found.root == "Hips"


def test_two_arms_without_a_head_begin_where_they_part(body: Body) -> None:
    found = _only(_called(body, {"Spine1": "Blob"}), f"Leg Foot Eye Neck Head {FINGERS}", "Hips")
    assert (found.bones["clav_L"], found.bones["clav_R"]) == (("LeftShoulder",), ("RightShoulder",))


def test_a_body_without_arms_has_its_back_and_its_neck(body: Body) -> None:
    found = _only(body, f"{ARMS} Leg Foot Eye", "Hips")
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1", "Spine2")
    assert (found.bones["neck"], found.bones["head"]) == (("Neck",), ("Head",))


def test_without_arms_and_a_name_for_the_neck_all_below_the_head_is_back(body: Body) -> None:
    found = _only(_called(body, {"Neck": "Blob"}), f"{ARMS} Leg Foot Eye", "Hips")
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1", "Spine2", "Blob")
    assert "neck" not in found.bones


def test_a_neck_without_a_name_begins_above_the_chest(body: Body) -> None:
    found = _renamed(body, {"Neck": "Blob"})
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1", "Spine2")
    assert found.bones["neck"] == ("Blob",)


def test_a_chest_that_is_called_a_neck_is_one(body: Body) -> None:
    found = _renamed(body, {"Spine2": "LowerNeck"})
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1")
    assert found.bones["neck"] == ("LowerNeck", "Neck")


def test_of_two_joints_called_pelvis_the_upper_one_is_it(body: Body) -> None:
    found = _renamed(body, {"Spine": "Pelvis"})
    assert found.root == "Pelvis"
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine1", "Spine2")


@pytest.mark.parametrize("neck", ["Spine", "Neck"])
def test_without_names_below_the_chest_the_first_joint_is_the_pelvis(body: Body, neck: str) -> None:
    """What is called spine above the chest does not count."""
    blobs = _called(body, {"Hips": "Lowest", "Spine": "Blob", "Spine1": "Blob1", "Spine2": "Blob2"})
    found = _only(_called(blobs, {"Neck": neck}), "Leg Foot", "Lowest")
    assert found.root == "Lowest"
    assert found.bones["back_1"] + found.bones["back_2"] == ("Blob", "Blob1", "Blob2")
    assert found.bones["neck"] == (neck,)


def test_a_head_that_nothing_carries_is_the_root(body: Body) -> None:
    found = _only(body, "", "Head")
    assert (found.root, found.bones["head"]) == ("Head", ("Head",))
    assert not {"neck", "back_1", "back_2"} & found.bones.keys()


def test_controls_beside_joints_that_deform_are_passed_over(body: Body) -> None:
    """A hand's control hangs on the root, as an arm that is moved by its hand has it."""
    deforming = replace(body, names=tuple(f"DEF-{name}" for name in body.names))
    found = _with(deforming, ("LeftHand", "DEF-Hips"), ("RightHand", "DEF-Hips"))
    plain = _with(body)
    assert found.family == "names"
    assert found.bones == {b: tuple(f"DEF-{j}" for j in chain) for b, chain in plain.bones.items()}


def test_one_joint_that_deforms_makes_the_others_no_controls(body: Body) -> None:
    plain, found = _with(body), _with(body, ("DEF-cheek", "Head"))
    assert (found.family, found.bones) == ("names", plain.bones)


def test_joints_whose_names_say_nothing_are_told_by_the_shape(body: Body) -> None:
    names = {name: f"joint {chr(97 + n // 26)}{chr(97 + n % 26)}"
             for n, name in enumerate(body.names)}  # fmt: skip
    found = _renamed(body, names)
    assert (found.family, found.lacking) == ("shape", ())
    wanted = {b: tuple(names[j] for j in body.bones[b]) for b in ("head", "arm_L", "index_R_1")}
    assert {bone: found.bones[bone] for bone in wanted} == wanted


def test_where_the_shape_tells_no_more_than_the_names_these_count(body: Body) -> None:
    """Hands that hang on the chest have no arms, whoever looks for them."""
    kept = [j for j, n in enumerate(body.names) if not n.endswith(("Shoulder", "Arm"))]
    chest = kept.index(body.names.index("Spine2"))
    above = [body.parents[j] for j in kept]
    parents = [kept.index(p) if p in kept else chest if p >= 0 else -1 for p in above]
    names = tuple(body.names[j] for j in kept)
    found = propose(Tree(names, np.array(parents), body.places[kept]))
    assert found.lacking == ("arm_L", "f_arm_L", "arm_R", "f_arm_R")
    assert found.family == "names"


@pytest.mark.parametrize(("dropped", "digits"), [
    ("", ("thumb", "index", "middle", "ring", "little")),
    ("finger5", ("thumb", "index", "middle", "ring")),
    ("finger5 finger4", ()),
])  # fmt: skip
def test_fingers_are_told_by_their_numbers_if_there_are_four_at_least(
    dropped: str, digits: tuple[str, ...]
) -> None:
    numbered = make_body(FAMILIES["makehuman"], eyes=False)
    found = _only(numbered, dropped, "root")
    assert found.family == "names"
    assert found.digits("L") == found.digits("R") == digits


@pytest.mark.parametrize("root", ["LeftHand", "LeftForeArm", "LeftShoulder"])
def test_a_hand_alone_is_not_taken_for_a_figure_with_fingers_as_limbs(
    body: Body, root: str
) -> None:
    found = _only(body, "Leg Foot", root)
    assert found.family == "names"
    assert "head" in found.lacking
    assert "palm_R" in found.lacking


def test_a_body_of_numbered_fingers_without_legs_keeps_them() -> None:
    """Most of its joints begin with the word finger then, which says something all the same."""
    found = _only(make_body(FAMILIES["makehuman"], eyes=False), "leg foot", "root")
    assert found.family == "names"
    assert found.digits("L") == found.digits("R") == ("thumb", "index", "middle", "ring", "little")


def test_a_sixth_finger_is_no_digit() -> None:
    numbered = make_body(FAMILIES["makehuman"], eyes=False)
    hand = numbered.names[numbered.parents[numbered.names.index("finger1-1.L")]]
    assert _with(numbered, ("finger6-1.L", hand)).bones == _with(numbered).bones


def test_an_eye_begins_at_the_joint_nearest_to_the_head(body: Body) -> None:
    found = _with(body, ("LeftEyeball", "LeftEye"))
    assert found.bones["eye_L"] == ("LeftEye",)


def test_a_joint_of_an_arm_that_is_called_a_hip_is_none_of_a_leg(body: Body) -> None:
    found = _renamed(body, {"LeftShoulder": "LeftHip"})
    assert found.bones["clav_L"] == ("LeftHip",)
    assert "LeftHip" not in found.kept


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


def test_a_finger_of_a_metacarpal_and_one_joint_bends_at_its_last(body: Body) -> None:
    names = {"LeftHandIndex1": "LeftHandIndexMetacarpal", "LeftHandIndex2": "LeftHandIndex1"}
    found = _only(_called(body, names), "LeftHandIndex3", "Hips")
    assert found.bones["index_L_3"] == ("LeftHandIndex1",)
    assert not {"index_L_1", "index_L_2"} & found.bones.keys()


def test_a_thumb_of_two_joints_lacks_its_first(body: Body) -> None:
    found = _only(body, "LeftHandThumb3", "Hips")
    assert found.bones["thumb_L_2"] == ("LeftHandThumb1",)
    assert found.bones["thumb_L_3"] == ("LeftHandThumb2",)
    assert "thumb_L_1" not in found.bones


def test_a_fourth_joint_is_a_tip_also_where_its_own_end_is_marked(body: Body) -> None:
    found = _with(
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
    found = _only(body, "LeftHandIndex2 LeftHandIndex3", "Hips")
    assert found.bones["index_L_3"] == ("LeftHandIndex1",)
    assert not {"index_L_1", "index_L_2"} & found.bones.keys()


@pytest.mark.parametrize(("share", "lower"), [(0.36, 2), (0.4, 1)])
def test_the_upper_back_begins_38_percent_of_the_way_to_the_neck(
    body: Body, share: float, lower: int
) -> None:
    places = np.array(body.places)
    for name, at in (("Spine", 0.0), ("Spine1", share), ("Spine2", 0.9), ("Neck", 1.0)):
        places[body.names.index(name)] = [0.0, 1.0 + 0.4 * at, 0.0]
    found = propose(Tree(body.names, np.array(body.parents), places))
    back = ("Spine", "Spine1", "Spine2")
    assert (found.bones["back_1"], found.bones["back_2"]) == (back[:lower], back[lower:])


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


def _with_handing_joints(body: Body, away: NDArray[np.float64], apart_m: float) -> BoneMap:
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
    found = _with_handing_joints(body, np.zeros(3), 0.0)
    for digit in ("Thumb", "Index", "Middle"):
        chain = [found.bones[f"{digit.lower()}_L_{k}"] for k in (1, 2, 3)]
        assert chain == [(f"LeftHand{digit}{k}",) for k in (1, 2, 3)]


@pytest.mark.parametrize(("share", "first"), [
    (0.95e-3, "LeftHandThumb1"), (1.05e-3, "LeftHandThumb0")
])  # fmt: skip
def test_joints_are_in_one_place_if_apart_by_a_thousandth_of_their_way_from_the_wrist(
    body: Body, share: float, first: str
) -> None:
    found = _with_handing_joints(body, np.array([0.03, 0.0, 0.0]), 0.03 * share)
    assert found.bones["thumb_L_1"] == (first,)


@pytest.mark.parametrize(("names", "chest", "back"), [
    ({"Hips": "Spine0"}, "Spine2", ("Spine0", "Spine", "Spine1")),
    ({"Hips": "Lowest", "Spine": "Blob"}, "Spine2", ("Spine1",)),
    ({"Hips": "Spine0"}, "Spine1", ("Spine0", "Spine", "Spine2")),
])  # fmt: skip
def test_a_chest_that_carries_the_legs_is_the_pelvis_and_no_part_of_the_back(
    body: Body, names: Mapping[str, str], chest: str, back: tuple[str, ...]
) -> None:
    parents = np.array(body.parents)
    for n, name in enumerate(body.names):
        if name.endswith(("UpLeg", "Shoulder")):
            parents[n] = body.names.index(chest)
    order = sorted(range(len(body.names)), key=lambda j: len(_above(parents, j)))
    number = {j: i for i, j in enumerate(order)}
    called = _called(body, names)
    tree = Tree(
        tuple(called.names[j] for j in order),
        np.array([number.get(int(parents[j]), -1) for j in order]),
        body.places[order],
    )
    found = propose(tree)
    assert found.root == chest
    assert found.bones.get("back_1", ()) + found.bones["back_2"] == back
    assert found.bones["neck"] == ("Neck",)


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


def _inserted(body: Body, name: str, child: str) -> Body:
    """Return the body with a joint between one and what that hangs on, half way."""
    at = body.names.index(child)
    up = body.parents[at]
    parents = [p + (p >= at) for p in body.parents]
    parents[at] = at
    return replace(
        body,
        names=(*body.names[:at], name, *body.names[at:]),
        parents=(*parents[:at], up, *parents[at:]),
        places=np.insert(body.places, at, (body.places[up] + body.places[at]) / 2.0, axis=0),
    )


def _straight_arm(body: Body, shares: Mapping[str, float]) -> Body:
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
    arm = _straight_arm(
        _inserted(body, "LeftMuscle", "LeftForeArm"), {"LeftMuscle": 0.5, "LeftForeArm": 0.7}
    )
    assert _arm(_with(arm)) == [
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
    blob = _inserted(_called(body, {"LeftForeArm": "Blob"}), "Lump", child)
    found = _renamed(_straight_arm(blob, shares), names)
    called = [tuple(names.get(j, j) for j in chain) for chain in (("LeftShoulder",), upper, fore)]
    assert _arm(found) == [*called, ("LeftHand",)]


def test_before_an_arm_that_has_a_name_all_is_clavicle(body: Body) -> None:
    found = _with(_inserted(_called(body, {"LeftForeArm": "Blob"}), "LeftPlate", "LeftArm"))
    assert _arm(found) == [
        ("LeftShoulder", "LeftPlate"), ("LeftArm",), ("Blob",), ("LeftHand",)
    ]  # fmt: skip


def test_an_arm_whose_upper_part_has_no_name_begins_at_its_second_joint(body: Body) -> None:
    found = _renamed(body, {"LeftShoulder": "Ball", "LeftArm": "Thing"})
    assert _arm(found) == [("Ball",), ("Thing",), ("LeftForeArm",), ("LeftHand",)]


def test_names_of_an_arm_in_the_wrong_order_tell_nothing(body: Body) -> None:
    found = _renamed(body, {"LeftArm": "LeftElbow", "LeftForeArm": "LeftUpperArm"})
    assert _arm(found) == [("LeftShoulder",), ("LeftElbow",), ("LeftUpperArm",), ("LeftHand",)]


def test_an_arm_alone_begins_with_its_first_joint(body: Body) -> None:
    found = _only(body, FINGERS, "LeftShoulder")
    assert _arm(found) == [("LeftShoulder",), ("LeftArm",), ("LeftForeArm",), ("LeftHand",)]


def test_of_three_joints_none_only_hands_a_digit_on(body: Body) -> None:
    places = np.array(body.places)
    for digit in ("Thumb", "Index", "Middle"):
        places[body.names.index(f"LeftHand{digit}1")] = body.places[body.names.index("LeftHand")]
    found = _with(replace(body, places=places))
    for digit in ("Thumb", "Index", "Middle"):
        assert found.bones[f"{digit.lower()}_L_1"] == (f"LeftHand{digit}1",)


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
