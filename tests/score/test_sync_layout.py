"""Laying out `sync`, `seq` and `hold`: every rule, refs, cycles, and laws."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from laws import examples
from score_builders import blank, offsets, part, scores, seconds, times

from azee.score.error import LayoutError
from azee.score.layout import Part, held, in_sequence, synchronised
from azee.score.score import Arrangement, Group, Hold, Score, leaves

SIG = part("SIG", blank("2"))


@pytest.mark.parametrize(
    ("rule", "operands", "start", "end"),
    [
        ("start/end", ("SIG:start:.5", "SIG:end:-.25"), "1/2", "7/4"),
        ("start", ("SIG:.25",), "1/2", "3/2"),
        ("end", ("SIG:end",), "1", "2"),
        ("start/dur", ("SIG:start:.5", "1/4"), "1/2", "3/4"),
        ("end/dur", ("SIG:end:-.5", "3/10"), "6/5", "3/2"),
        ("with", ("SIG",), "0", "2"),
    ],
)
def test_a_rule_places_a_block(rule: str, operands: tuple[str, ...], start: str, end: str) -> None:
    group = synchronised([SIG, part("B", blank("1"), rule, *operands)])
    assert times(group)["B"] == (Fraction(start), Fraction(end))
    assert group.block("B").score.duration == Fraction(end) - Fraction(start)
    assert group.arrangement is Arrangement.SYNC


def test_the_group_starts_with_its_earliest_block() -> None:
    group = synchronised([SIG, part("FACE", blank("1"), "start/end", "SIG:start:-.25", "SIG:end")])
    assert times(group) == {
        "SIG": (Fraction(1, 4), Fraction(9, 4)),
        "FACE": (Fraction(0), Fraction(9, 4)),
    }
    assert group.duration == Fraction(9, 4)


def test_refs_may_point_forward_and_bounds_may_cross() -> None:
    group = synchronised(
        [
            SIG,
            part("B", blank("1"), "start/end", "SIG:start", "C:start"),
            part("C", blank("1"), "start", "D:end:.5"),
            part("D", blank("1"), "end", "SIG:end"),
            part("E", blank("1"), "start/end", "B:end", "F:start"),
            part("F", blank("1"), "start/end", "SIG:end:2", "E:start:3"),
        ]
    )
    assert times(group)["C"] == (Fraction(5, 2), Fraction(7, 2))
    assert times(group)["E"] == (Fraction(5, 2), Fraction(4))
    assert times(group)["F"] == (Fraction(4), Fraction(11, 2))


def test_a_block_inside_a_block_can_be_named() -> None:
    inner = synchronised([SIG, part("FACE", blank("1"), "start/end", "SIG:start:-.25", "SIG:end")])
    parts = [
        part("TOPIC", blank("1")),
        part("INFO", inner, "start", "TOPIC:end"),
        part("GAZE", blank(".1"), "start", "INFO/SIG:start"),
        part("LATE", inner, "start/dur", "TOPIC:start", "9"),
        part("BLINK", blank(".1"), "end", "LATE/SIG:end:-1"),
    ]
    group = synchronised(parts)
    assert times(group)["GAZE"][0] == Fraction(5, 4)
    assert times(group)["BLINK"][1] == 8
    deep = synchronised([part("A", group), part("B", blank("1"), "with", "A/INFO/SIG")])
    assert times(deep)["B"] == (Fraction(5, 4), Fraction(13, 4))


def test_blocks_of_a_sequence_are_named_by_number() -> None:
    sequence = in_sequence([blank("1"), blank("2"), blank("3")], Fraction(1, 5))
    assert times(sequence) == {
        "1": (Fraction(0), Fraction(1)),
        "2": (Fraction(6, 5), Fraction(16, 5)),
        "3": (Fraction(17, 5), Fraction(32, 5)),
    }
    group = synchronised([part("A", sequence), part("B", blank("1"), "start", "A/2:start")])
    assert times(group)["B"][0] == Fraction(6, 5)


def test_an_empty_sequence_lasts_no_time() -> None:
    assert in_sequence([], Fraction(1)).duration == 0


def test_a_held_score_keeps_what_it_reached() -> None:
    group = held(blank("1"), Fraction(1, 2), ("face",))
    assert times(group) == {
        "SIG": (Fraction(0), Fraction(1)),
        "HOLD": (Fraction(1), Fraction(3, 2)),
    }
    assert group.block("HOLD").score == Hold(Fraction(1, 2), block="SIG", channels=("face",))


def test_a_long_chain_of_refs_does_not_exhaust_the_stack() -> None:
    parts = [part("0", blank("1"))]
    parts += [part(str(i), blank("0"), "start", f"{i + 1}:start:.1") for i in range(1, 3000)]
    parts.append(part("3000", blank("0"), "start", "0:start"))
    assert synchronised(parts).duration == Fraction(2999, 10)


def _hold(block: str) -> Hold:
    return Hold(Fraction(1), block=block)


@pytest.mark.parametrize(
    ("parts", "code", "number", "message"),
    [
        (
            [SIG, part("B", blank("1"), "start", "SIGN:start")],
            "unknown-block",
            1,
            "no block `SIGN`",
        ),
        (
            [SIG, part("B", blank("1"), "start", "SIG/FACE:start")],
            "unknown-block",
            1,
            "`SIG` has no blocks inside",
        ),
        (
            [
                part("A", in_sequence([blank("1")], Fraction(0))),
                part("B", blank("1"), "with", "A/2"),
            ],
            "unknown-block",
            1,
            "no block `2` inside `A`",
        ),
        ([SIG, part("B", _hold("C"), "start", "SIG:end")], "unknown-block", 1, "`C` to hold"),
        (
            [SIG, part("A", _hold("B"), "with", "SIG"), part("B", _hold("A"), "with", "SIG")],
            "cyclic-sync",
            1,
            "`A` holds `B` holds `A`",
        ),
        ([SIG, part("SIG", blank("1"), "start", "SIG:end")], "duplicate-block", 1, "two blocks"),
        (
            [SIG, part("B", blank("1"), "start", "C:end"), part("C", blank("1"), "end", "B:start")],
            "cyclic-sync",
            1,
            "`B:start` needs `C:end` needs `B:start`",
        ),
        ([SIG, part("B", blank("1"), "start", "B:.5")], "cyclic-sync", 1, "`B:"),
        (
            [SIG, part("B", blank("1"), "start/end", "SIG:end", "SIG:start")],
            "negative-duration",
            1,
            "`B` would end 2 s before it starts",
        ),
        (
            [SIG, part("B", in_sequence([blank("0")], Fraction(0)), "with", "SIG")],
            "cannot-stretch",
            1,
            "`B` cannot be stretched to 2 s",
        ),
        (
            [SIG, part("B", blank("1", fixed=True), "with", "SIG")],
            "cannot-stretch",
            1,
            "fixed at 1 s",
        ),
        ([SIG, part("B", blank("1"), "start", "SIG:end:90000")], "size-limit", 1, "a day"),
    ],
)
def test_what_cannot_be_laid_out_names_the_block(
    parts: list[Part], code: str, number: int, message: str
) -> None:
    with pytest.raises(LayoutError, match=message) as caught:
        synchronised(parts)
    assert (caught.value.code, caught.value.part) == (code, number)


def test_a_hold_in_a_sequence_has_nothing_to_hold() -> None:
    with pytest.raises(LayoutError, match="blocks have no names") as caught:
        in_sequence([blank("1"), _hold("1")], Fraction(0))
    assert (caught.value.code, caught.value.part) == ("unknown-block", 1)


# Laws -----------------------------------------------------------------------------------------


@settings(max_examples=examples(0.5))
@given(scores, scores, offsets)
def test_moving_zero_moves_nothing(a: Score, b: Score, offset: Fraction) -> None:
    one = synchronised([part("A", a), part("B", b, "start", f"A:start:{float(offset)}")])
    other = synchronised([part("B", b), part("A", a, "start", f"B:start:{float(-offset)}")])
    assert times(one) == times(other)
    assert one.duration == other.duration


@settings(max_examples=examples(0.5))
@given(st.lists(scores, max_size=4), seconds)
def test_a_sequence_is_as_long_as_its_parts_and_gaps(parts: list[Score], gap: Fraction) -> None:
    group = in_sequence(parts, gap)
    gaps = gap * max(0, len(parts) - 1)
    assert group.duration == sum((p.duration for p in parts), Fraction(0)) + gaps


@settings(max_examples=examples(0.5))
@given(scores)
def test_every_leaf_lies_within_its_score(score: Score) -> None:
    for leaf in leaves(score):
        assert 0 <= leaf.interval.start <= leaf.interval.end <= score.duration


@settings(max_examples=examples(0.5))
@given(scores, st.permutations([1, 2, 3]))
def test_the_order_of_writing_does_not_matter(score: Score, order: list[int]) -> None:
    others = [
        part("X", blank("1"), "start", "A:end:.5"),
        part("Y", blank("1"), "end", "X:start"),
        part("Z", score, "start", "Y:start:-.1"),
    ]
    group = synchronised([part("A", blank("1")), *others])
    shuffled = synchronised([part("A", blank("1")), *(others[i - 1] for i in order)])
    assert times(shuffled) == times(group)


def test_blocks_keep_the_order_of_writing() -> None:
    group: Group = synchronised([SIG, part("B", blank("1"), "end", "SIG:start")])
    assert [b.name for b in group.blocks] == ["SIG", "B"]
