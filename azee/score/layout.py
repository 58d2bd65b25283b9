"""Lays out the blocks of `sync`, `seq` and `hold`: from parts to a group with exact times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from azee.score.bounds import Bounds, Placement
from azee.score.error import LayoutError
from azee.score.interval import Interval
from azee.score.score import Arrangement, Block, Group, Hold, Score

LONGEST_S = Fraction(24 * 60 * 60)
_MOST_BITS = 1024
_ZERO = Fraction(0)


@dataclass(frozen=True, slots=True)
class Part:
    """A block before it has a place on the time line."""

    name: str
    score: Score
    placement: Placement


def synchronised(parts: Sequence[Part]) -> Group:
    """Lay out the blocks of a `sync`.

    The first part starts at zero with its natural length. The others are placed by their placement,
    in any order of reference. The group starts with its earliest block, which may be before zero.

    Raises: LayoutError: `unknown-block`, `duplicate-block`, `cyclic-sync`, `negative-duration`,
        `cannot-stretch`, `size-limit`.
    """
    _require_distinct(parts)
    _require_holdable(parts)
    bounds = Bounds([p.name for p in parts], [p.score for p in parts], [p.placement for p in parts])
    intervals = [bounds.interval(i) for i in range(len(parts))]
    start = min(i.start for i in intervals)
    end = max(i.end for i in intervals)
    blocks = tuple(
        Block(part.name, interval.shifted(-start), bounds.score(i))
        for i, (part, interval) in enumerate(zip(parts, intervals, strict=True))
    )
    for i, block in enumerate(blocks):
        require_measurable(block.interval_in_parent.end, i)
    return Group(end - start, arrangement=Arrangement.SYNC, blocks=blocks)


def in_sequence(scores: Sequence[Score], gap_s: Fraction) -> Group:
    """Lay scores one after the other, `gap_s` apart; the blocks are called `1`, `2` and so on.

    Raises: LayoutError: `unknown-block` for a hold, which has no named sibling here;
    `size-limit`.
    """
    blocks = []
    time = _ZERO
    for i, score in enumerate(scores):
        if isinstance(score, Hold):
            raise LayoutError(
                "unknown-block",
                f"there is no block `{score.block}` to hold in a `seq`, whose blocks have no names",
                i,
            )
        start = time + gap_s if i else time
        time = start + score.duration
        blocks.append(Block(str(i + 1), Interval(start, time), score))
    require_measurable(time, None)
    return Group(time, arrangement=Arrangement.SEQ, blocks=tuple(blocks))


def held(score: Score, duration_s: Fraction, channels: tuple[str, ...]) -> Group:
    """Lay out the score, and after it a hold of its end for `duration_s`."""
    end = score.duration + duration_s
    require_measurable(end, None)
    kept = Hold(duration_s, block="SIG", channels=channels)
    blocks = (
        Block("SIG", Interval(_ZERO, score.duration), score),
        Block("HOLD", Interval(score.duration, end), kept),
    )
    return Group(end, arrangement=Arrangement.SYNC, blocks=blocks)


def require_measurable(time: Fraction, part: int | None) -> None:
    """Refuse times beyond a day and fractions whose exact value has become too long."""
    if time > LONGEST_S:
        raise LayoutError("size-limit", "a score lasts longer than a day", part)
    if time.denominator.bit_length() > _MOST_BITS:
        raise LayoutError("size-limit", "a time has too many digits to be kept exactly", part)


def _require_distinct(parts: Sequence[Part]) -> None:
    seen: set[str] = set()
    for i, part in enumerate(parts):
        if part.name in seen:
            raise LayoutError("duplicate-block", f"there are two blocks `{part.name}`", i)
        seen.add(part.name)


def _require_holdable(parts: Sequence[Part]) -> None:
    """Check that every hold names a sibling, and that none holds itself through others."""
    holds = {p.name: p.score.block for p in parts if isinstance(p.score, Hold)}
    names = {p.name for p in parts}
    for i, part in enumerate(parts):
        if not isinstance(part.score, Hold):
            continue
        seen = [part.name]
        while seen[-1] in holds:
            block = holds[seen[-1]]
            if block not in names:
                known = tuple(p.name for p in parts if p is not part)
                message = f"there is no block `{block}` to hold"
                raise LayoutError("unknown-block", message, i, name=block, known=known)
            if block in seen:
                circle = " holds ".join(f"`{name}`" for name in (*seen, block))
                raise LayoutError("cyclic-sync", f"blocks hold each other: {circle}", i)
            seen.append(block)
