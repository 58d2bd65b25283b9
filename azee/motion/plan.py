"""All key postures of a score: boundaries first, then what lies on the way between them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from azee.motion.bound import Bound, BoundScore
from azee.motion.gauge import Gauge
from azee.motion.keyframes import solve_boundaries
from azee.motion.limbs import Limbs
from azee.motion.movement import Movement
from azee.motion.poser import Poser
from azee.motion.posture import KeyPosture, Origin, PostureSolver
from azee.motion.refine import CLOSEST_S, Refinement
from azee.motion.transpath import (
    Course,
    course,
    course_samples,
    deferred,
    ends,
    moving_samples,
    passing_limbs,
    travels,
)
from azee_solver.evaluate import Evaluator


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """Key postures in order of time, the movement through them, and what measures it."""

    postures: tuple[KeyPosture, ...]
    movement: Movement
    gauge: Gauge


def plan(
    score: BoundScore,
    evaluator: Evaluator,
    limbs: Limbs,
    solver: PostureSolver,
    frame_times: Sequence[Fraction],
) -> Plan:
    """Solve all key postures of a score, so that its constraints hold at the given frames."""
    known = travels(score.paths, score.postures, evaluator.binding.dominant)
    later = deferred(known, (k.time for k in score.timeline.keyframes))
    poser = Poser(evaluator.rig.coordinates, limbs, solver, known)
    first = solve_boundaries(score, poser, evaluator.binding, later)
    gauge = Gauge(evaluator, score.postures, {}, first.giving_way)
    work = _Work(Refinement(gauge, limbs, solver, known), list(first.postures))
    work.steer(later)
    work.sample(b for b in score.postures if b.dynamic)
    postures = work.refinement.added(work.postures, frame_times)
    return Plan(tuple(postures), work.refinement.join(postures), work.refinement.gauge)


@dataclass(slots=True, eq=False)
class _Work:
    """Key postures as they come together."""

    refinement: Refinement
    postures: list[KeyPosture]

    def steer(self, later: Iterable[Fraction]) -> None:
        """Put sites on their paths.

        A placement that ends one path may lie on another: it was solved without that other path,
        whose ends were not known then, and is solved once more before the rest.
        """
        if not self.refinement.travels:
            return
        base = self.refinement.join(self._unsteered())
        self._measure(base)
        again = {
            t
            for t in ends(self.refinement.travels)
            if any(k.steers(t) for k in self.refinement.travels)
        }
        if again:
            self.postures = [p for p in self.postures if p.time not in again]
            self._add(again, base, Origin.BOUNDARY)
            self._measure(base)
        self._add(later, base, Origin.BOUNDARY)
        evaluator = self.refinement.gauge.evaluator
        samples: set[Fraction] = set()
        for path in self.refinement.gauge.courses.values():
            q = base.sample(np.array([float(path.travel.start)]))[0]
            samples.update(course_samples(path, evaluator.rig.chain.frames(q), evaluator))
        self._add(self._apart(samples), base, Origin.PATH)

    def sample(self, dynamic: Iterable[Bound]) -> None:
        """Follow points that move."""
        base = self.refinement.join(self.postures)
        evaluator = self.refinement.gauge.evaluator
        samples: set[Fraction] = set()
        for b in dynamic:
            q = base.sample(np.array([float(b.requirement.motion.start)]))[0]
            samples.update(moving_samples(b, evaluator.rig.chain.frames(q), evaluator))
        self._add(self._apart(samples), base, Origin.PATH)

    def _unsteered(self) -> list[KeyPosture]:
        """Return key postures without what they say of limbs that should be on a path then."""
        out = []
        for p in self.postures:
            steered = (k.bound.limbs for k in self.refinement.travels if k.steers(p.time))
            out.append(replace(p, limbs=p.limbs.difference(*steered)))
        return out

    def _measure(self, base: Movement) -> None:
        evaluator = self.refinement.gauge.evaluator
        courses: dict[int, Course] = {
            k.bound.requirement.rank: course(k, self.postures, base, evaluator)
            for k in self.refinement.travels
        }
        self.refinement = replace(
            self.refinement, gauge=replace(self.refinement.gauge, courses=courses)
        )

    def _add(self, times: Iterable[Fraction], base: Movement, origin: Origin) -> None:
        for time in sorted(times):
            bounds = [b for b in self.refinement.gauge.postures if b.requirement.covers(time)]
            passing = None
            if origin is Origin.BOUNDARY:
                passing = passing_limbs(time, bounds, self.refinement.travels)
            self.postures.append(self.refinement.solve(time, base, origin, passing))
        self.postures.sort(key=lambda p: p.time)

    def _apart(self, samples: Iterable[Fraction]) -> list[Fraction]:
        """Return samples that are not too close to keys or to each other."""
        taken = [p.time for p in self.postures]
        out: list[Fraction] = []
        for time in sorted(samples):
            if all(abs(time - t) >= CLOSEST_S for t in (*taken, *out[-1:])):
                out.append(time)
        return out
