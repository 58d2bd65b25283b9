"""Bodies are stood up by what their joints say, and doubts about a bones-map are told."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from body_families import Body, make_body
from joint_names import FAMILIES
from numpy.typing import NDArray

from azee_rig.importing.bone_map import BoneMap
from azee_rig.importing.fault import BodyError
from azee_rig.importing.propose import propose
from azee_rig.importing.skeleton_tree import Tree
from azee_rig.importing.upright import Stand, checks, stand_up
from azee_rig.rotation import about_axis

Floats = NDArray[np.float64]


@pytest.fixture(scope="module")
def body() -> Body:
    return make_body(FAMILIES["ready-player-me"])


def _tree(body: Body, turn: Floats | None = None) -> Tree:
    turn = np.eye(3) if turn is None else turn
    return Tree(body.names, np.array(body.parents), body.places @ turn.T)


def _stood(body: Body, turn: Floats, *, exactly: bool = False) -> tuple[Stand, Floats]:
    """Stand a turned body up; return how, and where its joints are then."""
    tree = _tree(body, turn)
    stand = stand_up(tree, propose(tree), body.vertices @ turn.T, exactly=exactly)
    return stand, stand.points(tree.places)


def _angle(first: Floats, second: Floats) -> float:
    cosine = first @ second / (np.linalg.norm(first) * np.linalg.norm(second))
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def _directions(body: Body, places: Floats) -> tuple[Floats, Floats]:
    """Up, from hips to head, and left, between the shoulders."""
    at = dict(zip(body.names, places, strict=True))
    return at["Head"] - at["Hips"], at["LeftArm"] - at["RightArm"]


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("degrees", [30.0, -30.0, 60.0, 130.0])
def test_a_body_that_is_turned_by_any_angle_stands_up(
    body: Body, axis: int, degrees: float
) -> None:
    turn = about_axis(axis, np.radians(degrees))
    stand, places = _stood(body, turn)
    up, left = _directions(body, places)
    assert _angle(up, np.array([0.0, 1.0, 0.0])) < 1e-3
    assert _angle(left, np.array([1.0, 0.0, 0.0])) < 1.0
    assert np.linalg.det(stand.turn) == pytest.approx(1.0)
    usual_up, _ = _directions(body, body.places)
    lean = _angle(usual_up, np.array([0.0, 1.0, 0.0]))
    (note,) = [note for note in stand.notes if note.startswith("turned by")]
    told = float(note.removeprefix("turned by ").partition("°")[0])
    assert abs(told - abs(degrees)) < lean + 1.0


@pytest.mark.parametrize("degrees", [0.0, 10.0, 80.0, 100.0, 170.0])
def test_a_body_that_nearly_stands_keeps_its_lean(body: Body, degrees: float) -> None:
    near = 90.0 * round(degrees / 90.0)
    stand, places = _stood(body, about_axis(0, np.radians(degrees)))
    up, _ = _directions(body, places)
    usual, _ = _directions(body, body.places @ about_axis(0, np.radians(degrees - near)).T)
    assert _angle(up, usual) < 1e-3
    assert np.allclose(np.abs(stand.turn).max(axis=1), 1.0)
    exact, places = _stood(body, about_axis(0, np.radians(degrees)), exactly=True)
    up, _ = _directions(body, places)
    assert _angle(up, np.array([0.0, 1.0, 0.0])) < 1e-3
    assert degrees == 0.0 or exact.notes


@pytest.mark.parametrize(
    ("metre", "told"), [(1.0, None), (100.0, "cm"), (1000.0, "mm"), (39.37, "inch"), (10.0, "dm")]
)
def test_lengths_are_told_by_the_height(body: Body, metre: float, told: str | None) -> None:
    stand, places = _stood(body, metre * np.eye(3))
    assert np.ptp(places[:, 1]) == pytest.approx(np.ptp(body.places[:, 1]), rel=0.01)
    notes = [note for note in stand.notes if "taken for" in note]
    assert notes == [] if told is None else f"taken for {told}:" in notes[0]


def test_a_height_of_no_unit_is_made_usual(body: Body) -> None:
    stand, _ = _stood(body, 1e5 * np.eye(3))
    assert any("which no usual unit makes a person" in note for note in stand.notes)
    assert np.ptp(stand.points(1e5 * body.vertices)[:, 1]) == pytest.approx(1.7)


def test_a_body_on_one_line_is_refused(body: Body) -> None:
    flat = replace(body, places=body.places * (0.0, 1.0, 0.0))
    tree = _tree(flat)
    with pytest.raises(BodyError, match="do not tell up from left"):
        stand_up(tree, propose(_tree(body)), body.vertices, exactly=False)


def _doubts(body: Body, bones: BoneMap, places: Floats | None = None) -> list[str]:
    return checks(_tree(body), bones, body.places if places is None else places)


def _exchanged(bones: BoneMap, pairs: Mapping[str, str]) -> BoneMap:
    both = {**pairs, **{b: a for a, b in pairs.items()}}
    return replace(bones, bones={both.get(b, b): chain for b, chain in bones.bones.items()})


def test_a_sound_body_leaves_no_doubt(body: Body) -> None:
    assert _doubts(body, propose(_tree(body))) == []


@pytest.mark.parametrize(
    "swapped", [("palm",), ("f_arm", "palm"), ("arm", "f_arm", "palm")], ids=len
)
def test_hands_that_are_crossed_are_told(body: Body, swapped: tuple[str, ...]) -> None:
    bones = _exchanged(propose(_tree(body)), {f"{b}_L": f"{b}_R" for b in swapped})
    doubts = _doubts(body, bones)
    assert f"left and right look swapped at {', '.join(swapped)}" in doubts


def test_one_hand_on_the_other_side_is_crossed_only_if_both_are(body: Body) -> None:
    """A body modelled with one arm before its chest is no mistake."""
    places = np.array(body.places)
    hand = body.names.index("LeftHand")
    places[hand, 0] = -0.02
    doubts = _doubts(body, propose(_tree(body)), places)
    assert not any("swapped" in doubt for doubt in doubts)


@pytest.mark.parametrize(("share", "doubted"), [(0.85, True), (0.95, False)])
def test_arms_of_two_lengths_are_told(body: Body, share: float, doubted: bool) -> None:
    places = np.array(body.places)
    elbow, wrist = (body.names.index(f"Left{j}") for j in ("ForeArm", "Hand"))
    places[wrist] = places[elbow] + share * (places[wrist] - places[elbow])
    doubts = _doubts(body, propose(_tree(body)), places)
    assert any("the left f_arm is" in doubt for doubt in doubts) == doubted


@pytest.mark.parametrize(
    ("ahead_m", "doubted"), [(0.12, False), (0.0, False), (-0.01, False), (-0.03, True)]
)
def test_toes_that_point_backwards_are_told(body: Body, ahead_m: float, doubted: bool) -> None:
    """A joint that twists a thigh is below one that is kept too, and is no toe."""
    toes = [
        (name, body.names.index(f"{side}{joint}"), way)
        for side in ("Left", "Right")
        for name, joint, way in (
            (f"{side}ToeBase", "Foot", (0.0, -0.05, ahead_m)),
            (f"{side}UpLegTwist", "UpLeg", (0.0, -0.1, 0.0)),
        )
    ]
    walking = replace(
        body,
        names=(*body.names, *(name for name, _, _ in toes)),
        parents=(*body.parents, *(joint for _, joint, _ in toes)),
        places=np.vstack([body.places, *(body.places[joint] + way for _, joint, way in toes)]),
    )
    doubts = _doubts(walking, propose(_tree(walking)))
    assert any("the toes point backwards" in doubt for doubt in doubts) == doubted


def test_a_body_in_the_air_and_beside_the_origin_is_set_down_on_it(body: Body) -> None:
    """By its soles and its hips; its height and its lengths stay."""
    off = np.array([0.7, 0.5, -0.9])
    tree = Tree(body.names, np.array(body.parents), body.places + off)
    stand = stand_up(tree, propose(tree), body.vertices + off, exactly=False)
    points, hips = stand.points(body.vertices + off), body.names.index("Hips")
    assert points[:, 1].min() == pytest.approx(0.0, abs=1e-6)
    there = stand.points(tree.places)[hips]
    assert there[[0, 2]] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert np.ptp(points, axis=0) == pytest.approx(np.ptp(body.vertices, axis=0))
    assert stand.vectors(off) == pytest.approx(off)


@pytest.mark.parametrize(("share", "refused"), [(1.05e-6, False), (0.95e-6, True)])
def test_shoulders_a_millionth_of_the_body_apart_tell_its_left(
    body: Body, share: float, refused: bool
) -> None:
    """Head and hips lie on a line; the arms begin beside it."""
    places, at = np.array(body.places), {name: j for j, name in enumerate(body.names)}
    apart = share * np.ptp(body.vertices)
    places[at["Head"]] = places[at["Hips"]] + [0.0, 0.5, 0.0]
    places[at["LeftArm"]] = places[at["Hips"]] + [apart, 0.4, 0.0]
    places[at["RightArm"]] = places[at["Hips"]] + [0.0, 0.4, 0.0]
    tree, bones = _tree(replace(body, places=places)), propose(_tree(body))
    if refused:
        with pytest.raises(BodyError, match="do not tell up from left"):
            stand_up(tree, bones, body.vertices, exactly=False)
    else:
        stand = stand_up(tree, bones, body.vertices, exactly=False)
        assert stand.vectors(np.array([1.0, 0.0, 0.0]))[0] > 0.0
