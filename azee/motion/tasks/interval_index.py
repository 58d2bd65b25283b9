"""An index of intervals: what lasts at an instant, found without asking every item."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable
from fractions import Fraction
from typing import Generic, TypeVar

from azee.score.interval import Interval

T = TypeVar("T")


class IntervalIndex(Generic[T]):
    """Items that last for an interval each, both ends included.

    The starts and ends of all intervals cut the time line into stretches. Each stretch lists the
    items that last in it, so a query takes as long as its answer is.
    """

    def __init__(self, items: Iterable[tuple[Interval, T]]) -> None:
        self._entries = [*items]
        ends = [(float(span.start), float(span.end)) for span, _ in self._entries]
        self._instants: list[float] = sorted({t for span in ends for t in span})
        position = {t: i for i, t in enumerate(self._instants)}
        self._ends = [(position[start], position[end]) for start, end in ends]
        self._stretches: list[list[int]] = [[] for _ in self._instants]
        for k, (first, last) in enumerate(self._ends):
            for i in range(first, last + 1):
                self._stretches[i].append(k)

    def at(self, time: Fraction) -> list[T]:
        """Return what lasts at an instant, in the order given."""
        return self._covering(float(time), float(time))

    def covering(self, interval: Interval) -> list[T]:
        """Return what lasts from the start of an interval to its end, in the order given."""
        return self._covering(float(interval.start), float(interval.end))

    def _covering(self, first: float, last: float) -> list[T]:
        i = bisect_right(self._instants, first) - 1
        if i < 0:
            return []
        end = bisect_left(self._instants, last, lo=i)
        return [self._entries[k][1] for k in self._stretches[i] if self._ends[k][1] >= end]

    def overlapping(self, interval: Interval) -> list[T]:
        """Return what shares an instant with an interval, in the order given."""
        return [item for _, item in self.overlapping_entries(interval)]

    def overlapping_entries(self, interval: Interval) -> list[tuple[Interval, T]]:
        """Return what shares an instant with an interval, each with its own interval."""
        start = bisect_left(self._instants, float(interval.start))
        end = bisect_right(self._instants, float(interval.end)) - 1
        near = {k for stretch in self._stretches[max(0, start - 1) : end + 1] for k in stretch}
        return [
            self._entries[k]
            for k in sorted(near)
            if self._ends[k][0] <= end and start <= self._ends[k][1]
        ]
