"""All key postures of a score: boundaries first, then what lies on the way between them."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from azee.motion.curves.avoidance import Clearing
from azee.motion.curves.capsule_overlap import Overlaps
from azee.motion.curves.movement import Movement
from azee.motion.keys.boundaries import active, solve_boundaries
from azee.motion.keys.neutral import Rest
from azee.motion.keys.posture_solver import Poser
from azee.motion.keys.refine import CLOSEST_S, Refinement, merged
from azee.motion.keys.residual_monitor import Gauge, Instants, instants
from azee.motion.keys.transpath import (
    Travel,
    by_time,
    course_samples,
    courses,
    deferred,
    ends,
    moving_samples,
    passing_limbs,
    travels,
)
from azee.motion.tasks.keying import Keying
from azee.motion.tasks.posture import KeyPosture, Origin, PostureSolver
from azee.motion.tasks.spans import Spans
from azee.motion.tasks.timed_task import Bound, BoundScore
from azee_solver.evaluate import Evaluator


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """Key postures in order of time, the movement through them, and what measures it.

    instants: the movement at the frames inside the score and at the keys. clearing: what keeps
    its ways clear of the body.
    """

    postures: tuple[KeyPosture, ...]
    movement: Movement
    gauge: Gauge
    instants: Instants
    clearing: Clearing


def plan(
    score: BoundScore,
    evaluator: Evaluator,
    keying: Keying,
    solver: PostureSolver,
    frame_times: Sequence[Fraction],
) -> Plan:
    """Solve all key postures of a score, so that its constraints hold at the given frames."""
    known = travels(score, evaluator.binding.dominant)
    ways = by_time(known)
    later = deferred(known, (k.time for k in score.timeline.keyframes))
    coordinates = evaluator.rig.coordinates
    rest = Rest(score.postures, keying.limbs, coordinates.idle)
    poser = Poser(coordinates, keying, solver, ways, rest)
    first = solve_boundaries(score, poser, evaluator.binding, later)
    needed = [
        *((b.requirement.interval, b.limbs | b.read_limbs) for b in score.postures),
        *((k.between, k.bound.limbs) for k in known),
    ]
    holders: Spans[frozenset[str]] = Spans(dict.fromkeys(needed))
    gauge = Gauge(evaluator, score, {}, first.giving_way)
    hopeless = frozenset(
        c.task.constraint for p in first.postures for c in p.report.constraints if not c.met
    )
    refinement = Refinement(gauge, keying, solver, holders, hopeless)
    work = _Work(refinement, known, ways, list(first.postures), frame_times)
    work.steer(later)
    work.follow([b for b in score.postures if b.dynamic])
    done = work.refinement.refined(work.postures, frame_times)
    clearing = Clearing(evaluator, score, holders, Overlaps(evaluator))
    clear, at = done.movement, done.instants
    if not keying.flat:
        clear = clearing.cleared(clear)
        at = instants(clear, at.times, evaluator)
    return Plan(done.postures, clear, work.refinement.gauge, at, clearing)


@dataclass(slots=True, eq=False)
class _Work:
    """Key postures as they come together."""

    refinement: Refinement
    travels: tuple[Travel, ...]
    travels_at: Spans[Travel]
    postures: list[KeyPosture]
    frame_times: Sequence[Fraction]

    def steer(self, later: Iterable[Fraction]) -> None:
        """Put sites on their paths.

        A placement that ends one path may lie on another: it was solved without that other path,
        whose ends were not known then, and is solved once more before the rest.
        """
        if not self.travels:
            return
        base = self.refinement.join(self._unsteered())
        self._measure(base)
        again = {t for t in ends(self.travels) if self._steering(t)}
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
        self._add(self._on_frames(samples), base, Origin.PATH)

    def follow(self, dynamic: Sequence[Bound]) -> None:
        """Follow points that move."""
        if not dynamic:
            return
        base = self.refinement.join(self.postures)
        evaluator = self.refinement.gauge.evaluator
        samples: set[Fraction] = set()
        for b in dynamic:
            q = base.sample(np.array([float(b.requirement.motion.start)]))[0]
            samples.update(moving_samples(b, evaluator.rig.chain.frames(q), evaluator))
        self._add(self._on_frames(samples), base, Origin.PATH)

    def _steering(self, time: Fraction) -> list[Travel]:
        return [k for k in self.travels_at.at(time) if k.steers(time)]

    def _unsteered(self) -> list[KeyPosture]:
        """Return key postures without what they say of limbs that should be on a path then."""
        out = []
        for p in self.postures:
            steered = (k.bound.limbs for k in self._steering(p.time))
            out.append(replace(p, limbs=p.limbs.difference(*steered)))
        return out

    def _measure(self, base: Movement) -> None:
        found = courses(self.travels, self.postures, base, self.refinement.gauge.evaluator)
        gauge = replace(self.refinement.gauge, courses=found)
        self.refinement = replace(self.refinement, gauge=gauge)

    def _add(self, times: Iterable[Fraction], base: Movement, origin: Origin) -> None:
        gauge = self.refinement.gauge
        ordered = sorted(times)
        passing = None
        if origin is Origin.BOUNDARY:
            passing = [
                passing_limbs(t, active(gauge.score, t, gauge.giving_way), self.travels_at.at(t))
                for t in ordered
            ]
        self.postures = merged(self.postures, self.refinement.solve(ordered, base, origin, passing))

    def _on_frames(self, samples: Iterable[Fraction]) -> list[Fraction]:
        """Return the frames next to samples, but for those that are as good as keys already.

        On the frames, samples are never so close to one that it cannot be corrected.
        """
        taken = [p.time for p in self.postures]
        nearest = {nearest_in(self.frame_times, time) for time in samples}
        return [t for t in sorted(nearest) if abs(t - nearest_in(taken, t)) >= CLOSEST_S]


def nearest_in(ordered: Sequence[Fraction], time: Fraction) -> Fraction:
    """Return the instant of an increasing sequence, not empty, that is nearest to another."""
    i = bisect_left(ordered, time)
    return min(ordered[max(0, i - 1) : i + 1], key=lambda t: abs(t - time))
