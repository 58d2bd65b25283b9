"""Scores, the values of AZee utterances: nested, exactly timed, independent of any rig.

A leaf says what the body does for a while. A `Key` has a set of constraints, a `Hold` keeps what
another block reached, a `Recorded` plays a recorded sign, and a `Blank` has no constraints. A
`Group` places named blocks on its own time line, which starts at zero with its earliest block and
ends with its latest.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from fractions import Fraction
from typing import TypeAlias

from azee.score.interval import Interval
from azee.score.recorded_motion import RecordedMotion
from azee_solver.constraint import Constraint, Manner, Origin
from azee_solver.geometry import Side


@dataclass(frozen=True, slots=True)
class Call:
    """The rule application that a score came from.

    handed_over: whether the rule was an argument, such as `.nb-5`, of what applied it. mouthed:
    the text, where the score is a mouthing. recorded: the name of the sign, where it is a
    recording. For both, `rule` is the operator's name.
    """

    rule: str
    origin: Origin | None = field(default=None, compare=False)
    handed_over: bool = field(default=False, compare=False)
    mouthed: str | None = None
    recorded: str | None = None

    @property
    def title(self) -> str:
        """How people call it: the rule's name, what is mouthed, or the recorded sign."""
        if self.recorded is not None:
            return self.recorded
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
    """A set of constraints kept for a duration; zero is legal.

    manner: how what they move arrives; none for the usual way.
    """

    constraints: tuple[Constraint, ...] = ()
    manner: Manner | None = None


@dataclass(frozen=True, slots=True)
class Hold(_Score):
    """Keeps what the sibling `block` of the enclosing group had reached at its end.

    `channels` are names of `CHANNELS`.
    """

    block: str = ""
    channels: tuple[str, ...] = ("hands",)


SIDE_CHANNELS: Mapping[str, Side] = {
    "strong": Side.STRONG,
    "weak": Side.WEAK,
    "left": Side.LEFT,
    "right": Side.RIGHT,
}
"""Channels that are one arm with its hand."""

CHANNELS = ("hands", *SIDE_CHANNELS, "face", "head", "trunk", "eyes")


@dataclass(frozen=True, slots=True)
class Blank(_Score):
    """A score without constraints."""


@dataclass(frozen=True, slots=True)
class Recorded(_Score):
    """Plays a recorded sign.

    motion: where its movement is from. attack_s, decay_s: how long the body needs into what the
    sign means and out of it. A stretch changes what is between, as long as there is room.
    mirrored: whether the other hand signs.
    """

    motion: RecordedMotion
    attack_s: Fraction
    decay_s: Fraction
    mirrored: bool = False

    @property
    def body(self) -> Interval:
        """When its movement is that of the recording, from its own start on."""
        leads = self.attack_s + self.decay_s
        share = min(Fraction(1), self.duration / leads) if leads else Fraction(1)
        return Interval(share * self.attack_s, self.duration - share * self.decay_s)


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


Score: TypeAlias = Key | Hold | Recorded | Blank | Group


def is_mouthing(score: Score) -> bool:
    """Whether a score is a mouthing itself, not only one of its blocks."""
    return any(call.mouthed is not None for call in score.calls)


def came_from(score: Score, call: Call) -> Score:
    """Return the score as the result of one more rule application, the outermost."""
    duration, calls, fixed = score.duration, (call, *score.calls), score.fixed
    match score:
        case Key():
            constraints, manner = score.constraints, score.manner
            return Key(duration, calls=calls, fixed=fixed, constraints=constraints, manner=manner)
        case Hold():
            return Hold(
                duration, calls=calls, fixed=fixed, block=score.block, channels=score.channels
            )
        case Recorded():
            return replace(score, calls=calls)
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
    score: Key | Hold | Recorded | Blank
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
