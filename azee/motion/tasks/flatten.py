"""From the nested score to one time line (Nunnari, Filhol & Heloir 2018, section 4.1).

Blocks are projected on a single time line. A keyframe stands at every block boundary and carries
a copy of every constraint that holds at that instant, so a block is in the keyframe it starts at,
in the one it ends at and in all between. Blocks of no length give one keyframe.

At a boundary where one block ends and another begins, the keyframe carries both: `closing` is
what ends there and `opening` what begins or goes on. One posture serves both when it can; when it
cannot, the instant belongs to the opening blocks and the closing block ends early (see
`azee.motion.keys.boundaries`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import count, repeat
from typing import TypeAlias

from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.requirement import Requirement
from azee.score.interval import Interval
from azee.score.score import Blank, Block, Group, Hold, Key, Leaf, Recorded, Score, leaves
from azee_solver.constraint import Transpath, Trill


@dataclass(frozen=True, slots=True)
class Keyframe:
    """An instant of the time line and every constraint that holds at it."""

    time: Fraction
    requirements: tuple[Requirement, ...]

    @property
    def opening(self) -> tuple[Requirement, ...]:
        """What begins here or goes on."""
        return tuple(r for r in self.requirements if r.starts_or_runs(self.time))

    @property
    def closing(self) -> tuple[Requirement, ...]:
        """What ends here, and had begun before."""
        return tuple(r for r in self.requirements if not r.starts_or_runs(self.time))


@dataclass(frozen=True, slots=True)
class RecordedLeaf:
    """A recorded sign on the time line. path: names of the blocks that lead to it."""

    path: tuple[str, ...]
    interval: Interval
    score: Recorded


@dataclass(frozen=True, slots=True)
class Timeline:
    """A flattened score: its length, all it requires, and the keyframes at its boundaries.

    recordings: its recorded signs.
    """

    duration: Fraction
    requirements: tuple[Requirement, ...]
    keyframes: tuple[Keyframe, ...]
    recordings: tuple[RecordedLeaf, ...] = ()


def flatten(score: Score) -> Timeline:
    """Project a nested score on one time line; times stay exact.

    Raises: ValueError: a hold names no sibling block, or blocks hold each other in a circle.
    """
    found = [*leaves(score)]
    inside: dict[tuple[str, ...], list[Leaf]] = {}
    for leaf in found:
        for depth in range(len(leaf.path) + 1):
            inside.setdefault(leaf.path[:depth], []).append(leaf)
    ranks = count()
    required = [r for leaf in found for r in _required(leaf, inside, (), ranks)]
    times = sorted({t for leaf in found for t in (leaf.interval.start, leaf.interval.end)})
    in_force = IntervalIndex((r.interval, r) for r in required)
    keyframes = tuple(Keyframe(t, tuple(in_force.at(t))) for t in times)
    recordings = tuple(
        RecordedLeaf(leaf.path, leaf.interval, leaf.score)
        for leaf in found
        if isinstance(leaf.score, Recorded)
    )
    return Timeline(score.duration, tuple(required), keyframes, recordings)


_Inside: TypeAlias = Mapping[tuple[str, ...], Sequence[Leaf]]
"""Leaves by every path that leads to them."""


def _required(
    leaf: Leaf, inside: _Inside, holding: tuple[tuple[str, ...], ...], ranks: Iterator[int]
) -> Iterator[Requirement]:
    match leaf.score:
        case Key(constraints=constraints, manner=manner):
            for constraint in constraints:
                yield Requirement(
                    constraint, leaf.path, _rule(leaf), leaf.interval, leaf.interval,
                    rank=next(ranks), manner=manner,
                )  # fmt: skip
        case Hold():
            yield from _held(leaf, leaf.score, inside, holding, ranks)
        case Blank() | Recorded():
            pass


def _held(
    leaf: Leaf,
    hold: Hold,
    inside: _Inside,
    holding: tuple[tuple[str, ...], ...],
    ranks: Iterator[int],
) -> Iterator[Requirement]:
    """Extend the requirements of those leaves of the held block that last until its end.

    Trills and transpaths are movements, which nothing can hold: holds leave them out.
    """
    if leaf.path in holding:
        raise ValueError(f"blocks hold each other in a circle: {'/'.join(leaf.path)}")
    block, start = _sibling(leaf, hold)
    end = start + block.interval_in_parent.end
    for other in inside.get((*leaf.path[:-1], block.name), ()):
        if other.interval.end != end:
            continue
        for requirement in _required(other, inside, (*holding, leaf.path), repeat(0)):
            if not isinstance(requirement.constraint, Trill | Transpath):
                yield replace(
                    requirement,
                    path=leaf.path,
                    rule=_rule(leaf),
                    interval=leaf.interval,
                    rank=next(ranks),
                    held_channels=(*requirement.held_channels, hold.channels),
                )


def _sibling(leaf: Leaf, hold: Hold) -> tuple[Block, Fraction]:
    """Return the held block and the start of its group on the time line."""
    if not leaf.parents:
        raise ValueError("a hold stands alone: there is no block to hold")
    group: Group = leaf.parents[-1]
    try:
        block = group.block(hold.block)
    except KeyError:
        raise ValueError(f"there is no block '{hold.block}' to hold") from None
    return block, leaf.interval.start - group.block(leaf.path[-1]).interval_in_parent.start


def _rule(leaf: Leaf) -> str | None:
    """Return the innermost rule whose application the leaf stands in."""
    for score in (leaf.score, *reversed(leaf.parents)):
        if score.calls:
            return score.calls[-1].rule
    return None
