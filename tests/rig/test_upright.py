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


@pytest.mark.parametrize(
    ("height", "told", "metre"),
    [
        (0.6, "", 1.0),
        (2.6, "", 1.0),
        (2.61, "foot", 0.3048),
        (6.0, "foot", 0.3048),
        (80.0, "inch", 0.0254),
        (85.0, "cm", 0.01),
        (260.0, "cm", 0.01),
        (600.0, "mm", 0.001),
    ],
)
def test_the_unit_is_one_that_makes_an_adult_else_one_that_makes_anybody(
    body: Body, height: float, told: str, metre: float
) -> None:
    """Adults are 1.3 to 2.1 m tall, anybody .6 to 2.6 m; of metres nothing is told."""
    stand = _stood_as_tall_as(body, height)
    assert [note.split(":")[0] for note in stand.notes] == (
        [f"its lengths are taken for {told}"] if told else []
    )
    assert stand.vectors(np.array([0.0, height, 0.0]))[1] == pytest.approx(height * metre)


@pytest.mark.parametrize("height", [0.05, 0.59, 590.0])
def test_nobody_is_less_than_60_cm_tall_in_any_unit(body: Body, height: float) -> None:
    stand = _stood_as_tall_as(body, height)
    told = f"{height:.4g} tall, which no usual unit makes a person: it is made 1.7 m"
    assert stand.notes == (told,)
    assert stand.vectors(np.array([0.0, height, 0.0]))[1] == pytest.approx(1.7)


def _stood_as_tall_as(body: Body, height: float) -> Stand:
    tree = _tree(body)
    vertices = np.array([[0.0, 0.0, 0.0], [0.0, height, 0.0]])
    return stand_up(tree, propose(tree), vertices, exactly=False)


def test_a_mesh_without_height_is_refused(body: Body) -> None:
    tree = _tree(body)
    with pytest.raises(BodyError, match="its mesh has no height"):
        stand_up(tree, propose(tree), body.vertices * (1.0, 0.0, 1.0), exactly=False)


def _straight(body: Body) -> Body:
    """Head above hips, and both shoulders equally high: it leans to no side."""
    places, at = np.array(body.places), {name: j for j, name in enumerate(body.names)}
    for joint, place in (
        ("Hips", (0.0, 1.0, 0.0)),
        ("Head", (0.0, 1.6, 0.0)),
        ("LeftArm", (0.2, 1.4, 0.0)),
        ("RightArm", (-0.2, 1.4, 0.0)),
    ):
        places[at[joint]] = place
    return replace(body, places=places)


@pytest.mark.parametrize(("degrees", "stands"), [(14.9, False), (15.1, True)])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_lean_of_15_degrees_is_no_posture_of_the_makers(
    body: Body, axis: int, degrees: float, stands: bool
) -> None:
    straight, turn = _straight(body), about_axis(axis, np.radians(degrees))
    stand, _ = _stood(straight, turn)
    np.testing.assert_allclose(stand.turn, turn.T if stands else np.eye(3), atol=1e-9)
    assert stand.notes == (
        (f"turned by {degrees:.0f}° to stand upright and look forward",) if stands else ()
    )


@pytest.mark.parametrize(("degrees", "told"), [(0.095, False), (0.105, True)])
def test_a_turn_is_told_from_a_tenth_of_a_degree_on(body: Body, degrees: float, told: bool) -> None:
    turn = about_axis(0, np.radians(degrees))
    stand, _ = _stood(_straight(body), turn, exactly=True)
    assert bool(stand.notes) == told
    np.testing.assert_allclose(stand.turn, turn.T, atol=1e-9)


def test_shoulders_of_two_heights_leave_the_body_undistorted(body: Body) -> None:
    """Left is what of the way between them is across the way up."""
    places = _straight(body).places
    places[body.names.index("LeftArm"), 1] += 0.05
    stand, _ = _stood(replace(body, places=places), np.eye(3), exactly=True)
    np.testing.assert_allclose(stand.turn, np.eye(3), atol=1e-9)


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


@pytest.mark.parametrize(("left_m", "right_m", "crossed"), [
    (-0.02, -0.7, False), (0.05, 0.7, False), (0.0, 0.1, False), (-0.1, 0.0, False),
    (-0.02, 0.02, True),
])  # fmt: skip
def test_one_hand_on_the_other_side_is_crossed_only_if_both_are(
    body: Body, left_m: float, right_m: float, crossed: bool
) -> None:
    """A body modelled with one arm before its chest is no mistake."""
    places = np.array(body.places)
    places[body.names.index("LeftHand"), 0] = left_m
    places[body.names.index("RightHand"), 0] = right_m
    doubts = _doubts(body, propose(_tree(body)), places)
    assert any("swapped" in doubt for doubt in doubts) == crossed


@pytest.mark.parametrize(("share", "doubted"), [(0.85, True), (0.95, False)])
def test_arms_of_two_lengths_are_told(body: Body, share: float, doubted: bool) -> None:
    places = np.array(body.places)
    elbow, wrist = (body.names.index(f"Left{j}") for j in ("ForeArm", "Hand"))
    places[wrist] = places[elbow] + share * (places[wrist] - places[elbow])
    doubts = _doubts(body, propose(_tree(body)), places)
    assert any("the left f_arm is" in doubt for doubt in doubts) == doubted


def _with_toes(body: Body, left_m: float, right_m: float) -> Body:
    """The body with toes so far ahead of its ankles, and with further joints on its legs."""
    more = [
        (f"{side}{name}", body.names.index(f"{side}{joint}"), way)
        for side, ahead_m in (("Left", left_m), ("Right", right_m))
        for name, joint, way in (
            ("ToeBase", "Foot", (0.0, -0.05, ahead_m)),
            ("Ankle", "Foot", (0.0, -0.02, 0.0)),
            ("UpLegTwist", "UpLeg", (0.0, -0.1, 0.0)),
        )
    ]
    return replace(
        body,
        names=(*body.names, *(name for name, _, _ in more)),
        parents=(*body.parents, *(joint for _, joint, _ in more)),
        places=np.vstack([body.places, *(body.places[joint] + way for _, joint, way in more)]),
    )


def _toes_are_doubted(body: Body) -> bool:
    doubts = _doubts(body, propose(_tree(body)))
    return any("the toes point backwards" in doubt for doubt in doubts)


@pytest.mark.parametrize(
    ("ahead_m", "doubted"),
    [(0.12, False), (0.0, False), (-0.01, False), (-0.019, False), (-0.021, True), (-0.03, True)],
)
def test_toes_that_point_backwards_are_told(body: Body, ahead_m: float, doubted: bool) -> None:
    """A joint that twists a thigh is below one that is kept too, and is no toe.

    Nor is a second joint of an ankle, which is kept itself.
    """
    assert _toes_are_doubted(_with_toes(body, ahead_m, ahead_m)) == doubted


def test_one_foot_that_points_backwards_is_a_posture(body: Body) -> None:
    assert not _toes_are_doubted(_with_toes(body, -0.1, 0.1))
    assert not _toes_are_doubted(_with_toes(body, 0.1, -0.1))


@pytest.mark.parametrize(("share", "doubted"), [(0.145, True), (0.155, False)])
def test_what_hangs_above_15_percent_of_the_height_is_no_toe(
    body: Body, share: float, doubted: bool
) -> None:
    walking = _with_toes(body, -0.1, -0.1)
    feet = [walking.names.index(f"{side}Foot") for side in ("Left", "Right")]
    walking.places[feet, 1] = share * walking.places[:, 1].max()
    assert _toes_are_doubted(walking) == doubted


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


@pytest.mark.parametrize(("ahead_m", "moved"), [
    (0.25, False), (0.3, False), (0.31, True), (-0.3, False), (-0.31, True),
])  # fmt: skip
def test_hips_up_to_30_cm_before_or_behind_the_origin_stay(
    body: Body, ahead_m: float, moved: bool
) -> None:
    places = _straight(body).places
    places[:, 2] += ahead_m
    tree = _tree(replace(body, places=places))
    stand = stand_up(tree, propose(tree), body.vertices, exactly=False)
    assert stand.shift[2] == (-ahead_m if moved else 0.0)


@pytest.mark.parametrize(("above_m", "moved"), [
    (0.04, False), (0.05, False), (0.052, True), (-0.05, False), (-0.052, True),
])  # fmt: skip
def test_soles_up_to_5_cm_off_the_ground_stay(body: Body, above_m: float, moved: bool) -> None:
    vertices = np.array(body.vertices)
    vertices[:, 1] -= vertices[:, 1].min()
    vertices[:, 1] += above_m
    tree = _tree(body)
    stand = stand_up(tree, propose(tree), vertices, exactly=False)
    assert stand.shift[1] == (-above_m if moved else 0.0)


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
