"""Computes when the blocks of a `sync` start and end, from bounds that name each other.

The nodes of the dependency graph are bounds, not blocks: `A` may start with `B` while `B` ends with
`A`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from azee.score.error import LayoutError
from azee.score.interval import Interval
from azee.score.moment import Bound, Moment, decimal
from azee.score.score import Group, Score
from azee.score.stretch import stretched


@dataclass(frozen=True, slots=True)
class Placement:
    """The placement of a block: its start, end and length; missing values are natural.

    With both bounds, or with a length, the block is stretched. With neither it starts at zero.
    """

    start: Moment | None = None
    end: Moment | None = None
    duration_s: Fraction | None = None

    def __post_init__(self) -> None:
        if self.start is not None and self.end is not None and self.duration_s is not None:
            raise ValueError("two bounds and a length say too much")

    @classmethod
    def within(cls, block: tuple[str, ...]) -> Placement:
        """Return the bounds of another block."""
        return cls(Moment(block, Bound.START), Moment(block, Bound.END))


_Node = tuple[int, Bound]

_MOST_NAMED = 12
"""How many bounds of a long cycle are named, at its beginning and at its end."""
"""A bound of the block with that number."""


class Bounds:
    """The bounds of named blocks, computed when needed and each once."""

    def __init__(
        self, names: Sequence[str], scores: Sequence[Score], placements: Sequence[Placement]
    ) -> None:
        self._names = names
        self._scores = scores
        self._placements = placements
        self._number = {name: i for i, name in enumerate(names)}
        self._known: dict[_Node, Fraction] = {}
        self._fitted: dict[int, Score] = {}

    def interval(self, block: int) -> Interval:
        """Return the interval of a block; the first block starts at zero."""
        start = self._bound((block, Bound.START))
        end = self._bound((block, Bound.END))
        if end < start:
            raise LayoutError(
                "negative-duration",
                f"`{self._names[block]}` would end {decimal(start - end)} s before it starts",
                block,
            )
        return Interval(start, end)

    def score(self, block: int) -> Score:
        """Return a block's score, stretched to the length between its bounds."""
        if block not in self._fitted:
            duration_s = self.interval(block).duration
            try:
                self._fitted[block] = stretched(self._scores[block], duration_s)
            except LayoutError as error:
                message = f"`{self._names[block]}` {error}"
                raise LayoutError(error.code, message, block) from None
        return self._fitted[block]

    def _bound(self, wanted: _Node) -> Fraction:
        """Compute depth-first what a bound depends on, with a stack of our own: chains are long."""
        pending = [wanted]
        waiting: dict[_Node, None] = {}
        while pending:
            node = pending[-1]
            if node in self._known:
                pending.pop()
                continue
            open_nodes = [n for n in self._needed(node) if n not in self._known]
            if not open_nodes:
                self._known[node] = self._computed(node)
                waiting.pop(node, None)
                pending.pop()
                continue
            waiting[node] = None
            for needed in open_nodes:
                if needed in waiting:
                    raise self._circle([*waiting], needed)
            pending.extend(open_nodes)
        return self._known[wanted]

    def _needed(self, node: _Node) -> tuple[_Node, ...]:
        block, bound = node
        moment = self._moment(node)
        if moment is None:
            other = (block, Bound.END if bound is Bound.START else Bound.START)
            return () if self._stands_at_zero(node) else (other,)
        target = self._target(moment, node)
        if len(moment.path) == 1 and isinstance(moment.anchor, Bound):
            return ((target, moment.anchor),)
        return ((target, Bound.START), (target, Bound.END))

    def _computed(self, node: _Node) -> Fraction:
        block, bound = node
        moment = self._moment(node)
        if moment is not None:
            return self._time(moment, node)
        if self._stands_at_zero(node):
            return Fraction(0)
        duration_s = self._placements[block].duration_s
        if duration_s is None:
            duration_s = self._scores[block].duration
        if bound is Bound.END:
            return self._known[block, Bound.START] + duration_s
        return self._known[block, Bound.END] - duration_s

    def _moment(self, node: _Node) -> Moment | None:
        placement = self._placements[node[0]]
        return placement.start if node[1] is Bound.START else placement.end

    def _stands_at_zero(self, node: _Node) -> bool:
        return node[1] is Bound.START and self._placements[node[0]].end is None

    def _target(self, moment: Moment, node: _Node) -> int:
        """Return the number of the block that a bound refers to."""
        name = moment.path[0]
        if name not in self._number:
            raise self._unknown(f"there is no block `{name}`", name, self._names, node)
        return self._number[name]

    def _unknown(self, message: str, name: str, known: Iterable[str], node: _Node) -> LayoutError:
        block, bound = node
        return LayoutError(
            "unknown-block", message, block, name=name, known=tuple(known), bound=bound
        )

    def _time(self, moment: Moment, node: _Node) -> Fraction:
        target = self._target(moment, node)
        if len(moment.path) == 1 and isinstance(moment.anchor, Bound):
            return self._known[target, moment.anchor] + moment.offset_s
        interval = self.interval(target)
        if len(moment.path) > 1:
            interval = self._inner(moment, self.score(target), interval.start, node)
        if moment.anchor is Bound.START:
            time = interval.start
        elif moment.anchor is Bound.END:
            time = interval.end
        else:
            time = interval.start + interval.duration * moment.anchor
        return time + moment.offset_s

    def _inner(self, moment: Moment, score: Score, start: Fraction, node: _Node) -> Interval:
        """Return the interval of an inner block, on the time line of the whole `sync`."""
        outer = moment.path[0]
        interval = Interval(start, start + score.duration)
        for name in moment.path[1:]:
            if not isinstance(score, Group):
                message = f"`{outer}` has no blocks inside, so there is no `{outer}/{name}`"
                raise self._unknown(message, name, (), node)
            try:
                inner = score.block(name)
            except KeyError:
                known = (b.name for b in score.blocks)
                message = f"there is no block `{name}` inside `{outer}`"
                raise self._unknown(message, name, known, node) from None
            outer = f"{outer}/{name}"
            interval = inner.interval_in_parent.shifted(interval.start)
            score = inner.score
        return interval

    def _circle(self, waiting: list[_Node], node: _Node) -> LayoutError:
        circle = [*waiting[waiting.index(node) :], node]
        named = [f"`{self._names[b]}:{bound.value}`" for b, bound in circle]
        if len(named) > _MOST_NAMED:
            left_out = len(named) - _MOST_NAMED
            half = _MOST_NAMED // 2
            named[half:-half] = [f"{left_out:,} more, of which the last"]
        steps = " needs ".join(named)
        message = f"these bounds wait for each other: {steps}"
        return LayoutError("cyclic-sync", message, min(b for b, _ in circle))
