"""Via points, and the collisions that they avoid."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from azee.motion.curves.avoidance import CollisionAvoidance
from azee.motion.curves.capsule_overlap import CapsuleOverlaps
from azee.motion.curves.limb_curves import LimbCurve, LimbKey
from azee.motion.curves.movement import Movement
from azee.motion.curves.via_points import ViaPoint
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.schedule import bind
from azee.score.interval import Interval
from azee.score.score import Key
from azee_rig.load import load_rig
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side


@given(st.floats(0.0, 1.0), st.floats(0.1, 2.0))
def test_a_via_point_sets_in_and_ends_without_a_jerk_and_reaches_its_peak(
    peak: float, length: float
) -> None:
    via_point = ViaPoint(np.array([0]), np.array([1.0]), 1.0, 1.0 + length, peak)
    times = np.linspace(1.0, 1.0 + length, 2001)
    weight = via_point.weight(times)
    assert np.all((weight >= 0) & (weight <= 1 + 1e-12))
    assert weight.max() == pytest.approx(1.0, abs=1e-4)
    assert 0.19 <= (times[weight.argmax()] - 1.0) / length <= 0.81
    step = length / 2000
    for end in (weight[:4], weight[:-5:-1]):
        assert abs(np.diff(end)[0]) < 1e-6
        assert abs(np.diff(end, 2)[0]) / step**2 < 40.0 / length**2
    speed, acceleration = via_point.fastest
    assert np.abs(np.diff(weight)).max() / step == pytest.approx(speed, rel=0.02)
    assert np.abs(np.diff(weight, 2)).max() / step**2 == pytest.approx(acceleration, rel=0.02)
    outside = np.zeros((2, 1))
    via_point.add_to(outside, np.array([0.5, 1.0 + length + 0.1]))
    assert not outside.any()


@cache
def body() -> Evaluator:
    return Evaluator(load_rig(), Side.RIGHT)


def from_raised_to_behind() -> Movement:
    """A raised hand goes down behind the hip; nothing else moves."""
    rig = load_rig()
    limbs, index = Limbs.of(rig.coordinates), rig.coordinates.index
    before, beside = rig.coordinates.idle.copy(), rig.coordinates.idle.copy()
    for name, a, b in (
        ("arm_R.flexion", 78, -18),
        ("arm_R.abduction", 17, 8),
        ("arm_R.rotation", 43, 42),
        ("f_arm_R.flexion", 88, 21),
    ):
        before[index[name]], beside[index[name]] = math.radians(a), math.radians(b)
    keys = (before, beside)
    curves = {
        limb: LimbCurve(
            tuple(LimbKey(float(i), q[members]) for i, q in enumerate(keys)),
            rig.coordinates.idle[members],
        )
        for limb, members in limbs.members.items()
    }
    return Movement(rig.coordinates, limbs, curves)


def avoidance(*in_use: tuple[Interval, frozenset[str]]) -> CollisionAvoidance:
    rig = load_rig()
    nothing = flatten(Key(Fraction(1)))
    schedule = bind(nothing, rig, body().binding, Limbs.of(rig.coordinates))
    return CollisionAvoidance(body(), schedule, IntervalIndex(in_use), CapsuleOverlaps(body()))


TIMES = np.linspace(0.0, 1.0, 61)


def deepest(movement: Movement, times: NDArray[np.float64] = TIMES) -> float:
    overlaps = CapsuleOverlaps(body())
    depth = overlaps.depths(movement.sample(times), overlaps.axis_distances(()))
    return float(depth[:, ~overlaps.same_hand].max())


def test_a_movement_through_the_body_is_led_round_it_between_the_same_keys() -> None:
    straight = from_raised_to_behind()
    round_it = avoidance().avoid_collisions(straight)
    ends = np.array([0.0, 1.0])
    assert round_it.sample(ends) == pytest.approx(straight.sample(ends))
    allowed = max(0.0, deepest(straight, ends))
    assert deepest(straight) > allowed + 0.01
    assert deepest(round_it) < allowed + 0.003


def test_a_limb_that_a_block_needs_gets_no_via_point() -> None:
    needed = (Interval(Fraction(0), Fraction(1)), frozenset(("arm_R",)))
    assert avoidance(needed).avoid_collisions(from_raised_to_behind()).via_points == ()


def test_limbs_that_may_give_way_come_in_the_order_of_their_names() -> None:
    """In a set they would come in another order in every process."""
    movement, avoiding = from_raised_to_behind(), avoidance()
    found = {}
    for n in range(len(avoiding.overlaps.same_hand)):
        free = avoiding._free_limbs(movement, 0.5, n)
        assert all((start, end) == (0.0, 1.0) for _, start, end in free)
        found[tuple(limb for limb, _, _ in free)] = avoiding.overlaps.names(n)
    assert {("arm_L", "arm_R"), ("index_R", "middle_R"), ("index_L", "thumb_L")} <= {*found}
    assert len(found) > 10
    assert all([*limbs] == sorted(limbs) for limbs in found)
