import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from azee.clip import spline
from azee.clip.spline import cubic_spline, minimum_jerk


def test_minimum_jerk_is_at_rest_at_both_ends() -> None:
    h = 1e-4
    for end in (0.0, 1.0):
        near = minimum_jerk(np.abs(end - np.array([0.0, h, 2 * h])))
        assert np.abs(near - end).max() < 1e-10
    middle = minimum_jerk(np.array([0.5 - h, 0.5, 0.5 + h]))
    assert middle[1] == 0.5
    assert (middle[2] - middle[0]) / (2 * h) == pytest.approx(1.875, abs=1e-6)


@given(st.floats(-2, 3))
def test_minimum_jerk_rises_from_0_to_1_and_is_symmetric(tau: float) -> None:
    s = float(minimum_jerk(tau))
    assert 0 <= s <= 1
    assert s == pytest.approx(1 - float(minimum_jerk(1 - tau)), abs=1e-12)
    assert float(minimum_jerk(tau + 0.01)) >= s


@given(
    st.lists(st.floats(0.05, 1), min_size=1, max_size=9),
    st.lists(st.floats(-2, 2), min_size=4, max_size=4),
)
def test_splines_reproduce_what_their_knots_can_tell(
    gaps: list[float], coefficients: list[float]
) -> None:
    x = np.cumsum([0.0, *gaps])
    degree = min(3, len(x) - 1)
    f = np.polynomial.Polynomial(coefficients[: degree + 1])
    at = np.linspace(x[0], x[-1], 23)
    got = cubic_spline(x, np.stack([f(x), -f(x)], axis=1), at)
    assert got == pytest.approx(np.stack([f(at), -f(at)], axis=1), abs=1e-8)


def test_a_spline_goes_through_its_samples_without_a_kink() -> None:
    rng = np.random.default_rng(3)
    x, y = np.array([0.0, 0.2, 0.5, 0.6, 1.0]), rng.normal(size=(5, 3))
    assert cubic_spline(x, y, x) == pytest.approx(y, abs=1e-12)
    h = 1e-4
    for knot in x[1:-1]:
        p = cubic_spline(x, y, knot + h * np.array([-2, -1, 0, 1, 2]))
        slope_jump = (p[4] - p[2]) / (2 * h) - (p[2] - p[0]) / (2 * h)
        curve_jump = (p[4] - 2 * p[3] + p[2]) / h**2 - (p[2] - 2 * p[1] + p[0]) / h**2
        assert np.abs(slope_jump).max() < 0.2
        assert np.abs(curve_jump).max() < 2.0


def test_times_are_evaluated_a_chunk_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(5)
    x, y = np.cumsum(rng.uniform(0.1, 1, 9)), rng.normal(size=(9, 2))
    at = np.sort(rng.uniform(x[0], x[-1], 50))
    whole = cubic_spline(x, y, at)
    monkeypatch.setattr(spline, "CHUNK", 7)
    assert (cubic_spline(x, y, at) == whole).all()
    assert cubic_spline(x, y, at[:0]).shape == (0, 2)
