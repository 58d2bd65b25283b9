"""Paths: where they start, end and pass, and how evenly."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from azee_solver import path as paths

A, B = np.array([0.0, 0.0, 0.0]), np.array([2.0, 0.0, 0.0])
UP = np.array([0.0, 1.0, 0.0])
FORWARD = np.array([0.0, 0.0, 1.0])

coordinate = st.floats(-2.0, 2.0).map(lambda x: round(x, 3))
points = st.tuples(coordinate, coordinate, coordinate).map(np.array)


def steps(curve: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.linalg.norm(np.diff(curve, axis=0), axis=1))


def test_straight_is_even() -> None:
    t = np.linspace(0, 1, 5)
    np.testing.assert_allclose(paths.straight(A, B, t)[:, 0], 2 * t)


def test_an_arc_passes_its_apex_half_way_at_even_angles() -> None:
    t = np.linspace(0, 1, 9)
    curve = paths.arc(A, B, UP, t)
    np.testing.assert_allclose(curve[[0, 4, 8]], np.array([A, [1, 1, 0], B]), atol=1e-12)
    assert np.ptp(steps(curve)) < 1e-12
    np.testing.assert_allclose(np.linalg.norm(curve - [1, 0, 0], axis=1), 1.0)


def test_a_deep_arc_is_more_than_half_a_circle() -> None:
    curve = paths.arc(A, B, 3 * UP, np.linspace(0, 1, 101))
    assert curve[:, 0].min() < -0.3
    assert curve[:, 1].max() == pytest.approx(3.0)


def test_an_arc_without_bulge_is_straight_and_one_without_chord_is_undefined() -> None:
    np.testing.assert_allclose(paths.arc(A, B, 0 * UP, 0.25), [0.5, 0, 0])
    np.testing.assert_allclose(paths.arc(A, B, np.array([0.5, 0, 0]), 0.25), [0.5, 0, 0])
    assert np.isnan(paths.arc(A, A, UP, 0.5)).all()
    np.testing.assert_allclose(paths.arc(A, A, 0 * UP, 0.5), A)


@given(points, points, points)
def test_an_arc_begins_and_ends_where_it_should(
    start: NDArray[np.float64], end: NDArray[np.float64], bulge: NDArray[np.float64]
) -> None:
    curve = paths.arc(start, end, bulge, np.array([0.0, 1.0]))
    if np.isnan(curve).any():
        assert np.linalg.norm(end - start) < 1e-6
    else:
        np.testing.assert_allclose(curve, [start, end], atol=1e-7)


def test_a_whole_turn_returns_and_begins_at_the_top() -> None:
    t = np.linspace(0, 1, 41)
    curve = paths.circle(A, A, FORWARD, 0.5, 1.0, t)
    np.testing.assert_allclose(curve[[0, 40]], [A, A], atol=1e-12)
    centre = np.array([0.0, -0.5, 0.0])
    np.testing.assert_allclose(np.linalg.norm(curve - centre, axis=1), 0.5)
    assert curve[10, 0] < 0  # counter-clockwise about the axis that points at the viewer


def test_a_circle_about_the_upright_begins_in_front() -> None:
    curve = paths.circle(A, A, UP, 0.5, 1.0, np.array([0.5]))
    np.testing.assert_allclose(curve[0], [0, 0, -1.0], atol=1e-12)


def test_half_a_turn_still_ends_at_the_end() -> None:
    np.testing.assert_allclose(paths.circle(A, B, FORWARD, 0.5, 0.5, 1.0), B, atol=1e-12)


def test_a_curve_through_points_meets_them_at_even_speed() -> None:
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [3, 1, 1]], dtype=np.float64)
    curve = paths.through(corners, np.linspace(0, 1, 401))
    for corner in corners:
        assert np.linalg.norm(curve - corner, axis=1).min() < 0.006
    speed = steps(curve)
    assert speed.min() > 0.97 * speed.max()


def test_a_curve_along_a_line_is_the_line() -> None:
    line = np.array([[0, 0, 0], [1, 0, 0], [4, 0, 0]], dtype=np.float64)
    np.testing.assert_allclose(paths.through(line, 0.5), [2, 0, 0], atol=1e-4)
    np.testing.assert_allclose(paths.through(line[[0, 0, 2]], 0.5), [2, 0, 0], atol=1e-4)
    np.testing.assert_allclose(paths.through(line[[1, 1]], 0.5), line[1])


def test_a_short_step_between_long_ones_makes_no_loop() -> None:
    """What centripetal knots are for: uniform ones loop here."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [1.05, 0.05, 0], [1, 1, 0]], dtype=np.float64)
    curve = paths.through(corners, np.linspace(0, 1, 801))
    turns = np.diff(np.unwrap(np.arctan2(*np.diff(curve, axis=0)[:, 1::-1].T)))
    assert np.abs(turns).sum() < np.radians(160)
