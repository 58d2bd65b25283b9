"""Fingers of one hand inside each other: those of a shape that a score asks for touch."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from azee.compilation import perform
from azee.lang.program import evaluate_expression
from azee.quality import measures
from azee.quality.measures import PenetrationSearch
from azee_rig.rig import Rig

PINCH = "key(1, cstr(place(@M_TIP(s), vtranslate(@CK(s), scale(^fwd, .2))), :#hampinch12open))"
DIGITS = ("index_R", "thumb_R")


@pytest.fixture(scope="module")
def pinch(signer: Rig) -> PenetrationSearch:
    search = perform(evaluate_expression(PINCH).score, signer).report.measure_penetration
    assert isinstance(search, PenetrationSearch)
    return search


def formed(search: PenetrationSearch) -> np.ndarray:
    """Frames before the block, outside the window of a touch, in which the pinch is formed."""
    names = search.rig.coordinates.names
    own = [v for v, name in enumerate(names) if name.startswith(DIGITS)]
    at = search.coordinates[np.abs(search.times_s).argmin(), own]
    near = np.abs(search.coordinates[:, own] - at).max(axis=1) < 0.5 * measures.FORMED_RAD
    early = (search.times_s < 0.0) & (search.times_s > -measures.FORMED_S)
    return np.flatnonzero(near & early)


def test_a_pinch_that_is_formed_on_the_way_touches_as_its_block_asks(
    pinch: PenetrationSearch, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(measures, "FINGERS_LEAST_M", 0.0005)
    monkeypatch.setattr(measures, "TOUCH_S", 0.0)
    assert len(formed(pinch)) >= 2
    before = pinch.times_s <= 0.0
    way = replace(pinch, coordinates=pinch.coordinates[before], times_s=pinch.times_s[before])
    found = [p for p in way.between_fingers() if p.pair == DIGITS]
    assert found
    assert all(p.intended for p in found)


def test_fingers_that_enter_each_other_before_they_are_formed_do_not_touch(
    pinch: PenetrationSearch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The pinch happens where nothing asks for it: long before, and with another shape after."""
    monkeypatch.setattr(measures, "FINGERS_LEAST_M", 0.0005)
    at = int(np.abs(pinch.times_s - 0.5).argmin())
    early = pinch.times_s - pinch.times_s[at] - measures.FORMED_S - 1.5
    found = [p for p in replace(pinch, times_s=early).between_fingers() if p.pair == DIGITS]
    assert found
    assert not any(p.intended for p in found)
