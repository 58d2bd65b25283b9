"""A way that an arm goes, and the time that it has and needs for it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from azee.score.interval import Interval


@dataclass(frozen=True, slots=True)
class Way:
    """An arm's way from one key posture to the next, or along a path.

    side: `L` or `R`. interval: when, on the score's time line. needed_s: how long a person needs.
    way_m: length of the way of the wrist, or of a path. turn_rad: largest turn of a coordinate of
    the arm from the start to the end. source, target: paths of the blocks that it leads from and
    to.
    """

    side: str
    interval: Interval
    needed_s: Fraction
    way_m: float
    turn_rad: float
    source: tuple[str, ...]
    target: tuple[str, ...]

    @property
    def lacks(self) -> Fraction:
        """How many times longer than it has it needs."""
        return self.needed_s / self.interval.duration
