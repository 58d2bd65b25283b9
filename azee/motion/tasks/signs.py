"""Signs: which parts of a score ask something of the hands, and when."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set
from dataclasses import dataclass
from fractions import Fraction

from azee.score.score import Group, Recorded, Score, leaves


@dataclass(frozen=True, slots=True)
class Sign:
    """A rule's application that asks something of the hands and holds no other that does.

    Applications of the same rule that follow each other inside one other are one sign: movements
    of it. Times are the score's.
    """

    rule: str
    start_s: float
    end_s: float


def signs(score: Score, manual: Iterable[tuple[str, ...]]) -> tuple[Sign, ...]:
    """Return the signs of a score in order; empty if no rule makes one.

    Args: manual: paths of the blocks that ask something of arms or fingers.
    """
    played = (leaf.path for leaf in leaves(score) if isinstance(leaf.score, Recorded))
    paths = {path[:n] for path in (*manual, *played) for n in range(len(path) + 1)}
    found = _signs(score, (), Fraction(0), paths)
    return tuple(sorted(found, key=lambda s: (s.start_s, s.end_s)))


def _signs(
    score: Score, path: tuple[str, ...], start: Fraction, manual: Set[tuple[str, ...]]
) -> Iterator[Sign]:
    if path not in manual:
        return
    inside: list[Sign] = []
    for block in score.blocks if isinstance(score, Group) else ():
        at = start + block.interval_in_parent.start
        for sign in _signs(block.score, (*path, block.name), at, manual):
            if inside and inside[-1].rule == sign.rule and score.calls:
                sign = Sign(sign.rule, inside.pop().start_s, sign.end_s)
            inside.append(sign)
    if inside:
        yield from inside
    elif score.calls:
        name = score.calls[-1].recorded or score.calls[-1].rule
        yield Sign(name, float(start), float(start + score.duration))
