"""Swapped, jumping and missing markers are put in order."""

from __future__ import annotations

import numpy as np

from azee.capture.tracking import FADE_S, tracked

RATE = 100.0
TIMES = np.arange(200) / RATE


def two_markers() -> np.ndarray:
    """Two markers that move slowly, 3 cm apart."""
    first = np.stack([0.02 * np.sin(4 * TIMES), 0.01 * TIMES, 0 * TIMES], axis=1)
    return np.stack([first, first + [0.0, 0.03, 0.0]], axis=1)


def test_nothing_is_changed_where_nothing_is_wrong() -> None:
    found = tracked(two_markers(), RATE)
    np.testing.assert_array_equal(found.positions, two_markers())
    assert found.trust.min() == 1.0
    assert not found.relabelled.any()
    assert not found.gaps.any()


def test_markers_swapped_for_three_frames_get_their_names_back() -> None:
    wrong = two_markers()
    wrong[50:53] = wrong[50:53, ::-1]
    found = tracked(wrong, RATE)
    np.testing.assert_array_equal(found.positions, two_markers())
    assert np.flatnonzero(found.relabelled).tolist() == [50, 51, 52]


def test_short_gaps_are_bridged() -> None:
    wrong = two_markers()
    wrong[80:85, 0] = np.nan
    found = tracked(wrong, RATE)
    assert np.abs(found.positions - two_markers()).max() < 2e-4
    assert found.trust.min() == 1.0
    assert found.gaps.sum() == 5


def test_trust_fades_before_and_after_long_gaps() -> None:
    wrong = two_markers()
    wrong[80:130, 0] = np.nan
    trust = tracked(wrong, RATE).trust
    assert (trust[80:130, 0] == 0.0).all()
    assert (trust[:, 1] == 1.0).all()
    assert trust[80 - int(FADE_S * RATE) - 1, 0] == 1.0
    assert np.abs(np.diff(trust[:, 0])).max() < 0.12


def test_a_jump_away_and_back_is_a_gap() -> None:
    wrong = two_markers()
    wrong[60, 1] += [0.0, 0.0, 0.2]
    found = tracked(wrong, RATE)
    assert np.abs(found.positions - two_markers()).max() < 1e-5
    assert np.argwhere(found.gaps).tolist() == [[60, 1]]


def test_a_fast_movement_is_no_jump() -> None:
    fast = two_markers()
    fast[100:] += [0.0, 0.0, 0.2]
    np.testing.assert_array_equal(tracked(fast, RATE).positions, fast)


def test_markers_that_are_never_seen_have_no_trust() -> None:
    wrong = two_markers()
    wrong[:, 0] = np.nan
    found = tracked(wrong, RATE)
    assert (found.trust[:, 0] == 0.0).all()
