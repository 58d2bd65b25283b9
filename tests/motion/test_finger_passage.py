"""Fingers that pass round fingers between two handshapes."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.motion.curves.capsule_overlap import CapsuleOverlaps
from azee.motion.curves.finger_passage import FingerPassage
from azee.motion.curves.limb_curves import LimbCurve, LimbKey
from azee.motion.curves.movement import Movement
from azee.motion.curves.passage_search import GRID_RAD, MOST_RAD_S, SAMPLES, SHARES, PassageSearch
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.limbs import Limbs
from azee.score.interval import Interval
from azee_rig.load import load_rig
from azee_solver.digit_skin import digit_skin
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side

WAY_S = 0.2
THUMB = ("thumb_R_1.flexion", "thumb_R_1.abduction", "thumb_R_1.roll",
         "thumb_R_2.flexion", "thumb_R_3.flexion")  # fmt: skip
FINGERS = ("index", "middle", "ring", "little")
CLOSED = (77, 86, 42)
LITTLE = (75, 81, 40)
SHAPES = {
    "thumb over a fist": (
        (73, 84, 38), (77, 90, 42), CLOSED, LITTLE, (-61, 54, -14, 52, 74)
    ),
    "thumb between two fingers": (
        (3, 6, 4), (38, 5, 4), CLOSED, LITTLE, (-11, 32, 39, 36, -8)
    ),
    "thumb below two fingers": (
        (72, 67, 31), (60, 58, 34), CLOSED, LITTLE, (-18, 53, 39, 60, -13)
    ),
}  # fmt: skip
"""Joints of index, middle, ring and little finger and of the thumb, degrees."""
TOUCHES = {
    "fingertips on the thumb": (
        (14, 100, 45), (28, 100, 47), (15, 100, 50), (20, 97, 48), (-32, 35, 2, 54, 52)
    ),
    "little finger out": (
        (73, 84, 38), (76, 89, 42), (77, 86, 42), (5, 8, 5), (-52, 59, -15, 60, 25)
    ),
}  # fmt: skip
"""Handshapes between which a thumb leaves a touch."""


@cache
def overlaps() -> CapsuleOverlaps:
    return CapsuleOverlaps(Evaluator(load_rig(), Side.RIGHT))


@cache
def search() -> PassageSearch:
    return PassageSearch(overlaps(), load_rig().coordinates)


def posture(shape: str) -> NDArray[np.float64]:
    coordinates = load_rig().coordinates
    q = coordinates.idle.copy()
    *fingers, thumb = (SHAPES | TOUCHES)[shape]
    for finger, angles in zip(FINGERS, fingers, strict=True):
        q[coordinates.index[f"{finger}_R_1.deviation"]] = 0.0
        for phalanx, angle in enumerate(angles, start=1):
            q[coordinates.index[f"{finger}_R_{phalanx}.flexion"]] = math.radians(angle)
    for name, angle in zip(THUMB, thumb, strict=True):
        q[coordinates.index[name]] = math.radians(angle)
    return q


def straight(first: str, second: str) -> Movement:
    coordinates = load_rig().coordinates
    limbs, a, b = Limbs.of(coordinates), posture(first), posture(second)
    curves = {
        limb: LimbCurve((LimbKey(0.0, a[of]), LimbKey(WAY_S, b[of])), coordinates.idle[of])
        for limb, of in limbs.members.items()
    }
    return Movement(coordinates, limbs, curves)


def passed(movement: Movement, *in_use: tuple[Interval, frozenset[str]]) -> Movement:
    found = FingerPassage(search(), IntervalIndex(in_use)).via_points(movement)
    return replace(movement, via_points=tuple(found))


def deepest(movement: Movement) -> float:
    """How deep any two digits are in each other on the way, beyond how they are at its ends."""
    q = movement.sample(np.linspace(0.0, WAY_S, 41))
    depths = overlaps().depths(q, overlaps().axis_distances(()))[:, overlaps().same_hand]
    return float(np.max(depths - np.maximum(0.0, np.maximum(depths[0], depths[-1]))))


@pytest.mark.parametrize("first", SHAPES)
@pytest.mark.parametrize("second", SHAPES)
def test_a_thumb_goes_round_fingers_between_the_same_handshapes(first: str, second: str) -> None:
    if first == second:
        assert passed(straight(first, second)).via_points == ()
        return
    through = straight(first, second)
    round_them = passed(through)
    ends = np.array([0.0, WAY_S])
    assert round_them.sample(ends) == pytest.approx(through.sample(ends))
    if "thumb over a fist" in (first, second):
        assert deepest(through) > 0.008
    assert deepest(round_them) < 0.002
    times = np.linspace(0.0, WAY_S, 201)
    added = np.diff(round_them.sample(times) - through.sample(times), axis=0) / (WAY_S / 200)
    assert np.abs(added).max() < 2 * MOST_RAD_S


def test_a_thumb_that_a_block_needs_stays_where_it_is() -> None:
    needed = (Interval(Fraction(0), Fraction(1)), frozenset(("thumb_R",)))
    movement = straight("thumb over a fist", "thumb between two fingers")
    thumb = movement.limbs.members["thumb_R"]
    for via_point in passed(movement, needed).via_points:
        assert not {*thumb.tolist()} & {*via_point.members.tolist()}


def test_a_way_is_searched_once_and_what_is_found_does_not_depend_on_what_came_before() -> None:
    movement = straight("thumb over a fist", "thumb between two fingers")
    grid = np.round(movement.sample(WAY_S * SHARES) / GRID_RAD) * GRID_RAD
    members = movement.limbs.members["thumb_R"]
    one, other = (PassageSearch(overlaps(), load_rig().coordinates) for _ in range(2))
    found = one.offsets(grid, members, WAY_S, "R")
    assert found is not None
    assert one.offsets(grid + GRID_RAD / 5, members, WAY_S + 1e-5, "R") is found
    assert other.offsets(grid - GRID_RAD / 5, members, WAY_S, "R") == pytest.approx(found, abs=0)
    assert one.offsets(grid, members, 2 * WAY_S, "R") is not found
    assert one.offsets(grid + GRID_RAD, members, WAY_S, "R") is not found


def test_no_sample_of_a_way_is_far_from_the_next_where_a_thumb_leaves_a_touch() -> None:
    assert SHARES[[0, -1]] == pytest.approx([0.0, 1.0])
    assert np.diff(SHARES) == pytest.approx(1.0 / (SAMPLES + 1))
    assert 0.2 * np.diff(SHARES).max() < 0.0125


def test_a_thumb_leaves_a_touch_without_going_through_the_finger() -> None:
    """E to I: the capsules are as deep in the touch as on the way, the skins only on the way."""
    movement = straight(*TOUCHES)
    times = np.linspace(0.0, WAY_S, 41)

    def deepest_skin(way: Movement) -> float:
        depths = digit_skin(load_rig(), "R").depths(way.sample(times))
        return float(np.max(depths - np.maximum(depths[0], depths[-1])))

    assert deepest_skin(movement) > 0.003
    assert deepest_skin(passed(movement)) < 0.002
