"""Proposals for skeletons that have more, or less, than most: twist joints, no pelvis, no legs."""

from __future__ import annotations

import numpy as np
import pytest
from body_families import FAMILIES, Body, make_body

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
