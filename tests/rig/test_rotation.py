from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from azee_rig.rotation import about_axis, part_turn, to_matrices, to_quaternions

Floats = NDArray[np.float64]
angles = st.floats(-3.1, 3.1)


def _random(values: Floats) -> Floats:
    return about_axis(0, values[0]) @ about_axis(1, values[1]) @ about_axis(2, values[2])


@given(arrays(np.float64, 3, elements=angles))
def test_quaternions_give_the_matrix_back(values: Floats) -> None:
    R = _random(values)
    q = to_quaternions(R)
    assert q[0] >= 0.0
    np.testing.assert_allclose(to_matrices(q), R, atol=1e-12)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_half_turns_have_a_quaternion_too(axis: int) -> None:
    R = np.diag([-1.0, -1.0, -1.0])
    R[axis, axis] = 1.0
    np.testing.assert_allclose(to_matrices(to_quaternions(R)), R, atol=1e-12)


@given(arrays(np.float64, 3, elements=angles), st.integers(1, 5))
def test_parts_of_a_rotation_make_up_the_whole(values: Floats, parts: int) -> None:
    R = _random(values)
    part = to_matrices(part_turn(-to_quaternions(R), 1.0 / parts))
    np.testing.assert_allclose(np.linalg.matrix_power(part, parts), R, atol=1e-7)


def test_turns_are_right_handed() -> None:
    z_to_x = about_axis(1, np.pi / 2) @ np.array([0.0, 0.0, 1.0])
    np.testing.assert_allclose(z_to_x, [1.0, 0.0, 0.0], atol=1e-15)
    assert about_axis(1, np.zeros((4, 5))).shape == (4, 5, 3, 3)
