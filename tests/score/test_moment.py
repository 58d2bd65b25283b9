"""Refs: reading them, and what is said of those that do not read."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from azee.score.moment import Bound, Moment, MomentError, decimal, parse_moment


@pytest.mark.parametrize(
    ("text", "moment"),
    [
        ("SIG:start", Moment(("SIG",), Bound.START)),
        ("SIG:start:-.25", Moment(("SIG",), Bound.START, Fraction(-1, 4))),
        ("SIG:end:0", Moment(("SIG",), Bound.END)),
        ("SIG:end:+1.", Moment(("SIG",), Bound.END, Fraction(1))),
        ("SIG:.5", Moment(("SIG",), Fraction(1, 2))),
        ("SIG:.1:.2", Moment(("SIG",), Fraction(1, 10), Fraction(1, 5))),
        ("INFO/SIG:end", Moment(("INFO", "SIG"), Bound.END)),
        ("PALM-L-HALF-CLOSED:end", Moment(("PALM-L-HALF-CLOSED",), Bound.END)),
    ],
)
def test_a_ref_is_read_exactly(text: str, moment: Moment) -> None:
    assert parse_moment(text) == moment


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("SIG", "but not when"),
        (":start", "names no block"),
        ("A//B:start", "names no block"),
        ("SIG:begin", "`begin` in `'SIG:begin` is none of"),
        ("SIG:start:soon", "`soon` is not a number"),
        ("SIG:start:1e3", "`1e3` is not a number"),
        ("SIG:start:1:2", "too many parts"),
        ("SIG:start:0.123456789012345678", "more than 17 digits"),
    ],
)
def test_a_ref_that_does_not_read_says_why(text: str, reason: str) -> None:
    with pytest.raises(MomentError, match=reason):
        parse_moment(text)


@given(
    st.lists(st.from_regex(r"[A-Z][A-Z0-9-]*", fullmatch=True), min_size=1, max_size=3),
    st.one_of(st.sampled_from(Bound), st.integers(0, 100).map(lambda n: Fraction(n, 100))),
    st.integers(-1000, 1000).map(lambda n: Fraction(n, 100)),
)
def test_a_moment_reads_as_it_is_written(
    path: list[str], anchor: Bound | Fraction, offset: Fraction
) -> None:
    moment = Moment(tuple(path), anchor, offset)
    assert parse_moment(str(moment)) == moment


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (Fraction(0), "0"),
        (Fraction(1, 4), "0.25"),
        (Fraction(-1, 10), "-0.1"),
        (Fraction(10), "10"),
        (Fraction(1, 3), "0.333333333"),
    ],
)
def test_decimals_are_those_that_azee_reads(number: Fraction, text: str) -> None:
    assert decimal(number) == text
