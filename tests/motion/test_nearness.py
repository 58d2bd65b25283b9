"""Frames keep nothing farther apart than the key postures beside them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import azee
from azee.motion.projection.nearness import MOST_OVERLAP_M, SWAY_M, in_frames, keys_beside
from azee_rig.load import load_rig
from azee_solver.broadphase import Collisions
from azee_solver.collisions import depths
from azee_solver.outcome import Outcome

RIG = load_rig()
IDLE = RIG.coordinates.idle
NAMES = RIG.capsules.names
AT_THE_CHEEK = """
key .2
    cstr
        :#hamflathand('yield = 20, 'thumb = .thumb-across)
        :#hand-faces('fingers = ^up, 'palm = :way('out = -.414, 'fwd = 1))
        place @I_KNt(s, 2) midpoint(@EAR(s), @CK(s)) 'contact
"""
PINCHES_AT_THE_MOUTH = """
sync
    'HANDS
    key .808
        cstr
            :#hand-faces(
                'fingers = :way('out = -.5, 'up = 1, 'fwd = .5),
                'palm = :way('out = -1, 'up = -.663, 'fwd = .327)
            )
            place @I_KNt(s, 2) midpoint(@NO(s), @MO(s)) 'contact
    'OPEN
    key .1 (:#hand-of('yield = 20, 'index = :finger-bent, 'thumb = .thumb-opposed('yield = 20)))
    'start 'HANDS:start
    'CLOSED
    key 0
        cstr
            morph 'index_bend s .84 'soft 'index_hook s .31 'soft
            place @T_TIP(s) @I_TIP(s) 'contact
    'start 'HANDS:start:.222
    'AGAIN
    key 0 (:#hand-of('yield = 20, 'index = :finger-bent, 'thumb = .thumb-opposed('yield = 20)))
    'start 'HANDS:start:.343
"""


def pair(first: str, second: str, reach_m: float, margin_m: float) -> Collisions:
    """Two capsules of the body that must stay so far apart."""
    both = np.array([[NAMES.index(first), NAMES.index(second)]])
    return Collisions(both, np.array([reach_m]), np.array([margin_m]))


def distance_m(collisions: Collisions, q: NDArray[np.float64]) -> float:
    """How far the axes of the two capsules are apart."""
    bare = Collisions(collisions.pairs, np.zeros(1), np.zeros(1))
    return -float(depths(RIG, bare, q)[0])


def test_the_keys_beside_an_instant_are_the_last_before_and_the_first_after_it() -> None:
    keys_s = np.array([0.0, 0.5, 1.0])
    beside = keys_beside(keys_s, np.array([-0.1, 0.0, 0.2, 0.5, 0.75, 1.0, 1.2]))
    assert beside == [(0,), (0,), (0, 1), (1,), (1, 2), (2,), (2,)]


def test_without_keys_nothing_is_beside() -> None:
    assert keys_beside(np.array([]), np.array([0.0, 1.0])) == [(), ()]


def test_what_stays_off_the_trunk_stays_a_little_farther_off_in_frames() -> None:
    off_trunk, off_hand = (
        pair("forearm_R", "trunk_5", 0.1, 0.004),
        pair("index_R_2", "index_L_2", 0.02, 0.0),
    )
    assert in_frames(RIG, off_trunk, ()).reach == pytest.approx([0.1 + SWAY_M])
    assert in_frames(RIG, off_hand, ()).reach == pytest.approx([0.02])


@pytest.mark.parametrize("nearer_m", [0.001, 0.004, 0.0054])
def test_what_is_nearer_in_a_key_may_be_as_near_in_frames(nearer_m: float) -> None:
    there = distance_m(pair("forearm_R", "trunk_5", 0.0, 0.0), IDLE)
    collisions = pair("forearm_R", "trunk_5", there + nearer_m, 0.004)
    found = in_frames(RIG, collisions, [IDLE])
    assert found.reach == pytest.approx([there])
    assert found.margin == pytest.approx([0.004])


def test_the_nearest_of_the_keys_counts() -> None:
    apart = np.array(IDLE)
    apart[RIG.coordinates.index["arm_R.abduction"]] += 0.3
    there = distance_m(pair("forearm_R", "trunk_5", 0.0, 0.0), IDLE)
    collisions = pair("forearm_R", "trunk_5", there + 0.003, 0.004)
    assert distance_m(collisions, apart) > there + 0.01
    assert in_frames(RIG, collisions, [apart, IDLE]).reach == pytest.approx([there])
    assert in_frames(RIG, collisions, [apart]).reach == pytest.approx([there + 0.003 + SWAY_M])


def test_frames_overlap_no_deeper_than_is_not_seen_whatever_the_key_does() -> None:
    there = distance_m(pair("forearm_R", "trunk_5", 0.0, 0.0), IDLE)
    collisions = pair("forearm_R", "trunk_5", there + 0.03, 0.004)
    found = in_frames(RIG, collisions, [IDLE])
    touching = there + 0.03 - 0.004
    assert found.reach == pytest.approx([touching - MOST_OVERLAP_M])
    assert MOST_OVERLAP_M < 0.003


@pytest.mark.parametrize("text", [AT_THE_CHEEK, PINCHES_AT_THE_MOUTH])
def test_what_keys_meet_close_to_the_body_frames_meet(text: str) -> None:
    report = azee.compile(text, life=False).report
    assert not [c.reason for c in report.constraints if c.outcome is Outcome.MISSED]
