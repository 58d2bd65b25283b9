"""Bends: every way gets its time, fixed parts keep theirs, order and coincidences stay."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from laws import examples

from azee.motion.timing.bend import STEP_S, Bend, bend_for
from azee.motion.timing.way import Way
from azee.score.interval import Interval
from azee.score.score import Blank, Block, Group, Score, leaves
from azee.score.stretch import warped

F = Fraction
times = st.integers(0, 60).map(lambda n: F(n, 20))
lengths = st.integers(1, 30).map(lambda n: F(n, 20))


def way(start: Fraction, length: Fraction, needed_s: Fraction) -> Way:
    return Way("R", Interval(start, start + length), needed_s, 0.1, 0.0, (), ())


ways = st.builds(way, times, lengths, st.integers(1, 2000).map(lambda n: F(n, 1000)))


@st.composite
def apart(draw: st.DrawFn) -> list[Interval]:
    """Disjoint intervals in order."""
    cuts = sorted(draw(st.sets(times, max_size=6)))
    return [Interval(a, b) for a, b in zip(cuts[::2], cuts[1::2], strict=False)]


@st.composite
def trees(draw: st.DrawFn, depth: int = 3) -> Score:
    """Nested groups of blocks anywhere; a group ends with its latest block."""
    if depth == 0 or draw(st.booleans()):
        return Blank(draw(st.one_of(st.just(F(0)), lengths)))
    blocks = []
    for n in range(draw(st.integers(1, 3))):
        inner, start = draw(trees(depth=depth - 1)), draw(times)
        blocks.append(Block(str(n), Interval(start, start + inner.duration), inner))
    return Group(max(b.interval_in_parent.end for b in blocks), blocks=tuple(blocks))


def after(bend: Bend, interval: Interval) -> Fraction:
    return bend(interval.end) - bend(interval.start)


def test_one_way_gets_exactly_what_it_needs() -> None:
    bend = bend_for([way(F(1), F("1/5"), F("1/2"))])
    assert [bend(F(t)) for t in ("0", "1", "1.1", "1.2", "2")] == [
        F("0"), F("1"), F("1.25"), F("1.5"), F("2.3"),
    ]  # fmt: skip
    assert bend.extra_s == F("3/10")


def test_ways_that_overlap_share_their_extra_time() -> None:
    both = [way(F(0), F(1), F("1.2")), way(F("0.5"), F("0.2"), F("0.4"))]
    assert bend_for(both).extra_s == F("0.2")


def test_what_a_way_lacks_goes_to_its_least_stretched_pieces_first() -> None:
    bend = bend_for([way(F(0), F("0.5"), F(1)), way(F(0), F("1.5"), F("2.5"))])
    assert after(bend, Interval(F(0), F("0.5"))) == F(1)
    assert after(bend, Interval(F("0.5"), F("1.5"))) == F("1.5")


def test_no_way_no_bend() -> None:
    assert bend_for([]).extra_s == 0
    assert bend_for([way(F(0), F(1), F("0.5"))])(F("0.7")) == F("0.7")


def test_what_is_fixed_leaves_the_stretching_to_the_rest() -> None:
    bend = bend_for([way(F(0), F(1), F("1.6"))], [Interval(F("0.2"), F("0.6"))])
    assert after(bend, Interval(F("0.2"), F("0.6"))) == F("0.4")
    assert after(bend, Interval(F(0), F(1))) == F("1.6")
    assert not bend_for([way(F(0), F(1), F(2))], [Interval(F(0), F(1))]).extra_s


@settings(max_examples=examples(1.5))
@given(st.lists(ways, max_size=6), apart())
def test_every_way_has_its_time_and_what_is_fixed_keeps_its_own(
    asked: Sequence[Way], fixed: Sequence[Interval]
) -> None:
    bend = bend_for(asked, fixed)
    assert all(a < b for a, b in pairwise(bend.images))
    for one in asked:
        covered = any(
            i.start <= one.interval.start and one.interval.end <= i.end for i in _joined(fixed)
        )
        if not covered:
            assert after(bend, one.interval) >= one.needed_s
        assert after(bend, one.interval) >= one.interval.duration
    for interval in fixed:
        assert after(bend, interval) == interval.duration
    needed = sum((max(F(0), w.needed_s - w.interval.duration) for w in asked), F(0))
    assert bend.extra_s <= needed + len(bend.knots) * len(asked) * STEP_S
    for time in (F(0), F("0.33"), F("1.7"), F(5)):
        assert bend.inverse(bend(time)) == time


def _joined(fixed: Sequence[Interval]) -> list[Interval]:
    out: list[Interval] = []
    for interval in fixed:
        if out and interval.start <= out[-1].end:
            out[-1] = Interval(out[-1].start, interval.end)
        else:
            out.append(interval)
    return out


@settings(max_examples=examples(1.5))
@given(trees(), st.lists(ways, min_size=1, max_size=4))
def test_order_and_coincidences_stay_on_all_levels(score: Score, asked: Sequence[Way]) -> None:
    bend = bend_for(asked)
    bent = warped(score, bend)
    for before, now in zip(leaves(score), leaves(bent), strict=True):
        assert before.path == now.path
        assert now.interval == Interval(bend(before.interval.start), bend(before.interval.end))
    assert bent.duration == bend(score.duration)


@settings(max_examples=examples(1.5))
@given(trees(), st.lists(ways, min_size=1, max_size=4), st.integers(0, 2))
def test_what_keeps_its_clock_begins_on_time_and_keeps_its_times(
    score: Score, asked: Sequence[Way], name: int
) -> None:
    bend, kept = bend_for(asked), set()

    def keeps(part: Score) -> bool:
        found = isinstance(part, Group) and len(part.blocks) == name
        if found:
            kept.add(part)
        return found

    bent = warped(score, bend, keeps)
    for before, now in zip(leaves(score), leaves(bent), strict=True):
        whole = next((g for g in before.parents if keeps(g)), None)
        if whole is None:
            assert now.interval.start == bend(before.interval.start)
            continue
        outer = now.parents[before.parents.index(whole)]
        assert outer == whole
        assert now.interval.duration == before.interval.duration
    for leaf in leaves(bent):
        for group in leaf.parents:
            assert group.duration == max(b.interval_in_parent.end for b in group.blocks)


def test_a_bend_of_many_rounds_has_short_fractions() -> None:
    time = F("0.37")
    for n in range(4):
        time = bend_for([way(F(0), F("0.5") + time, F(2 + n))])(time)
    assert time.denominator < 10**30


@pytest.mark.parametrize("time", ["-1", "0", "0.5", "7"])
def test_nothing_changes_on_a_line_without_pieces(time: str) -> None:
    assert Bend()(F(time)) == F(time)
