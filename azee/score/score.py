"""Scores, the values of AZee utterances: nested, exactly timed, independent of any rig.

A leaf says what the body does for a while. A `Key` has a set of constraints, a `Hold` keeps what
another block reached, and a `Blank` has no constraints. A `Group` places named blocks on its own
time line, which starts at zero with its earliest block and ends with its latest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from fractions import Fraction
from typing import TypeAlias

from azee.score.interval import Interval
from azee_solver.constraint import Constraint, Origin


@dataclass(frozen=True, slots=True)
class Call:
    """The rule application that a score came from.

    handed_over: whether the rule was an argument, such as `.nb-5`, of what applied it. mouthed:
    the text, where the score is a mouthing; `rule` is then the operator's name.
    """

    rule: str
    origin: Origin | None = field(default=None, compare=False)
    handed_over: bool = field(default=False, compare=False)
    mouthed: str | None = None

    @property
    def title(self) -> str:
        """How people call it: the rule's name, or what is mouthed."""
        return self.rule if self.mouthed is None else f"“{self.mouthed}”"


@dataclass(frozen=True, slots=True)
class _Score:
    duration: Fraction
    calls: tuple[Call, ...] = field(default=(), kw_only=True)
    """Rules whose result this score is, outermost first; empty for a score built in place."""
    fixed: bool = field(default=False, kw_only=True)
    """Whether it keeps its length when the score around it is stretched."""


@dataclass(frozen=True, slots=True)
class Key(_Score):
    """A set of constraints kept for a duration; zero is legal."""

    constraints: tuple[Constraint, ...] = ()


@dataclass(frozen=True, slots=True)
class Hold(_Score):
    """Keeps what the sibling `block` of the enclosing group had reached at its end.

    `channels` are names of `CHANNELS`.
    """

    block: str = ""
    channels: tuple[str, ...] = ("hands",)


CHANNELS = ("hands", "face", "head", "trunk", "eyes")


@dataclass(frozen=True, slots=True)
class Blank(_Score):
    """A score without constraints."""


class Arrangement(Enum):
    """How a group's blocks were laid out; their intervals are exact in either case."""

    SYNC = "sync"
    SEQ = "seq"


@dataclass(frozen=True, slots=True)
class Block:
    """A named score at a place on the time line of its group."""

    name: str
    interval_in_parent: Interval
    score: Score


@dataclass(frozen=True, slots=True)
class Group(_Score):
    """Named blocks on one time line. Names are unique; in a `seq` they are `1`, `2` and so on."""

    arrangement: Arrangement = Arrangement.SYNC
    blocks: tuple[Block, ...] = ()

    def block(self, name: str) -> Block:
        """Return the block of that name. Raises KeyError."""
        for block in self.blocks:
            if block.name == name:
                return block
        raise KeyError(name)


Score: TypeAlias = Key | Hold | Blank | Group


def is_mouthing(score: Score) -> bool:
    """Whether a score is a mouthing itself, not only one of its blocks."""
    return any(call.mouthed is not None for call in score.calls)


def came_from(score: Score, call: Call) -> Score:
    """Return the score as the result of one more rule application, the outermost."""
    duration, calls, fixed = score.duration, (call, *score.calls), score.fixed
    match score:
        case Key():
            return Key(duration, calls=calls, fixed=fixed, constraints=score.constraints)
        case Hold():
            return Hold(
                duration, calls=calls, fixed=fixed, block=score.block, channels=score.channels
            )
        case Blank():
            return Blank(duration, calls=calls, fixed=fixed)
        case Group():
            return Group(
                duration,
                calls=calls,
                fixed=fixed,
                arrangement=score.arrangement,
                blocks=score.blocks,
            )


@dataclass(frozen=True, slots=True)
class Leaf:
    """A leaf of a nested score on the one time line of the whole."""

    path: tuple[str, ...]
    """Names of the blocks that lead to it, outermost first."""
    interval: Interval
    """On the time line of the whole score."""
    score: Key | Hold | Blank
    parents: tuple[Group, ...]
    """The groups around it, outermost first, one per name in `path`."""


def leaves(score: Score) -> Iterator[Leaf]:
    """Yield all leaves in order of nesting, on the time line of `score`, which starts at zero."""
    yield from _leaves(score, (), Fraction(0), ())


def _leaves(
    score: Score, path: tuple[str, ...], start: Fraction, parents: tuple[Group, ...]
) -> Iterator[Leaf]:
    if isinstance(score, Group):
        for block in score.blocks:
            yield from _leaves(
                block.score,
                (*path, block.name),
                start + block.interval_in_parent.start,
                (*parents, score),
            )
    else:
        yield Leaf(path, Interval(start, start + score.duration), score, parents)
