"""Peaks of joints and times of blocks, on made-up movements."""

from __future__ import annotations

import math

import numpy as np
import pytest

from azee.quality.measures import peaks


def test_peaks_of_a_swing_are_those_of_its_derivatives() -> None:
    fps, omega = 500.0, 2.0 * math.pi
    times = np.arange(int(2 * fps)) / fps
    still = np.zeros_like(times)
    found = peaks(np.stack([still, np.sin(omega * times)], axis=1), fps, ("a", "b"), lead_s=0.5)
    (peak,) = found
    assert peak.coordinate == "b"
    assert peak.speed == pytest.approx(omega, rel=1e-3)
    assert peak.acceleration == pytest.approx(omega**2, rel=1e-3)
    assert peak.jerk == pytest.approx(omega**3, rel=1e-3)
    assert (peak.fastest_s + 0.5) % 0.5 == pytest.approx(0.0, abs=0.01) or (
        peak.fastest_s + 0.5
    ) % 0.5 == pytest.approx(0.5, abs=0.01)


def test_a_clip_of_one_frame_has_no_peaks() -> None:
    assert peaks(np.zeros((1, 2)), 30.0, ("a", "b"), lead_s=0.0) == ()
