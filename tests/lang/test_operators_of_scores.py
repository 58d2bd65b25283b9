"""What operators that make scores give: their durations, blocks and origins."""

from __future__ import annotations

from fractions import Fraction

import pytest
from evaluations import content, group, times, value

from azee.lang.values import SymbolValue
from azee.score.score import Blank, Hold, Key
from azee_solver.constraint import (
    Origin,
)


def test_durations_are_the_decimals_as_written() -> None:
    key = content("key .1 (look ^fwd)")
    assert isinstance(key, Key)
    assert key.duration == Fraction(1, 10)
    assert content("blank .3") == Blank(Fraction(3, 10))
    assert content("blank 0") == Blank(Fraction(0))
    assert content("blank add(.5, .25)") == Blank(Fraction(3, 4))


def test_hold_names_a_block_or_holds_a_score() -> None:
    assert content("hold 'A .1") == Hold(Fraction(1, 10), block="A", channels=("hands",))
    assert content("hold 'A .1 'only (list 'face 'head)") == Hold(
        Fraction(1, 10), block="A", channels=("face", "head")
    )
    held = group("hold (blank 1) .5 'only 'trunk")
    assert held.duration == Fraction(3, 2)
    assert held.block("HOLD").score == Hold(Fraction(1, 2), block="SIG", channels=("trunk",))


def test_seq_puts_one_after_the_other() -> None:
    assert times(group("seq (list (blank 1) (blank 2))")) == {"1": (0, 1), "2": (1.2, 3.2)}
    assert group("seq (list (blank 1) (blank 2)) 'gap 0").duration == 3
    assert group("seq (list) 'gap 1").duration == 0


def test_fixed_marks_a_score() -> None:
    assert content("fixed (blank 1)") == Blank(Fraction(1), fixed=True)


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        ("ref 'SIG 'end", "SIG:end"),
        ("ref 'SIG 'start -.25", "SIG:start:-0.25"),
        ("ref('INFO/SIG, .5, add(.1, .2))", "INFO/SIG:0.5:0.30000000000000004"),
        ("ref 'SIG 'end .0000001", "SIG:end:0.0000001"),
    ],
)
def test_refs_can_be_computed(expression: str, text: str) -> None:
    assert value(expression) == SymbolValue(text)


def test_a_sync_with_all_its_rules() -> None:
    found = group(
        """sync
    'SIG (blank 2)
    'A (blank 1)
    'start/end 'SIG:start:.5 'SIG:end:-.25
    'B (blank 1)
    'start ref('SIG, 'end, .1)
    'C (blank 1)
    'end 'SIG:.5
    'D (blank 1)
    'start/dur 'SIG:start .25
    'E (blank 1)
    'end/dur 'SIG:end .25
    'F (blank 1)
    'with 'SIG
"""
    )
    assert times(found) == {
        "SIG": (0, 2),
        "A": (0.5, 1.75),
        "B": (2.1, 3.1),
        "C": (0, 1),
        "D": (0, 0.25),
        "E": (1.75, 2),
        "F": (0, 2),
    }


def test_a_score_knows_the_rules_it_came_from() -> None:
    key = content("tree()")
    assert isinstance(key, Key)
    assert [call.rule for call in key.calls] == ["tree", "arbre"]
    outer, inner = (call.origin for call in key.calls)
    assert outer == Origin("<expression>", 1, 1, None)
    assert inner is not None
    assert (inner.file, inner.rule) == ("lsf/arbre.azee", "tree")
