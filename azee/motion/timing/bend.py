"""A bend of time: a line of pieces that stretches a time line where ways need longer."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from azee.motion.timing.way import Way
from azee.score.interval import Interval

STEP_S = Fraction(1, 1000)
"""Pieces become longer by whole steps: sums of many stretches stay short fractions."""


@dataclass(frozen=True, slots=True)
class Bend:
    """Times `knots` become `images`, both increasing; linear between them, slope 1 beyond them."""

    knots: tuple[Fraction, ...] = (Fraction(0),)
    images: tuple[Fraction, ...] = (Fraction(0),)

    def __call__(self, time: Fraction) -> Fraction:
        """Return what a time becomes."""
        i = bisect_right(self.knots, time) - 1
        if i < 0:
            return self.images[0] + (time - self.knots[0])
        since = time - self.knots[i]
        if i + 1 == len(self.knots):
            return self.images[i] + since
        slope = (self.images[i + 1] - self.images[i]) / (self.knots[i + 1] - self.knots[i])
        return self.images[i] + since * slope

    @property
    def inverse(self) -> Bend:
        """The bend that leads back."""
        return Bend(self.images, self.knots)

    @property
    def extra_s(self) -> Fraction:
        """By how much it lengthens the whole."""
        return (self.images[-1] - self.knots[-1]) - (self.images[0] - self.knots[0])


def bend_for(ways: Iterable[Way], fixed: Sequence[Interval] = ()) -> Bend:
    """Return the bend after which every way has its time, as far as `fixed` intervals allow.

    The starts and ends of ways cut the time line into pieces. Ways are served from the one that
    lacks the largest share of its time. What a way still lacks goes to its pieces of least slope,
    until these have one slope: so ways that overlap share what they need.
    """
    ordered = sorted(ways, key=lambda w: (-w.lacks, w.interval))
    if not ordered:
        return Bend()
    times = {t for w in ordered for t in (w.interval.start, w.interval.end)}
    first, last = min(times), max(times)
    times |= {t for i in fixed for t in (i.start, i.end) if first < t < last}
    knots = sorted(times)
    index = {t: i for i, t in enumerate(knots)}
    lengths = [b - a for a, b in pairwise(knots)]
    bendable = _outside(knots, fixed)
    extra = [Fraction(0)] * len(lengths)
    for way in ordered:
        pieces = range(index[way.interval.start], index[way.interval.end])
        lacking = way.needed_s - sum((lengths[i] + extra[i] for i in pieces), Fraction(0))
        _raise([i for i in pieces if bendable[i]], lacking, lengths, extra)
    images = [knots[0]]
    for length, more in zip(lengths, extra, strict=True):
        images.append(images[-1] + length + more)
    return Bend(tuple(knots), tuple(images))


def _outside(knots: Sequence[Fraction], fixed: Sequence[Interval]) -> list[bool]:
    """Return of every piece between knots whether it is outside disjoint, ordered intervals."""
    starts = [i.start for i in fixed]
    out = []
    for a in knots[:-1]:
        i = bisect_right(starts, a) - 1
        out.append(i < 0 or a >= fixed[i].end)
    return out


def _raise(
    pieces: Sequence[int], lacking: Fraction, lengths: Sequence[Fraction], extra: list[Fraction]
) -> None:
    """Lengthen the pieces of least slope until they are longer by `lacking` and of one slope."""
    if lacking <= 0 or not pieces:
        return
    by_slope = sorted(pieces, key=lambda i: extra[i] / lengths[i])
    length, level = Fraction(0), Fraction(0)
    raised = Fraction(0)
    """What the pieces so far have already, beyond their length."""
    for n, i in enumerate(by_slope):
        length += lengths[i]
        raised += extra[i]
        level = (raised + lacking) / length
        if n + 1 == len(by_slope):
            break
        following = by_slope[n + 1]
        if level <= extra[following] / lengths[following]:
            break
    for i in by_slope[: n + 1]:
        steps = math.ceil(lengths[i] * level / STEP_S)
        extra[i] = max(extra[i], steps * STEP_S)
