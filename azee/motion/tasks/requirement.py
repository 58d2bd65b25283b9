"""A requirement: one constraint of one block, on the time line of the whole score."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from azee.score.interval import Interval
from azee_solver.constraint import Constraint


@dataclass(frozen=True, slots=True)
class Requirement:
    """A constraint, when it holds, and where it stands in the score.

    path: names of the blocks that lead to it, outermost first. rule: the innermost rule
    application it stands in. interval: when it holds. motion: the interval over which its dynamic
    points move; differs from `interval` in a hold, which keeps them where they ended. rank: order
    in the nesting, which breaks ties between blocks of equal start. held_channels: which parts of
    the body each hold keeps that it comes through; only a rig tells which part it concerns.
    """

    constraint: Constraint
    path: tuple[str, ...]
    rule: str | None
    interval: Interval
    motion: Interval
    rank: int
    held_channels: tuple[tuple[str, ...], ...] = ()

    def covers(self, time: Fraction) -> bool:
        """Whether it holds at an instant, both ends included."""
        return self.interval.start <= time <= self.interval.end

    def starts_or_runs(self, time: Fraction) -> bool:
        """Whether it holds from an instant on; a block of no length counts at its instant."""
        return self.covers(time) and (
            time < self.interval.end or self.interval.start == self.interval.end
        )
