"""Detours, and what they lead round."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from azee.motion.curves.avoidance import Clearing
from azee.motion.curves.capsule_overlap import Overlaps
from azee.motion.curves.limb_curves import LimbKey, LimbTrack
from azee.motion.curves.movement import Movement
from azee.motion.curves.via_points import Swerve
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.spans import Spans
from azee.motion.tasks.timed_task import bind
from azee.score.interval import Interval
from azee.score.score import Key
from azee_rig.load import load_rig
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side


@given(st.floats(0.0, 1.0), st.floats(0.1, 2.0))
def test_a_swerve_begins_and_ends_at_rest_and_reaches_its_peak(peak: float, length: float) -> None:
    swerve = Swerve(np.array([0]), np.array([1.0]), 1.0, 1.0 + length, peak)
    times = np.linspace(1.0, 1.0 + length, 2001)
    share = swerve.share(times)
    assert np.all((share >= 0) & (share <= 1 + 1e-12))
    assert share.max() == pytest.approx(1.0, abs=1e-4)
    assert 0.19 <= (times[share.argmax()] - 1.0) / length <= 0.81
    step = length / 2000
    for end in (share[:4], share[:-5:-1]):
        assert abs(np.diff(end)[0]) < 1e-6
        assert abs(np.diff(end, 2)[0]) / step**2 < 40.0 / length**2
    outside = np.zeros((2, 1))
    swerve.add_to(outside, np.array([0.5, 1.0 + length + 0.1]))
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
    tracks = {
        limb: LimbTrack(
            tuple(LimbKey(float(i), q[members]) for i, q in enumerate(keys)),
            rig.coordinates.idle[members],
        )
        for limb, members in limbs.members.items()
    }
    return Movement(rig.coordinates, limbs, tracks)


def clearing(*holders: tuple[Interval, frozenset[str]]) -> Clearing:
    rig = load_rig()
    nothing = flatten(Key(Fraction(1)))
    score = bind(nothing, rig, body().binding, Limbs.of(rig.coordinates))
    return Clearing(body(), score, Spans(holders), Overlaps(body()))


TIMES = np.linspace(0.0, 1.0, 61)


def deepest(movement: Movement, times: NDArray[np.float64] = TIMES) -> float:
    overlaps = Overlaps(body())
    depth = overlaps.depth(movement.sample(times), overlaps.reach(()))
    return float(depth[:, ~overlaps.same_hand].max())


def test_a_way_through_the_body_leads_round_it_between_the_same_keys() -> None:
    straight = from_raised_to_behind()
    round_it = clearing().cleared(straight)
    ends = np.array([0.0, 1.0])
    assert round_it.sample(ends) == pytest.approx(straight.sample(ends))
    allowed = max(0.0, deepest(straight, ends))
    assert deepest(straight) > allowed + 0.01
    assert deepest(round_it) < allowed + 0.003


def test_what_a_block_needs_does_not_swerve() -> None:
    needed = (Interval(Fraction(0), Fraction(1)), frozenset(("arm_R",)))
    assert clearing(needed).cleared(from_raised_to_behind()).swerves == ()
