"""What is made of a tracker's landmarks of faces."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from azee_rig.rig import Rig
from azee_rig.rotation import about_axis
from benchmarks.tracker.apexes import ANGLES_DEG, SIZE, apex, facial_rules, seen_at_angles
from benchmarks.tracker.faces import OUTER_CORNERS, confusion, without_pose

Floats = NDArray[np.float64]

LANDMARKS = 300
RULES = ("one", "two", "three")
COPIES = 3
turns = st.floats(-1.0, 1.0)


def _head() -> Floats:
    """Landmarks of a face, of which the corners of the eyes are 10 apart."""
    head = np.random.default_rng(1).normal(0.0, 5.0, (LANDMARKS, 3))
    head[list(OUTER_CORNERS)] = (-5.0, 0.0, 0.0), (5.0, 0.0, 0.0)
    return head


@given(turns, turns, turns, st.floats(0.2, 5.0), st.floats(-100.0, 100.0))
def test_a_head_elsewhere_is_the_same_head(
    yaw: float, pitch: float, roll: float, size: float, moved: float
) -> None:
    head = _head()
    turned = head @ (about_axis(1, yaw) @ about_axis(0, pitch) @ about_axis(2, roll)).T
    (found,) = without_pose(size * turned[None] + moved, head)
    np.testing.assert_allclose(found, head - head.mean(axis=0), atol=1e-6)


def _marks(shown: float) -> Floats:
    """No face and three rules that move landmarks by so much, each angle in its own way."""
    rng = np.random.default_rng(2)
    of_rule = np.concatenate([np.zeros((1, LANDMARKS, 3)), rng.normal(0, shown, (3, LANDMARKS, 3))])
    of_angle = rng.normal(0.0, 0.3, (len(ANGLES_DEG), LANDMARKS, 3))
    seen = _head() + of_rule[:, None] + of_angle[None]
    return np.repeat(seen[:, :, None], COPIES, axis=2)


@pytest.mark.parametrize("other_angles", [False, True])
def test_faces_are_told_apart_if_they_differ(other_angles: bool) -> None:
    rng = np.random.default_rng(3)
    clear = confusion(RULES, _marks(0.5), rng, other_angles=other_angles)
    assert clear.right == 1.0
    assert clear.taken.sum() == len(RULES) * len(ANGLES_DEG) * (COPIES - 1)
    same = confusion(RULES, _marks(0.0), rng, other_angles=other_angles)
    assert same.right < 0.7
    assert [*same.lines()][-1].startswith(f"{100 * same.right:.1f} % of 30 faces")


@pytest.mark.long
def test_every_facial_rule_is_drawn_and_looks_different_at_every_angle(signer: Rig) -> None:
    names = [*facial_rules()]
    assert len(names) == 23
    drawn = seen_at_angles(signer, apex(signer, names[0]))
    assert drawn.shape == (len(ANGLES_DEG), *SIZE[::-1], 3)
    assert len({picture.tobytes() for picture in drawn}) == len(ANGLES_DEG)
    assert not np.array_equal(drawn, seen_at_angles(signer, {}))
