"""Stretches a score to another length.

Stretching multiplies every time inside a score by the same factor, offsets included. A `fixed` part
keeps its length: the time line of the whole has slope 1 while a fixed part lasts, and one common
slope elsewhere. So the whole has the new length, and order and coincidences are kept on all levels.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import accumulate

from azee.score.error import LayoutError
from azee.score.interval import Interval
from azee.score.moment import decimal
from azee.score.score import Group, Score

_ZERO = Fraction(0)


def stretched(score: Score, duration_s: Fraction) -> Score:
    """Return the score with another length.

    Raises: LayoutError: `cannot-stretch`, if the score is fixed, has blocks but no length, or would
        become shorter than its fixed parts.
    """
    if duration_s == score.duration:
        return score
    if duration_s < 0:
        raise ValueError("a score cannot have a negative length")
    if score.fixed:
        raise _refusal(f"a score fixed at {decimal(score.duration)} s", duration_s)
    if not isinstance(score, Group):
        return replace(score, duration=duration_s)
    return _warped(score, _ZERO, _warp(score, duration_s))


def _warped(score: Score, start: Fraction, warp: _Warp) -> Score:
    """Return a score that begins at `start` of the whole with all its times warped."""
    origin = warp(start)
    duration_s = warp(start + score.duration) - origin
    if not isinstance(score, Group):
        return replace(score, duration=duration_s)
    blocks = []
    for block in score.blocks:
        interval = block.interval_in_parent.shifted(start)
        warped = Interval(warp(interval.start) - origin, warp(interval.end) - origin)
        inner = _warped(block.score, interval.start, warp)
        blocks.append(replace(block, interval_in_parent=warped, score=inner))
    return replace(score, duration=duration_s, blocks=tuple(blocks))


@dataclass(frozen=True, slots=True)
class _Warp:
    """Slope 1 on the given disjoint intervals, in order; slope `factor` elsewhere."""

    factor: Fraction
    starts: tuple[Fraction, ...]
    lengths: tuple[Fraction, ...]
    before: tuple[Fraction, ...]
    """Fixed time before each interval, and after the last."""

    def __call__(self, time: Fraction) -> Fraction:
        i = bisect_right(self.starts, time)
        if i == 0:
            return time * self.factor
        kept = self.before[i - 1] + min(time - self.starts[i - 1], self.lengths[i - 1])
        return kept + (time - kept) * self.factor


def _warp(group: Group, duration_s: Fraction) -> _Warp:
    fixed = _merged(_fixed(group, _ZERO))
    lengths = tuple(i.duration for i in fixed)
    kept = sum(lengths, _ZERO)
    free = group.duration - kept
    if free == 0:
        what = f"its {decimal(kept)} s are all fixed" if kept else "a score without length"
        raise _refusal(what, duration_s)
    if duration_s < kept:
        raise _refusal(f"{decimal(kept)} s of it are fixed", duration_s)
    return _Warp(
        (duration_s - kept) / free,
        tuple(i.start for i in fixed),
        lengths,
        (_ZERO, *accumulate(lengths)),
    )


def _fixed(group: Group, start: Fraction) -> Iterator[Interval]:
    for block in group.blocks:
        at = start + block.interval_in_parent.start
        if block.score.fixed:
            yield Interval(at, at + block.score.duration)
        elif isinstance(block.score, Group):
            yield from _fixed(block.score, at)


def _merged(intervals: Iterator[Interval]) -> list[Interval]:
    merged: list[Interval] = []
    for interval in sorted(intervals):
        if not interval.duration:
            continue
        if merged and interval.start <= merged[-1].end:
            merged[-1] = Interval(merged[-1].start, max(merged[-1].end, interval.end))
        else:
            merged.append(interval)
    return merged


def _refusal(what: str, duration_s: Fraction) -> LayoutError:
    return LayoutError("cannot-stretch", f"cannot be stretched to {decimal(duration_s)} s: {what}")
