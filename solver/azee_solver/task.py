"""Tasks: the constraints in force at one moment, each with where it stands in the score."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.hashing import RemembersHash, hash_once

PRECEDENCE: tuple[frozenset[type], ...] = (
    frozenset({Place}),
    frozenset({Transpath}),
    frozenset({LookAt, Look}),
    frozenset({Trill}),
    frozenset({Orient, Rotate}),
    frozenset({Morph}),
)
"""Order of constraints that start together, first to last (Sharma 2024). The same group's slides
of 2022 print another one: it is data, so that either can be had."""

_PLACE = {kind: place for place, kinds in enumerate(PRECEDENCE) for kind in kinds}


@hash_once
@dataclass(frozen=True, slots=True)
class Task(RemembersHash):
    """A constraint that is active at the moment that is solved.

    path: names of the blocks that lead to it, outermost first. start_s: when its block starts, on
    the time line of the whole score. rank: order in which it was written, the last tie breaker.
    phase: how much of its block has passed, from 0 to 1: where a dynamic point has got to.
    """

    constraint: Constraint
    path: tuple[str, ...] = ()
    start_s: Fraction = Fraction(0)
    rank: int = 0
    phase: float = 0.0

    @property
    def order(self) -> tuple[Fraction, int, int]:
        """Sorting key: start time, then precedence of the kind, then order of writing."""
        return self.start_s, _PLACE[type(self.constraint)], self.rank
