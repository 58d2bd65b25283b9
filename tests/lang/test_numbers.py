"""Numbers are composed of their digits, hundreds and thousands: what was put in can be read out."""

from __future__ import annotations

import re
from collections.abc import Iterator

from evaluations import content, problems
from hypothesis import given
from hypothesis import strategies as st

from azee.score.score import Blank, Group, Hold, Key, Recorded, Score

LARGEST = 999_999
DIGIT = re.compile(r"nb-(\d)")


def _signs(score: Score) -> Iterator[str]:
    """Names of the signs of a number, in order: `nb-5`, `cent`, `mille`, and `tens` before two."""
    names = [call.rule for call in score.calls]
    if "tens-units" in names:
        yield "tens"
    for name in names:
        if DIGIT.fullmatch(name) or name in ("cent", "mille"):
            yield name
            return
    match score:
        case Group():
            for block in sorted(score.blocks, key=lambda b: b.interval_in_parent.start):
                yield from _signs(block.score)
        case Key() | Hold() | Blank() | Recorded():
            pass


def _signed(n: int) -> list[str]:
    score = content(f":number({n})")
    assert isinstance(score, Group)
    return list(_signs(score))


def _read(signs: list[str]) -> int:
    """The number that signs say, as a signer would read them."""
    total, below_thousand, units, tens = 0, 0, None, False
    pending: list[int] = []
    for sign in signs:
        if found := DIGIT.fullmatch(sign):
            pending.append(int(found[1]))
            if tens and len(pending) == 2:
                pending, tens = [10 * pending[0] + pending[1]], False
        elif sign == "tens":
            tens = True
        elif sign == "cent":
            below_thousand = 100 * (pending.pop() if pending else 1)
        else:
            units = below_thousand + (pending.pop() if pending else 0)
            total, below_thousand = 1000 * (units or 1), 0
    assert len(pending) <= 1
    return total + below_thousand + sum(pending)


@given(st.integers(0, LARGEST))
def test_digits_reassemble(n: int) -> None:
    assert _read(_signed(n)) == n


def test_hundreds_and_thousands_stand_behind_their_count() -> None:
    assert _signed(0) == ["nb-0"]
    assert _signed(100) == ["cent"]
    assert _signed(1984) == ["mille", "nb-9", "cent", "tens", "nb-8", "nb-4"]
    assert _signed(200_010) == ["nb-2", "cent", "mille", "tens", "nb-1", "nb-0"]


def test_ordinals_and_years_hold_their_number() -> None:
    for text, n in ((":ordinal(3)", 3), (":year(2024)", 2024)):
        assert problems(text) == []
        score = content(text)
        assert isinstance(score, Group)
        assert _read(list(_signs(score))) == n
