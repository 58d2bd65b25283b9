"""Measuring how far a movement is from what the score requires, frame by frame."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee.motion.bound import Bound
from azee.motion.keyframes import GivingWay
from azee.motion.movement import Movement
from azee.motion.transpath import Course
from azee_rig.chain import Frames
from azee_solver.constraint import Constraint, Morph, Place, Transpath
from azee_solver.evaluate import Evaluator, LengthOrAngle

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

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

    def only(self, indices: Indices) -> Instants:
        """Return some of the instants."""
        if len(indices) == len(self.times):
            return self
        return Instants(
            tuple(self.times[i] for i in indices),
            self.q[indices],
            Frames(self.frames.positions[indices], self.frames.rotations[indices]),
        )


def instants(movement: Movement, times: Iterable[Fraction], evaluator: Evaluator) -> Instants:
    """Sample a movement, with forward kinematics of all instants at once."""
    exact = tuple(times)
    q = movement.sample(np.array([float(t) for t in exact]))
    return Instants(exact, q, evaluator.rig.chain.frames(q))


@dataclass(frozen=True, slots=True, eq=False)
class Gauge:
    """What measures one score on one rig.

    postures: the requirements that the solver meets. courses: by rank of their transpath.
    """

    evaluator: Evaluator
    postures: tuple[Bound, ...]
    courses: dict[int, Course]
    giving_way: dict[int, GivingWay]

    def tolerance(self, bound: Bound) -> float:
        """Largest residual that counts as met, metres or radians."""
        if bound.requirement.rank in self.courses:
            return PATH_TOLERANCE_M
        unit = self.unit(bound)
        return PATH_TOLERANCE_M if bound.dynamic and unit == "m" else TOLERANCE[unit]

    def unit(self, bound: Bound) -> LengthOrAngle:
        """Return the unit of a requirement's residual."""
        return unit_of(bound.constraint)

    def inside(self, bound: Bound, seconds: Array, *, enforced: bool = False) -> Indices:
        """Return indices of instants inside a block, both ends included.

        Args: enforced: stop where the block gives way to another.
        """
        r = bound.requirement
        first, last = float(r.interval.start), float(r.interval.end)
        if r.rank in self.courses:
            travel = self.courses[r.rank].travel
            first, last = float(travel.start), float(travel.end)
        given = self.giving_way.get(r.rank)
        if given is not None:
            if enforced:
                last = float(given.start)
            else:  # the end itself is the other block's
                return np.flatnonzero((seconds >= first - _SAME_S) & (seconds < last - _SAME_S))
        return np.flatnonzero((seconds >= first - _SAME_S) & (seconds <= last + _SAME_S))

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
        for among, indices in self._morphs(bound, at):
            part = at.only(indices)
            out[indices] = self.evaluator.residual(
                bound.constraint, part.frames, part.q, among=among
            )[0]
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

    def _morphs(self, bound: Bound, at: Instants) -> Iterable[tuple[Sequence[Constraint], Indices]]:
        """Yield the skeletal morphs in force together with one, for they add, and when."""
        others = [
            b for b in self.postures if isinstance(b.constraint, Morph) and b.moves & bound.moves
        ]
        rows = [
            np.isin(np.arange(len(at.times)), self.inside(b, at.seconds, enforced=True))
            for b in others
        ]
        together = np.stack(rows)
        for pattern in np.unique(together, axis=1).T:
            indices = np.flatnonzero(np.all(together == pattern[:, None], axis=0))
            forces = [b.constraint for b, on in zip(others, pattern, strict=True) if on]
            yield [*dict.fromkeys([bound.constraint, *forces])], indices


_SAME_S = 1e-9


def unit_of(constraint: Constraint) -> LengthOrAngle:
    """Return the unit in which a constraint's residual is measured."""
    return "m" if isinstance(constraint, Place | Transpath) else "rad"
