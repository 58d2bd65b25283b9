import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from azee.clip.spline import minimum_jerk
from azee.motion.curves.minimum_jerk import OVERSHOOT, MinimumJerkCurve

GAPS = st.lists(st.floats(0.05, 1), min_size=1, max_size=9)


@given(GAPS)
def test_samples_of_a_minimum_jerk_movement_give_that_movement(gaps: list[float]) -> None:
    x = np.cumsum([0.0, *gaps])
    f = minimum_jerk(x / x[-1])
    at = np.linspace(x[0], x[-1], 23)
    got = MinimumJerkCurve(x, np.stack([f, -2 * f], axis=1))(at)
    want = minimum_jerk(at / x[-1])
    assert got == pytest.approx(np.stack([want, -2 * want], axis=1), abs=1e-8)


@given(GAPS, st.integers(0, 99))
def test_a_curve_goes_through_its_samples_near_them_and_rests_at_its_ends(
    gaps: list[float], seed: int
) -> None:
    x = np.cumsum([0.0, *gaps])
    y = np.random.default_rng(seed).normal(size=(len(x), 3))
    assert MinimumJerkCurve(x, y)(x) == pytest.approx(y, abs=1e-9)
    h = 1e-5
    for end, inward in ((x[0], h), (x[-1], -h)):
        p = MinimumJerkCurve(x, y)(end + inward * np.arange(3))
        assert np.abs(np.diff(p, axis=0)).max() < 1e-7
    far = MinimumJerkCurve(x, y)(np.linspace(x[0], x[-1], 200))
    room = OVERSHOOT * np.ptp(y, axis=0) + 1e-9
    assert np.all((far > y.min(axis=0) - room) & (far < y.max(axis=0) + room))


def test_a_curve_has_no_kink_where_pieces_meet_of_minimum_jerk_or_monotone() -> None:
    rng = np.random.default_rng(3)
    for x in (np.array([0.0, 0.2, 0.5, 0.6, 1.0]), np.array([0.0, 0.95, 1.0])):
        y, h = rng.normal(size=(len(x), 3)), 1e-4
        for knot in x[1:-1]:
            p = MinimumJerkCurve(x, y)(knot + h * np.array([-2, -1, 0, 1, 2]))
            slope_jump = (p[4] - p[2]) / (2 * h) - (p[2] - p[0]) / (2 * h)
            curve_jump = (p[4] - 2 * p[3] + p[2]) / h**2 - (p[2] - 2 * p[1] + p[0]) / h**2
            assert np.abs(slope_jump).max() < 0.05 * np.abs(p[4] - p[0]).max() / h
            third = 60 * np.abs(np.diff(y, axis=0)).max() / np.diff(x).min() ** 3
            assert np.abs(curve_jump).max() < 10 * h * third
