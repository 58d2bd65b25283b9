"""Signs made again: repeated, by both hands in turns, out of phase."""

from __future__ import annotations

from fractions import Fraction

import pytest
from evaluations import group, value
from hypothesis import given
from hypothesis import strategies as st
from test_score_changes import MSSP, OTHER_TIP, RSSP, SIGNS, TIP, _constraints, _score

from azee.lang.resizing import Resizing
from azee.score.articulators import arm_of
from azee_solver.constraint import (
    Morph,
    Place,
)
from azee_solver.geometry import (
    NamedPoint,
    Side,
    SigningSpace,
)

# Repetition -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SIGNS)
@pytest.mark.parametrize("options", ["", " 'damping .5", " 'gap 3"])
def test_once_is_the_sign(name: str, options: str) -> None:
    assert value(f"repeat :{name} 1{options}") == value(f":{name}")
    assert value(f"alternate :{name} 1") == value(f":{name}")


@given(st.integers(2, 6), st.integers(0, 10))
def test_repetitions_are_equal_and_as_far_apart_as_said(times: int, tenths: int) -> None:
    found = group(f"repeat :chat {times} 'gap {tenths / 10}")
    plain = _score(":chat")
    assert [b.score for b in found.blocks] == [plain] * times
    assert found.duration == times * plain.duration + (times - 1) * Fraction(tenths, 10)


def test_damped_repetitions_become_smaller_each_time() -> None:
    found = group("repeat :bonjour 3 'damping .2")
    plain = _score(":bonjour")
    smaller = [Resizing.of(plain, 0.8**k).score(plain) for k in (1, 2)]
    assert [b.score for b in found.blocks] == [plain, *smaller]
    assert len({repr(b.score) for b in found.blocks}) == 3


# Both hands -----------------------------------------------------------------------------------


def test_the_hands_take_turns() -> None:
    found = group("alternate :chat 3 'gap .1")
    plain, mirrored = _score(":chat"), _score("mirror :chat")
    assert [b.score for b in found.blocks] == [plain, mirrored, plain]


def test_out_of_phase_the_weak_hand_does_the_same_later() -> None:
    found = group("alternate :nb-5 2 'gap .3 'phase .5")
    duration = _score(":nb-5").duration
    cycle = duration + Fraction(3, 10)
    assert found.block("WEAK").interval_in_parent.start == cycle / 2
    assert found.block("STRONG").interval_in_parent.duration == 2 * duration + Fraction(3, 10)
    strong, weak = (_constraints(found.block(n).score) for n in ("STRONG", "WEAK"))
    assert {arm_of(c) for c in strong} <= {Side.STRONG, None}
    assert {arm_of(c) for c in weak} == {Side.WEAK}
    manual = [c for c in strong if arm_of(c) is Side.STRONG]
    assert len(manual) == len(weak)


def test_out_of_phase_each_hand_does_what_is_its_own() -> None:
    both = (
        "(seq (list (key 1 (cstr (place @I_TIP(s) ^Rssp) (place @I_TIP(w) ^Lssp)))"
        " (key 1 (cstr (place @I_TIP(s) ^Mssp) (place @I_TIP(w) ^Mssp) (morph 'AU12 1)))))"
    )
    found = group(f"alternate {both} 1 'phase .5")
    strong, weak = (_constraints(found.block(n).score) for n in ("STRONG", "WEAK"))
    assert strong == [Place(TIP, RSSP), Place(TIP, MSSP), Morph("AU12", None, 1.0)]
    assert weak == [Place(OTHER_TIP, NamedPoint(SigningSpace.LSSP)), Place(OTHER_TIP, MSSP)]
