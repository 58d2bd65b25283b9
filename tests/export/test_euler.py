"""Euler angles give the rotation back, at gimbal lock too, and change as little as they can."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from azee.export.formats.euler import EulerZXY

ANGLES = st.floats(-7, 7) | st.sampled_from([k * np.pi / 2 for k in range(-3, 4)])
NEAR_LOCK = st.floats(-1e-5, 1e-5).map(lambda e: np.pi / 2 + e)


def _matrix(quaternion: np.ndarray) -> np.ndarray:
    w, v = quaternion[..., 0], quaternion[..., 1:]
    cross = np.cross(np.eye(3), v[..., None, :])
    outer = v[..., :, None] * v[..., None, :]
    square = np.einsum("...,ij->...ij", 2 * w**2 - 1, np.eye(3))
    return np.asarray(square + 2 * outer + 2 * w[..., None, None] * cross)


def _turn(axis: int, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    R = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[i, i], R[i, j], R[j, i], R[j, j] = c, -s, s, c
    return R


@given(arrays(np.float64, (4, 3), elements=ANGLES))
def test_quaternions_are_the_product_in_the_order_of_the_channels(angles: np.ndarray) -> None:
    quaternions = EulerZXY(angles).quaternions()
    np.testing.assert_allclose(np.linalg.norm(quaternions, axis=-1), np.ones(4), atol=1e-12)
    wanted = np.stack([_turn(2, z) @ _turn(0, x) @ _turn(1, y) for z, x, y in angles])
    np.testing.assert_allclose(_matrix(quaternions), wanted, atol=1e-12)


@given(arrays(np.float64, (5, 2, 3), elements=ANGLES | NEAR_LOCK))
def test_from_quaternions_inverts_quaternions(angles: np.ndarray) -> None:
    rotations = EulerZXY(angles).quaternions()
    again = EulerZXY.from_quaternions(rotations).quaternions()
    distance = 1 - np.abs((rotations * again).sum(axis=-1))
    assert distance.max() < 1e-12
    assert np.abs(_matrix(rotations) - _matrix(again)).max() < 1e-8


def test_a_turn_through_gimbal_lock_does_not_jump() -> None:
    """Pitching over the top keeps z and y where they are; full turns go on counting."""
    steps = np.linspace(0, 4 * np.pi, 401)
    angles = np.stack([np.full_like(steps, 0.3), steps, np.full_like(steps, -0.2)], axis=-1)
    found = EulerZXY.from_quaternions(EulerZXY(angles[:, None]).quaternions()).angles[:, 0]
    np.testing.assert_allclose(found, angles, atol=1e-7)


def test_at_gimbal_lock_what_is_free_stays() -> None:
    locked = np.array([[[0.4, 1.2, 0.1]], [[0.4, np.pi / 2, 0.1]], [[0.6, np.pi / 2, 0.3]]])
    found = EulerZXY.from_quaternions(EulerZXY(locked).quaternions()).angles
    np.testing.assert_allclose(found[:2], locked[:2], atol=1e-7)
    assert abs((found[2, 0, 0] + found[2, 0, 2]) - 0.9) < 1e-7
    assert np.abs(found[2] - found[1]).max() < 0.21


@given(arrays(np.float64, (2, 3), elements=st.floats(-1.2, 1.2)))
def test_between_close_frames_angles_take_the_short_way(ends: np.ndarray) -> None:
    share = np.linspace(0, 1, 30)[:, None]
    angles = ends[0] * (1 - share) + ends[1] * share
    found = EulerZXY.from_quaternions(EulerZXY(angles).quaternions()).angles
    np.testing.assert_allclose(found, angles, atol=1e-9)
