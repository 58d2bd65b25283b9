"""Half-open intervals of exact time."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True, slots=True, order=True)
class Interval:
    """`[start, end)` in seconds, exact. The owner of an interval documents its frame."""

    start: Fraction
    end: Fraction

    def __post_init__(self) -> None:
        if self.end < self.start:
            raise ValueError(f"an interval cannot end ({self.end}) before it starts ({self.start})")

    @property
    def duration(self) -> Fraction:
        """Length in seconds; zero is legal."""
        return self.end - self.start

    def shifted(self, by: Fraction) -> Interval:
        """Return it moved later by `by` seconds."""
        return Interval(self.start + by, self.end + by)

    def scaled(self, factor: Fraction) -> Interval:
        """Return it with both bounds multiplied."""
        return Interval(self.start * factor, self.end * factor)
