"""Figures of recordings: points that move at known speeds, in any unit."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.quality.signing_dynamics import (
    SHOULDERS_M,
    STOPPED_M_S,
    averaged,
    longest_run,
    signing_dynamics,
    speeds,
)

Array = NDArray[np.float64]
PIXELS = 500.0
FPS = 25.0


def recording(frames: int) -> Array:
    """Shoulders .36 m apart at 500 pixels a metre; nothing moves."""
    points = np.zeros((frames, 5, 2))
    points[:, 0, 0], points[:, 1, 0] = 0.18 * PIXELS, -0.18 * PIXELS
    return points


def test_a_wrist_at_an_even_speed_has_it_as_every_percentile() -> None:
    points = recording(100)
    points[:, 3, 1] = 0.5 * PIXELS * np.arange(100) / FPS
    found = signing_dynamics(points, FPS)
    right, left = found.right_wrist, found.left_wrist
    assert right is not None
    assert left is not None
    for speed in (right.median_m_s, right.p95_m_s, right.largest_m_s):
        assert speed == pytest.approx(0.5)
    assert left.largest_m_s == 0.0
    assert found.both_stopped_share == 0.0


def test_hands_that_stop_for_a_while_are_stopped_for_its_share() -> None:
    """41 of 97 speeds are zero: those between averages of the 44 frames at rest alone."""
    points = recording(100)
    way = np.concatenate([np.arange(57), np.full(43, 56.0)])
    points[:, 2, 0] = way * 0.02 * PIXELS
    found = signing_dynamics(points, FPS)
    assert found.both_stopped_share == pytest.approx(41 / 97)
    assert found.left_wrist is not None
    assert found.left_wrist.p95_m_s == pytest.approx(0.5)


def test_a_head_at_an_even_speed_and_then_still() -> None:
    points = recording(103)
    points[:, 4, 0] = 0.03 * PIXELS * np.minimum(np.arange(103), 51) / FPS
    found = signing_dynamics(points, FPS)
    # 49 speeds of 3 cm/s, two while the average runs in, 49 of nothing.
    assert found.head_mean_cm_s == pytest.approx(3.0 * 50 / 100)
    assert found.head_p95_cm_s == pytest.approx(3.0)
    assert found.head_longest_still_s == pytest.approx(49 / FPS)


def test_shoulders_count_as_their_middle_and_give_the_scale() -> None:
    points = recording(50)
    points[:, :, 0] += (0.02 * PIXELS * np.arange(50) / FPS)[:, None]
    found = signing_dynamics(points, FPS)
    assert found.shoulders_mean_cm_s == pytest.approx(2.0)
    twice = signing_dynamics(points * 7.0, FPS)
    assert twice.shoulders_mean_cm_s == pytest.approx(2.0)


def test_what_was_not_seen_has_no_figure() -> None:
    points = recording(20)
    points[:, 2] = np.nan
    found = signing_dynamics(points, FPS)
    assert found.left_wrist is None
    assert found.both_stopped_share is None
    assert found.right_wrist is not None


def test_a_recording_of_three_frames_has_no_speeds() -> None:
    assert signing_dynamics(recording(3), FPS).head_mean_cm_s is None
    assert len(averaged(np.zeros((2, 3)))) == 0
    assert len(speeds(np.zeros((4, 3)), FPS)) == 1


def test_the_longest_run() -> None:
    hits = np.array([1, 0, 1, 1, 1, 0, 1, 1], dtype=bool)
    assert longest_run(hits) == 3
    assert longest_run(hits[:0]) == 0


def test_a_wrist_as_fast_as_one_that_stops_has_not_stopped() -> None:
    """Four points are the least that a speed is measured of; these make it the limit exactly."""
    points = recording(4) / PIXELS

    def speed(step: float) -> float:
        points[3, 3, 1] = step
        return float(speeds(points[:, 3] / 0.36 * SHOULDERS_M, FPS)[0])

    near = 0.012 + np.spacing(0.012) * np.arange(-50, 51)
    step = next(float(s) for s in near if speed(s) == STOPPED_M_S)
    points[3, 3, 1] = step
    assert signing_dynamics(points, FPS).both_stopped_share == 0.0
    points[3, 3, 1] = step * (1.0 - 1e-12)
    assert signing_dynamics(points, FPS).both_stopped_share == 1.0
