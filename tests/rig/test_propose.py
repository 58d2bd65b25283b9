"""Proposals of trunk, legs and twists, of skeletons that have more, or less, than most."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from body_families import Body, make_body
from joint_names import FAMILIES
from numpy.typing import NDArray
from partial_bodies import ARMS, LEG_JOINTS, part_of, renamed, with_joints, with_names

from azee_rig.importing.propose import propose
from azee_rig.importing.skeleton_tree import Tree


@pytest.fixture(scope="module")
def body() -> Body:
    return make_body(FAMILIES["ready-player-me"])


@pytest.mark.parametrize(
    "names",
    [("LeftArmTwist", "LeftForeArmTwist"), ("LeftArmRoll", "LeftForeArmRoll"),
     ("upperarm_twist_01_l", "lowerarm_twist_01_l"), ("LeftUpperArm2", "LeftLowerArm2")],
)  # fmt: skip
def test_joints_that_share_a_limbs_turn_are_twists(body: Body, names: tuple[str, str]) -> None:
    plain = with_joints(body)
    found = with_joints(body, (names[0], "LeftArm"), (names[1], "LeftForeArm"))
    assert found.twists == {"arm_L": (names[0],), "f_arm_L": (names[1],)}
    assert found.bones == plain.bones


def test_other_joints_on_a_limb_are_no_twists(body: Body) -> None:
    found = with_joints(
        body,
        ("LeftElbowPad", "LeftArm"),
        ("LeftSleeve", "LeftForeArm"),
        ("LeftArmTwist_end", "LeftArm"),
        ("LeftHandTwist", "LeftHand"),
        ("LeftLegTwist", "LeftLeg"),
        ("LeftFoot_end", "LeftFoot"),
    )
    assert found.twists == {}
    assert found.kept == LEG_JOINTS == with_joints(body).kept


def test_twists_of_both_sides_stay_apart(body: Body) -> None:
    found = with_joints(body, ("LeftArmTwist", "LeftArm"), ("RightForeArmTwist", "RightForeArm"))
    assert found.twists == {"arm_L": ("LeftArmTwist",), "f_arm_R": ("RightForeArmTwist",)}


def test_a_body_without_legs_keeps_its_pelvis(body: Body) -> None:
    found = part_of(body, "Leg Foot", "Hips")
    assert found.root == "Hips"
    assert (found.bones["back_1"], found.bones["back_2"]) == (("Spine", "Spine1"), ("Spine2",))
    assert found.kept == ()


def test_a_skeleton_that_begins_with_its_spine_stands_on_its_first_joint(body: Body) -> None:
    found = part_of(body, "Leg Foot", "Spine")
    assert found.root == "Spine"
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine1", "Spine2")
    assert found.lacking == ()


def test_a_skeleton_that_begins_with_its_chest_has_one_joint_for_all(body: Body) -> None:
    found = part_of(body, "Leg Foot", "Spine2")
    assert found.root == "Spine2"
    assert found.lacking == ()
    assert found.bones["back_2"] == ("Spine2",)
    assert "back_1" not in found.bones


def test_a_pelvis_below_a_back_of_one_joint_is_no_part_of_the_neck(body: Body) -> None:
    found = part_of(body, "Leg Foot", "Spine1")
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


def test_the_last_of_the_joints_called_spine_is_a_head(body: Body) -> None:
    found = renamed(body, {"Neck": "Spine3", "Head": "Spine4"})
    assert found.family == "names"
    assert found.bones["head"] == ("Spine4",)
    assert found.bones["palm_L"] == ("LeftHand",)


def test_the_last_of_the_joints_called_spine_is_a_head_also_above_a_chest_that_is_the_root(
    body: Body,
) -> None:
    found = part_of(with_names(body, {"Neck": "Spine3", "Head": "Spine4"}), "Eye", "Spine2")
    assert (found.family, found.root) == ("names", "Spine2")
    assert found.bones["head"] == ("Spine4",)


def test_a_body_without_arms_has_its_back_and_its_neck(body: Body) -> None:
    found = part_of(body, f"{ARMS} Leg Foot Eye", "Hips")
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1", "Spine2")
    assert (found.bones["neck"], found.bones["head"]) == (("Neck",), ("Head",))


def test_without_arms_and_a_name_for_the_neck_all_below_the_head_is_back(body: Body) -> None:
    found = part_of(with_names(body, {"Neck": "Blob"}), f"{ARMS} Leg Foot Eye", "Hips")
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1", "Spine2", "Blob")
    assert "neck" not in found.bones


def test_a_neck_without_a_name_begins_above_the_chest(body: Body) -> None:
    found = renamed(body, {"Neck": "Blob"})
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1", "Spine2")
    assert found.bones["neck"] == ("Blob",)


def test_a_chest_that_is_called_a_neck_is_one(body: Body) -> None:
    found = renamed(body, {"Spine2": "LowerNeck"})
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine", "Spine1")
    assert found.bones["neck"] == ("LowerNeck", "Neck")


def test_of_two_joints_called_pelvis_the_upper_one_is_it(body: Body) -> None:
    found = renamed(body, {"Spine": "Pelvis"})
    assert found.root == "Pelvis"
    assert found.bones["back_1"] + found.bones["back_2"] == ("Spine1", "Spine2")


@pytest.mark.parametrize("neck", ["Spine", "Neck"])
def test_without_names_below_the_chest_the_first_joint_is_the_pelvis(body: Body, neck: str) -> None:
    """What is called spine above the chest does not count."""
    names = {"Hips": "Lowest", "Spine": "Blob", "Spine1": "Blob1", "Spine2": "Blob2"}
    blobs = with_names(body, names)
    found = part_of(with_names(blobs, {"Neck": neck}), "Leg Foot", "Lowest")
    assert found.root == "Lowest"
    assert found.bones["back_1"] + found.bones["back_2"] == ("Blob", "Blob1", "Blob2")
    assert found.bones["neck"] == (neck,)


def test_a_head_that_nothing_carries_is_the_root(body: Body) -> None:
    found = part_of(body, "", "Head")
    assert (found.root, found.bones["head"]) == ("Head", ("Head",))
    assert not {"neck", "back_1", "back_2"} & found.bones.keys()


def test_controls_beside_joints_that_deform_are_passed_over(body: Body) -> None:
    """A hand's control hangs on the root, as an arm that is moved by its hand has it."""
    deforming = replace(body, names=tuple(f"DEF-{name}" for name in body.names))
    found = with_joints(deforming, ("LeftHand", "DEF-Hips"), ("RightHand", "DEF-Hips"))
    plain = with_joints(body)
    assert found.family == "names"
    assert found.bones == {b: tuple(f"DEF-{j}" for j in chain) for b, chain in plain.bones.items()}


def test_one_joint_that_deforms_makes_the_others_no_controls(body: Body) -> None:
    plain, found = with_joints(body), with_joints(body, ("DEF-cheek", "Head"))
    assert (found.family, found.bones) == ("names", plain.bones)


def test_joints_whose_names_say_nothing_are_told_by_the_shape(body: Body) -> None:
    names = {name: f"joint {chr(97 + n // 26)}{chr(97 + n % 26)}"
             for n, name in enumerate(body.names)}  # fmt: skip
    found = renamed(body, names)
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


def test_an_eye_begins_at_the_joint_nearest_to_the_head(body: Body) -> None:
    found = with_joints(body, ("LeftEyeball", "LeftEye"))
    assert found.bones["eye_L"] == ("LeftEye",)


def test_a_skeleton_without_a_head_stands_on_its_first_joint(body: Body) -> None:
    found = part_of(body, "Leg Foot Head Neck Eye", "Hips")
    assert "head" not in found.bones
    assert found.root == "Hips"


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
    called = with_names(body, names)
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
