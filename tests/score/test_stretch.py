"""Stretching: lengths are exact, fixed parts keep theirs, order and coincidences are kept."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import assume, given, settings
from laws import examples
from score_builders import blank, part, scores, seconds, times

from azee.score.error import LayoutError
from azee.score.layout import in_sequence, synchronised
from azee.score.score import Score, leaves
from azee.score.stretch import stretched


def test_all_inner_times_are_multiplied() -> None:
    group = synchronised(
        [
            part("A", blank("1")),
            part("B", in_sequence([blank("1")] * 2, Fraction(1)), "start", "A:end:1"),
        ]
    )
    longer = stretched(group, Fraction(15))
    found = {x.path: (float(x.interval.start), float(x.interval.end)) for x in leaves(longer)}
    assert found == {("A",): (0, 3), ("B", "1"): (6, 9), ("B", "2"): (12, 15)}


def test_what_is_fixed_keeps_its_length_and_the_rest_makes_up_for_it() -> None:
    sequence = in_sequence(
        [blank("1", fixed=True), blank("1"), blank("1", fixed=True)], Fraction(1, 2)
    )
    longer = stretched(sequence, Fraction(6))
    assert times(longer) == {  # type: ignore[arg-type]
        "1": (Fraction(0), Fraction(1)),
        "2": (Fraction(2), Fraction(4)),
        "3": (Fraction(5), Fraction(6)),
    }


def test_fixed_parts_further_inside_count_too() -> None:
    inner = in_sequence([blank("1", fixed=True), blank("1")], Fraction(0))
    longer = stretched(in_sequence([inner, blank("1")], Fraction(0)), Fraction(5))
    assert [x.interval.duration for x in leaves(longer)] == [1, 2, 2]


@pytest.mark.parametrize(
    ("score", "duration", "reason"),
    [
        (blank("1", fixed=True), "2", "fixed at 1 s"),
        (in_sequence([blank("1", fixed=True)] * 2, Fraction(0)), "3", "its 2 s are all fixed"),
        (
            in_sequence([blank("1", fixed=True), blank("1")], Fraction(0)),
            "1/2",
            "1 s of it are fixed",
        ),
        (in_sequence([blank("0")], Fraction(0)), "1", "without length"),
    ],
)
def test_what_cannot_be_stretched_says_why(score: Score, duration: str, reason: str) -> None:
    with pytest.raises(LayoutError, match=reason) as caught:
        stretched(score, Fraction(duration))
    assert caught.value.code == "cannot-stretch"


def test_a_key_of_no_length_can_be_stretched() -> None:
    assert stretched(blank("0"), Fraction(1)).duration == 1


def _try(score: Score, duration: Fraction) -> Score:
    try:
        return stretched(score, duration)
    except LayoutError:
        assume(False)
        raise


@given(scores)
def test_stretching_to_its_own_length_changes_nothing(score: Score) -> None:
    assert stretched(score, score.duration) == score


@settings(max_examples=examples(0.6))
@given(scores, seconds)
def test_the_result_has_the_length_that_was_asked_for(score: Score, duration: Fraction) -> None:
    longer = _try(score, duration)
    assert longer.duration == duration
    for leaf in leaves(longer):
        assert 0 <= leaf.interval.start <= leaf.interval.end <= duration


@settings(max_examples=examples(0.6))
@given(scores, seconds)
def test_fixed_leaves_keep_their_length(score: Score, duration: Fraction) -> None:
    longer = _try(score, duration)
    assume(longer is not score)
    for before, after in zip(leaves(score), leaves(longer), strict=True):
        if before.score.fixed or any(p.fixed for p in before.parents[1:]):
            assert after.interval.duration == before.interval.duration


@settings(max_examples=examples(0.6))
@given(scores, seconds)
def test_there_and_back_is_where_it_was(score: Score, duration: Fraction) -> None:
    assume(duration > 0)
    assert _try(_try(score, duration), score.duration) == score


@settings(max_examples=examples(0.6))
@given(scores, seconds)
def test_what_coincided_still_does(score: Score, duration: Fraction) -> None:
    assume(score.duration > 0)
    longer = _try(score, duration)
    moved: dict[Fraction, Fraction] = {}
    for before, after in zip(leaves(score), leaves(longer), strict=True):
        for old, new in zip(
            (before.interval.start, before.interval.end),
            (after.interval.start, after.interval.end),
            strict=True,
        ):
            assert moved.setdefault(old, new) == new
    assert [moved[t] for t in sorted(moved)] == sorted(moved.values())
