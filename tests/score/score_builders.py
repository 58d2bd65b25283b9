"""Short ways to write scores, and random ones."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import strategies as st

from azee.score.bounds import Placement
from azee.score.layout import Part, in_sequence, synchronised
from azee.score.moment import parse_moment
from azee.score.score import Blank, Group, Score


def blank(seconds: str, *, fixed: bool = False) -> Blank:
    return Blank(Fraction(seconds), fixed=fixed)


def part(name: str, score: Score, rule: str = "", *operands: str) -> Part:
    """A block with its rule as a text writes it."""
    match rule:
        case "":
            placement = Placement()
        case "start/end":
            placement = Placement(parse_moment(operands[0]), parse_moment(operands[1]))
        case "start":
            placement = Placement(start=parse_moment(operands[0]))
        case "end":
            placement = Placement(end=parse_moment(operands[0]))
        case "start/dur":
            placement = Placement(parse_moment(operands[0]), None, Fraction(operands[1]))
        case "end/dur":
            placement = Placement(None, parse_moment(operands[0]), Fraction(operands[1]))
        case "with":
            placement = Placement.within(tuple(operands[0].split("/")))
        case _:
            raise ValueError(rule)
    return Part(name, score, placement)


def times(group: Group) -> dict[str, tuple[Fraction, Fraction]]:
    """When each block starts and ends."""
    return {b.name: (b.interval_in_parent.start, b.interval_in_parent.end) for b in group.blocks}


seconds = st.integers(0, 40).map(lambda n: Fraction(n, 10))
offsets = st.integers(-20, 20).map(lambda n: Fraction(n, 10))
leaf_scores = st.builds(lambda d, fixed: Blank(d, fixed=fixed), seconds, st.booleans())
scores: st.SearchStrategy[Score] = st.recursive(
    leaf_scores,
    lambda inner: st.one_of(
        st.builds(in_sequence, st.lists(inner, max_size=3), seconds),
        st.builds(
            lambda a, b, offset: synchronised(
                [part("A", a), part("B", b, "start", f"A:start:{float(offset)}")]
            ),
            inner,
            inner,
            offsets,
        ),
    ),
    max_leaves=6,
)
