"""Checks of a whole score once the signer's dominant hand is known."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from fractions import Fraction
from functools import lru_cache

from azee.lang.conflict import orient_conflict
from azee.lang.fault import did_you_mean
from azee.lang.unshowable import unshowable
from azee.score.interval import Interval
from azee.score.score import Hold, Key, Leaf, Score, leaves
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Span
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Orient,
    Origin,
    Place,
    Relation,
    Transpath,
)
from azee_solver.geometry import Side, Swing, Was
from azee_solver.notation import constraint_text

SpanOf = Callable[[Origin], Span | None]

TURN = Swing(None, None)
"""The direction of an axis that turns from the orientation before to the one after."""


def audit(score: Score, dominant: Side, span_of: SpanOf, whole: Span) -> Iterator[Diagnostic]:
    """Yield `orient-conflict`, `transpath-ends` and blocks to hold or recall that there are not.

    Warnings, `beyond-body` and `zero-vector`, come last.

    `span_of` finds the place of a constraint in the text; `whole` is the utterance.
    """

    def where(constraint: Constraint) -> Span:
        found = None if constraint.origin is None else span_of(constraint.origin)
        return found or whole

    if isinstance(score, Hold):
        message = f"there is no block `{score.block}` to hold: this hold stands alone"
        yield Diagnostic("unknown-block", message, whole)
    found = [leaf for leaf in leaves(score) if isinstance(leaf.score, Key)]
    for leaf in found:
        constraints = _constraints(leaf)
        conflict = orient_conflict(constraints, dominant)
        if conflict is not None:
            message, number = conflict
            hand = "left" if dominant is Side.LEFT else "right"
            message += f" when the dominant hand is the {hand} one"
            yield Diagnostic("orient-conflict", message, where(constraints[number]))
    yield from _transpath_ends(found, dominant, where)
    yield from _turn_ends(found, dominant, where)
    yield from _never_was(found, where)
    yield from unshowable(score, dominant, where)


def _turn_ends(
    found: list[Leaf], dominant: Side, where: Callable[[Constraint], Span]
) -> Iterator[Diagnostic]:
    """Find the blocks that orient an axis before and after it turns."""
    oriented: dict[tuple[BoneAxis, str], list[Leaf]] = {}
    for leaf in found:
        for c in _constraints(leaf):
            if isinstance(c, Orient) and c.vector != TURN and c.relation is Relation.ALONG:
                oriented.setdefault((c.axis, c.bone.key(dominant)), []).append(leaf)
    for leaf in found:
        for c in _constraints(leaf):
            if not (isinstance(c, Orient) and c.vector == TURN):
                continue
            others = oriented.get((c.axis, c.bone.key(dominant)), [])
            own = leaf.interval
            before = any(o.interval.start <= own.start and o is not leaf for o in others)
            after = any(o.interval.end >= own.end and o is not leaf for o in others)
            if not (before and after):
                side = "after" if before else "before"
                axis = constraint_text(c).removeprefix("turning ")
                message = f"no block orients `{axis}` {side} this turn"
                help_ = f"orient it {side}, or give both directions: `orient … 'along (swing V W)`"
                yield Diagnostic("transpath-ends", message, where(c), help=help_)


def _never_was(found: list[Leaf], where: Callable[[Constraint], Span]) -> Iterator[Diagnostic]:
    """Find points as they were at the end of blocks that there are not."""
    for leaf in found:
        recalling = [(c, was) for c in _constraints(leaf) for was in _points_as_they_were(c)]
        if recalling:
            around = {
                block.name
                for own, group in zip(leaf.path, leaf.parents, strict=True)
                for block in group.blocks
                if block.name != own
            }
            for constraint, was in recalling:
                if was.block not in around:
                    message = f"there is no block `{was.block}` beside this one or around it"
                    help_ = did_you_mean(was.block, sorted(around), "'")
                    yield Diagnostic("unknown-block", message, where(constraint), help=help_)


@lru_cache(maxsize=4096)
def _points_as_they_were(constraint: Constraint) -> tuple[Was, ...]:
    return tuple(_wases(constraint))


def _wases(node: object) -> Iterator[Was]:
    if isinstance(node, Was):
        yield node
    elif isinstance(node, tuple):
        for item in node:
            yield from _wases(item)
    elif is_dataclass(node):
        for part in fields(node):
            yield from _wases(getattr(node, part.name))


def _constraints(leaf: Leaf) -> tuple[Constraint, ...]:
    assert isinstance(leaf.score, Key)
    return leaf.score.constraints


def _transpath_ends(
    found: list[Leaf], dominant: Side, where: Callable[[Constraint], Span]
) -> Iterator[Diagnostic]:
    """Find the blocks at both ends of a controlled movement.

    Of the blocks that place a site, the one that starts first (of those, that ends first) and the
    one that ends last (of those, that starts last) show whether there is any before or after.
    """
    first: dict[str, tuple[Fraction, Fraction]] = {}
    last: dict[str, tuple[Fraction, Fraction]] = {}
    moved: list[tuple[Transpath, Interval]] = []
    for leaf in found:
        start, end = leaf.interval.start, leaf.interval.end
        for constraint in _constraints(leaf):
            if isinstance(constraint, Place):
                key = constraint.site.key(dominant)
                first[key] = min(first.get(key, (start, end)), (start, end))
                last[key] = max(last.get(key, (end, start)), (end, start))
            elif isinstance(constraint, Transpath):
                moved.append((constraint, leaf.interval))
    for constraint, interval in moved:
        key = constraint.site.key(dominant)
        start, end = interval.start, interval.end
        before = key in first and first[key] < (start, end)
        after = key in last and last[key] > (end, start)
        missing = [word for word, there in (("before", before), ("after", after)) if not there]
        if missing:
            site = constraint.site
            operands = f"({site.side.value})" if site.side else ""
            message = f"no block places `@{site.name}{operands}` {' or '.join(missing)} this path"
            yield Diagnostic(
                "transpath-ends",
                message,
                where(constraint),
                help="a path leads from a block that places its site to another one",
            )
