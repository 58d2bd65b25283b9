"""Measuring how far a movement is from what the score requires, frame by frame."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.movement import Movement
from azee.motion.keys.transpath import Course
from azee.motion.tasks.timed_task import Bound, BoundScore, GivingWay
from azee_rig.chain import Frames
from azee_solver.constraint import Constraint, Morph, Place, Transpath
from azee_solver.evaluate import Evaluator, LengthOrAngle

Array = NDArray[np.float64]

TOLERANCE = {"m": 1e-3, "rad": math.radians(0.5)}
PATH_TOLERANCE_M = 2e-3
"""Of sites on moving targets and paths, between keys."""


@dataclass(frozen=True, eq=False)
class Instants:
    """A movement at some instants: exact times, coordinates (T, V) and frames (T, …)."""

    times: tuple[Fraction, ...]
    q: Array
    frames: Frames

    @cached_property
    def seconds(self) -> Array:
        """The times as numbers, (T,)."""
        return np.array([float(t) for t in self.times])

    def only(self, rows: slice) -> Instants:
        """Return some of the instants."""
        frames = Frames(self.frames.positions[rows], self.frames.rotations[rows])
        return Instants(self.times[rows], self.q[rows], frames)


def instants(movement: Movement, times: Iterable[Fraction], evaluator: Evaluator) -> Instants:
    """Sample a movement, with forward kinematics of all instants at once."""
    exact = tuple(times)
    q = movement.sample(np.array([float(t) for t in exact]))
    return Instants(exact, q, evaluator.rig.chain.frames(q))


@dataclass(frozen=True, slots=True, eq=False)
class Gauge:
    """What measures one score on one rig.

    courses: by rank of their transpath. giving_way: by rank of what gives way.
    """

    evaluator: Evaluator
    score: BoundScore
    courses: Mapping[int, Course]
    giving_way: Mapping[int, GivingWay]

    @property
    def measurable(self) -> tuple[Bound, ...]:
        """What a movement can be measured against."""
        return (*self.score.postures, *(c.travel.bound for c in self.courses.values()))

    def steering(self, time: Fraction) -> list[Course]:
        """Return the courses on which a site is at an instant."""
        found = (self.courses.get(b.requirement.rank) for b in self.score.paths_at.at(time))
        return [c for c in found if c is not None and c.travel.steers(time)]

    def tolerance(self, bound: Bound) -> float:
        """Largest residual that counts as met, metres or radians."""
        if bound.requirement.rank in self.courses:
            return PATH_TOLERANCE_M
        unit = self.unit(bound)
        return PATH_TOLERANCE_M if bound.dynamic and unit == "m" else TOLERANCE[unit]

    def unit(self, bound: Bound) -> LengthOrAngle:
        """Return the unit of a requirement's residual."""
        return unit_of(bound.constraint)

    def inside(self, bound: Bound, seconds: Array, *, enforced: bool = False) -> slice:
        """Return which of increasing instants are inside a block, both ends included.

        Args: enforced: stop where the block gives way to another.
        """
        r = bound.requirement
        first, last = float(r.interval.start), float(r.interval.end)
        if r.rank in self.courses:
            travel = self.courses[r.rank].travel
            first, last = float(travel.start), float(travel.end)
        last += _SAME_S
        given = self.giving_way.get(r.rank)
        if given is not None:
            # The end itself is the other block's.
            last = float(given.start) + _SAME_S if enforced else last - 2 * _SAME_S
        rows = np.searchsorted(seconds, (first - _SAME_S, last))
        return slice(int(rows[0]), max(int(rows[0]), int(rows[1])))

    def residual(self, bound: Bound, at: Instants) -> Array:
        """How far a requirement is from being met at instants inside its block, (T,)."""
        course = self.courses.get(bound.requirement.rank)
        if course is not None:
            site = self.evaluator.site(course.travel.constraint.site, at.frames)
            target = course.target(at.times, at.frames, self.evaluator)
            return np.asarray(np.linalg.norm(site - target, axis=-1))
        if bound.dynamic:
            return self._dynamic(bound, at)
        if not isinstance(bound.constraint, Morph):
            return self.evaluator.residual(bound.constraint, at.frames, at.q)[0]
        out = np.empty(len(at.times))
        for among, rows in self._morphs(bound, at):
            part = at.only(rows)
            value = self.evaluator.residual(bound.constraint, part.frames, part.q, among=among)
            out[rows] = value[0]
        return out

    def _dynamic(self, bound: Bound, at: Instants) -> Array:
        out = np.empty(len(at.times))
        for i, time in enumerate(at.times):
            one = Frames(at.frames.positions[i], at.frames.rotations[i])
            value, _ = self.evaluator.residual(
                bound.constraint, one, at.q[i], phase=bound.phase(time)
            )
            out[i] = float(value)
        return out

    def _morphs(self, bound: Bound, at: Instants) -> Iterator[tuple[Sequence[Constraint], slice]]:
        """Yield the skeletal morphs in force together with one, for they add, and when."""
        others = self.score.sharing[bound]
        parts = [self.inside(b, at.seconds, enforced=True) for b in others]
        cuts = sorted({0, len(at.times), *(i for p in parts for i in (p.start, p.stop))})
        for first, last in pairwise(cuts):
            forces = [
                b.constraint
                for b, part in zip(others, parts, strict=True)
                if part.start <= first and last <= part.stop
            ]
            yield [*dict.fromkeys([bound.constraint, *forces])], slice(first, last)


_SAME_S = 1e-9


def unit_of(constraint: Constraint) -> LengthOrAngle:
    """Return the unit in which a constraint's residual is measured."""
    return "m" if isinstance(constraint, Place | Transpath) else "rad"
