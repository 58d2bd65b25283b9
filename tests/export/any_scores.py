"""Scores of any shape: blocks anywhere in their parents, overlapping, of no length, nested."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import strategies as st

from azee.score.interval import Interval
from azee.score.score import Block, Group, Key, Score

TIMES = st.fractions(min_value=0, max_value=5, max_denominator=20)
INTERVALS = st.tuples(TIMES, TIMES).map(lambda pair: Interval(min(pair), max(pair)))


def _groups(inner: st.SearchStrategy[Score]) -> st.SearchStrategy[Score]:
    """Groups whose blocks lie anywhere; their scores keep lengths of their own."""
    return st.lists(st.tuples(INTERVALS, inner), min_size=1, max_size=4).map(
        lambda placed: Group(
            max(i.end for i, _ in placed),
            blocks=tuple(Block(f"b{n}", i, _fitted(s, i)) for n, (i, s) in enumerate(placed)),
        )
    )


def _fitted(score: Score, interval: Interval) -> Score:
    """Stretch or cut a score to an interval: a leaf by its length, a group by its blocks'."""
    if not isinstance(score, Group):
        return Key(interval.duration)
    factor = interval.duration / score.duration if score.duration else Fraction(0)
    return Group(
        interval.duration,
        blocks=tuple(
            Block(
                b.name,
                b.interval_in_parent.scaled(factor),
                _fitted(b.score, b.interval_in_parent.scaled(factor)),
            )
            for b in score.blocks
        ),
    )


SCORES = st.recursive(st.builds(Key, TIMES), _groups, max_leaves=12)
