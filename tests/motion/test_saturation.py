"""Lids and jaw stop at their ends, however much is asked of them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.motion.overlay.saturation import saturated
from azee_rig.load import load_rig

RIG = load_rig()
CLOSED, WIDE = "mh_eye-left-closure", "eyeWideLeft"
BLINK, DOWN, JAW, SMILE = "eyeBlinkLeft", "eyeLookDownLeft", "jawOpen", "mouthSmileLeft"


def weighted(of: Mapping[str, float]) -> NDArray[np.float64]:
    out = np.zeros((1, len(RIG.units)))
    for unit, weight in of.items():
        out[0, RIG.units.index(unit)] = weight
    return out


def shown(of: Mapping[str, float]) -> dict[str, float]:
    found = saturated(weighted(of), RIG)[0]
    return {unit: float(found[RIG.units.index(unit)]) for unit in of}


def lid_height(of: Mapping[str, float]) -> float:
    """Mean height of what the left lid moves, metres."""
    rows, deltas = RIG.mesh.unit(CLOSED)
    most = rows[deltas[:, 1] < 0.8 * deltas[:, 1].min()]
    found = saturated(weighted(of), RIG)[0]
    return float(RIG.mesh.shaped(found)[most, 1].mean())


def test_a_face_within_its_range_is_left_as_it_is() -> None:
    for of in ({CLOSED: 1.0}, {BLINK: 0.5, SMILE: 1.0}, {WIDE: 1.0}, {JAW: 1.0}):
        assert shown(of) == pytest.approx(of)


def test_closing_units_together_close_the_eye_and_no_more() -> None:
    found = shown({CLOSED: 1.0, BLINK: 1.0, DOWN: 1.0, SMILE: 0.8})
    assert found[SMILE] == pytest.approx(0.8)
    assert found[CLOSED] == pytest.approx(found[BLINK]) == pytest.approx(found[DOWN])
    assert found[CLOSED] < 0.5
    once = lid_height({CLOSED: 1.0})
    assert lid_height({CLOSED: 1.0, BLINK: 1.0, DOWN: 1.0}) == pytest.approx(once, abs=2e-3)


def test_a_raised_lid_leaves_room_to_close() -> None:
    found = shown({CLOSED: 1.2, WIDE: 0.5})
    assert found[WIDE] == pytest.approx(0.5)
    assert 1.0 < found[CLOSED] <= 1.2


def test_a_jaw_opens_once() -> None:
    found = shown({JAW: 1.0, "mh_mouth-open": 1.0})
    assert found[JAW] == pytest.approx(found["mh_mouth-open"])
    assert found[JAW] < 0.75
