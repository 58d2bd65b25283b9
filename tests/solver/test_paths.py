"""Paths: where they start, end and pass, and how evenly."""

from __future__ import annotations

import math
from itertools import groupby

import numpy as np
import pytest
from hypothesis import assume, given
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


@pytest.mark.parametrize("hour", range(12))
def test_a_circle_starts_at_an_hour_of_a_clock(hour: int) -> None:
    """The signer sees the clock's hands go round the axis that points away."""
    curve = paths.circle(
        A, A, FORWARD, 0.5, 1.0, np.linspace(0, 1, 13), phase=math.radians(30 * hour)
    )
    centre = np.mean(curve[:12], axis=0)
    right, up = -(curve - centre)[0, 0], (curve - centre)[0, 1]
    off = math.degrees(math.atan2(right, up)) - 30 * hour
    assert (off + 180) % 360 - 180 == pytest.approx(0, abs=1e-6)


def test_an_ellipse_is_as_high_as_its_ratio_says() -> None:
    curve = paths.circle(A, A, FORWARD, 0.5, 1.0, np.linspace(0, 1, 401), ratio=0.4)
    width, height, depth = np.ptp(curve, axis=0)
    assert (width, height, depth) == pytest.approx((1.0, 0.4, 0.0), abs=1e-3)


def test_a_spiral_grows_evenly() -> None:
    t = np.linspace(0, 1, 201)
    curve = paths.circle(A, A, FORWARD, 0.0, 2.0, t, end_radius=0.5)
    # Its centre travels, since both ends are one point: what is left is the radius.
    spokes = paths.circle(A, A, FORWARD, 1.0, 2.0, t) + UP
    centre = curve - 0.5 * t[:, None] * spokes
    assert np.abs(centre[:, 0]).max() < 1e-9
    np.testing.assert_allclose(np.diff(centre[:, 1]), -0.5 / 200, atol=1e-9)


@given(points, points, points, points, st.floats(-2.5, 2.5))
def test_around_a_centre_leads_from_start_to_end(
    start: NDArray[np.float64],
    end: NDArray[np.float64],
    centre: NDArray[np.float64],
    axis: NDArray[np.float64],
    turns: float,
) -> None:
    assume(np.linalg.norm(axis) > 0.1)
    away = [np.linalg.norm(np.cross(axis, p - centre)) for p in (start, end)]
    assume(min(away) > 0.01)
    t = np.linspace(0, 1, 301)
    curve = paths.around(start, end, centre, axis, turns, t)
    np.testing.assert_allclose(curve[[0, -1]], [start, end], atol=1e-7)
    spokes = curve - centre
    along = axis / np.linalg.norm(axis)
    radii = np.linalg.norm(np.cross(along, spokes), axis=1)
    assert np.abs(np.diff(radii, 2)).max() < 1e-9
    flat = spokes - (spokes @ along)[:, None] * along
    first = flat[0] / radii[0]
    angles = np.unwrap(np.arctan2(flat @ np.cross(along, first), flat @ first))
    assert abs((angles[-1] - angles[0]) / (2 * np.pi) - turns) <= 0.5 + 1e-6


def test_a_wave_goes_to_both_sides_so_often() -> None:
    curve = paths.wave(A, B, 0.3 * UP, 3.0, np.linspace(0, 1, 601))
    assert curve[:, 1].max() == pytest.approx(0.3)
    assert curve[:, 1].min() == pytest.approx(-0.3)
    assert np.count_nonzero(np.diff(np.sign(curve[1:-1, 1]))) in (5, 10)
    np.testing.assert_allclose(paths.wave(A, B, UP, 1.25, np.array([0.0, 1.0])), [A, B], atol=1e-9)


@pytest.mark.parametrize("corners", [1, 2, 5])
def test_a_zigzag_has_its_corners_on_both_sides_and_stops_there(corners: int) -> None:
    t = np.linspace(0, 1, 2001)
    curve = paths.zigzag(A, B, 0.3 * UP, corners, t)
    np.testing.assert_allclose(curve[[0, -1]], [A, B], atol=1e-12)
    peaks = [i for i in range(1, 2000) if abs(curve[i, 1]) > 0.3 - 1e-6]
    sides = [s for s, _ in groupby(np.sign(curve[peaks, 1]))]
    assert sides == [1.0 if k % 2 == 0 else -1.0 for k in range(corners)]
    speed = steps(curve)
    at = round((0.5 / corners) * 2000)
    assert speed[at - 1 : at + 1].max() < 0.01 * speed.max()


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


@given(points, points, points, points)
def test_axes_that_turn_together_stay_square(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    beside_a: NDArray[np.float64],
    beside_b: NDArray[np.float64],
) -> None:
    """One turn takes a frame to the other: its angle from the start grows evenly."""
    assume(
        min(float(np.linalg.norm(np.cross(*pair))) for pair in ((a, beside_a), (b, beside_b))) > 0.1
    )
    first, last = paths.frame(a, beside_a), paths.frame(b, beside_b)
    cosine = (np.trace(last @ first.T) - 1.0) / 2.0
    assume(-0.999 < cosine < 0.999)
    whole = math.acos(min(cosine, 1.0))
    for longer, sweep in ((False, whole), (True, whole - 2.0 * math.pi)):
        for t in (0.0, 0.3, 0.5, 1.0):
            x = paths.turned_together(
                first[:, 0], last[:, 0], first[:, 1], last[:, 1], t, longer=longer
            )
            y = paths.turned_together(
                first[:, 1], last[:, 1], first[:, 0], last[:, 0], t, longer=longer
            )
            now = np.stack([x, y, np.cross(x, y)], axis=1)
            np.testing.assert_allclose(now.T @ now, np.eye(3), atol=1e-7)
            turned = (np.trace(now @ first.T) - 1.0) / 2.0
            assert turned == pytest.approx(math.cos(t * sweep), abs=1e-6)
        np.testing.assert_allclose(now, last, atol=1e-6)


def test_a_frame_without_a_direction_turns_nowhere() -> None:
    assert np.isnan(paths.turned_together(UP, FORWARD, UP, A, 0.5)).all()
