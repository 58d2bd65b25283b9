"""The limits in which a movement is projected."""

from __future__ import annotations

import math

import numpy as np
import pytest

from azee.motion.projection.reference import MARGIN_RAD, limits_for
from azee_rig.rig import Rig


def test_life_stays_off_the_ends_of_ranges(signer: Rig) -> None:
    coordinates = signer.coordinates
    q = np.tile(coordinates.idle, (3, 1))
    arm, finger = (coordinates.index[n] for n in ("arm_R.flexion", "index_R_2.flexion"))
    lower, upper = limits_for(q, coordinates)
    assert lower[arm] == pytest.approx(coordinates.lower[arm] + MARGIN_RAD)
    assert upper[arm] == pytest.approx(coordinates.upper[arm] - MARGIN_RAD)
    assert (lower[finger], upper[finger]) == (coordinates.lower[finger], coordinates.upper[finger])


@pytest.mark.parametrize("beyond_deg", [0.2, 1.0, 5.0])
def test_a_movement_that_goes_farther_may_go_as_far_and_never_beyond_its_range(
    beyond_deg: float, signer: Rig
) -> None:
    coordinates = signer.coordinates
    q = np.tile(coordinates.idle, (3, 1))
    arm = coordinates.index["arm_R.flexion"]
    inside = coordinates.upper[arm] - MARGIN_RAD
    q[1, arm] = inside + math.radians(beyond_deg)
    lower, upper = limits_for(q, coordinates)
    assert upper[arm] == min(q[1, arm], coordinates.upper[arm])
    assert lower[arm] < upper[arm]
    assert np.all(lower >= coordinates.lower)
    assert np.all(upper <= coordinates.upper)
