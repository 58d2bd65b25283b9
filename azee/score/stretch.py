"""Stretches a score to another length, or along any time line.

A time line maps times to times without changing their order; it is applied to the times of all
levels of a score. So order and coincidences are kept on all levels. Stretching to a length
multiplies every time inside a score by the same factor, offsets included. A `fixed` part keeps its
length: the time line of the whole has slope 1 while a fixed part lasts, and one common slope
elsewhere.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import accumulate
from typing import TypeAlias

from azee.score.error import LayoutError
from azee.score.interval import Interval
from azee.score.moment import decimal
from azee.score.score import Group, Score

_ZERO = Fraction(0)

TimeLine: TypeAlias = Callable[[Fraction], Fraction]
"""What a time of the whole becomes. It never decreases."""


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
    return warped(score, _warp(score, duration_s))


def paced(score: Score, factor: Fraction) -> Score:
    """Return the score with all lengths multiplied, but those of its fixed parts."""
    if factor <= 0:
        raise ValueError(f"a score cannot take {factor} times as long")
    if score.fixed or factor == 1:
        return score
    return warped(score, _Warp.of(fixed_intervals(score), factor))


def warped(
    score: Score, time_line: TimeLine, keeps_its_clock: Callable[[Score], bool] = lambda _: False
) -> Score:
    """Return the score with all its times moved along a time line.

    Args: keeps_its_clock: whether a score inside keeps its length and all its times. It begins when
        the time line says; where it was the last to end, what is around it may end earlier.
    """
    return _warped(score, _ZERO, time_line, keeps_its_clock)


def _warped(
    score: Score, start: Fraction, time_line: TimeLine, keeps_its_clock: Callable[[Score], bool]
) -> Score:
    """Return a score that begins at `start` of the whole with all its times moved."""
    if keeps_its_clock(score):
        return score
    origin = time_line(start)
    duration_s = time_line(start + score.duration) - origin
    if not isinstance(score, Group):
        return replace(score, duration=duration_s)
    blocks = []
    for block in score.blocks:
        interval = block.interval_in_parent.shifted(start)
        inner = _warped(block.score, interval.start, time_line, keeps_its_clock)
        begin = time_line(interval.start) - origin
        moved = Interval(begin, begin + inner.duration)
        blocks.append(replace(block, interval_in_parent=moved, score=inner))
    duration_s = max((b.interval_in_parent.end for b in blocks), default=duration_s)
    return replace(score, duration=duration_s, blocks=tuple(blocks))


def fixed_intervals(score: Score) -> tuple[Interval, ...]:
    """Return when fixed parts last on the time line of the whole: disjoint, in order."""
    whole = Interval(_ZERO, score.duration)
    found = iter((whole,)) if score.fixed else _fixed(score, _ZERO)
    return tuple(_merged(found))


@dataclass(frozen=True, slots=True)
class _Warp:
    """Slope 1 on the given disjoint intervals, in order; slope `factor` elsewhere."""

    factor: Fraction
    starts: tuple[Fraction, ...]
    lengths: tuple[Fraction, ...]
    before: tuple[Fraction, ...]
    """Fixed time before each interval, and after the last."""

    @staticmethod
    def of(fixed: Sequence[Interval], factor: Fraction) -> _Warp:
        """Return it for fixed intervals, disjoint and in order."""
        lengths = tuple(i.duration for i in fixed)
        starts = tuple(i.start for i in fixed)
        return _Warp(factor, starts, lengths, (_ZERO, *accumulate(lengths)))

    def __call__(self, time: Fraction) -> Fraction:
        i = bisect_right(self.starts, time)
        if i == 0:
            return time * self.factor
        kept = self.before[i - 1] + min(time - self.starts[i - 1], self.lengths[i - 1])
        return kept + (time - kept) * self.factor


def _warp(group: Group, duration_s: Fraction) -> _Warp:
    fixed = fixed_intervals(group)
    kept = sum((i.duration for i in fixed), _ZERO)
    free = group.duration - kept
    if free == 0:
        what = f"its {decimal(kept)} s are all fixed" if kept else "a score without length"
        raise _refusal(what, duration_s)
    if duration_s < kept:
        raise _refusal(f"{decimal(kept)} s of it are fixed", duration_s)
    return _Warp.of(fixed, (duration_s - kept) / free)


def _fixed(score: Score, start: Fraction) -> Iterator[Interval]:
    for block in score.blocks if isinstance(score, Group) else ():
        at = start + block.interval_in_parent.start
        if block.score.fixed:
            yield Interval(at, at + block.score.duration)
        else:
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
