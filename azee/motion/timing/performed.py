"""A score as a body performs it: bent where a way is too short a time for its length."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce
from typing import Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.movement import Interpolation
from azee.motion.keys.boundaries import Boundaries, solve_boundaries
from azee.motion.keys.key_posture_solver import KeyPostureSolver
from azee.motion.keys.neutral import ReturnToNeutral
from azee.motion.keys.plan import limbs_in_use
from azee.motion.keys.transpath import anchor, boundaries_on_paths, index_by_time, path_motions
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.key_posture import PostureSolver
from azee.motion.tasks.key_selection import KeySelection
from azee.motion.tasks.schedule import TaskSchedule, bind
from azee.motion.timing.accents import is_accent
from azee.motion.timing.bend import Bend, bend_for
from azee.motion.timing.pace import Pace
from azee.motion.timing.way import Way
from azee.motion.timing.ways import Ways
from azee.score.interval import Interval
from azee.score.score import Score
from azee.score.stretch import fixed_intervals, warped
from azee_solver.evaluate import Evaluator

Array = NDArray[np.float64]

Timing = Literal["performed", "exact"]
TIMINGS: tuple[Timing, ...] = get_args(Timing)

ROUNDS = 4
"""Bending changes what ends early and what returns to neutral: ways are measured again."""
SLACK, SLACK_S = Fraction(102, 100), Fraction(2, 1000)
"""A way may lack this share of its time, and this much."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """A transition that takes longer than its score says, and the way that needs it.

    way: as it was when it was first found too short. start_s, end_s: on the time line of the score
    as performed. score_s: how long it takes by the score.
    """

    way: Way
    start_s: Fraction
    end_s: Fraction
    score_s: Fraction

    @property
    def performed_s(self) -> Fraction:
        """How long it takes as performed."""
        return self.end_s - self.start_s

    def as_json(self) -> dict[str, object]:
        """Return it as the report's JSON has it."""
        way = self.way
        return {
            "from": [*way.source],
            "to": [*way.target],
            "start_s": float(self.start_s),
            "end_s": float(self.end_s),
            "score_s": float(self.score_s),
            "performed_s": float(self.performed_s),
            "hand": {"L": "left", "R": "right"}[way.side],
            "way_m": way.way_m,
            "turn_rad": way.turn_rad,
        }


@dataclass(frozen=True, slots=True)
class Performance:
    """A score as performed, what of it takes longer, and by how much the whole does.

    schedule, boundaries: of the score as performed, if the last round has solved it.
    """

    score: Score
    stretched: tuple[Stretch, ...] = ()
    extra_s: Fraction = Fraction(0)
    schedule: TaskSchedule | None = None
    boundaries: Boundaries | None = None


@dataclass(slots=True)
class _Bends:
    """The bends of all rounds, and the ways that asked for them, on the score's own time line."""

    bends: list[Bend] = field(default_factory=list)
    asked: list[tuple[Way, Interval]] = field(default_factory=list)

    def add(self, bend: Bend, ways: Iterable[Way]) -> None:
        """Add the next round; ways between the same blocks at one time are one transition."""
        for way in ways:
            own = Interval(self._before(way.interval.start), self._before(way.interval.end))
            for i, (known, span) in enumerate(self.asked):
                at_once = span.start < own.end and own.start < span.end
                if at_once and (known.source, known.target) == (way.source, way.target):
                    whole = Interval(min(span.start, own.start), max(span.end, own.end))
                    self.asked[i] = max(known, way, key=lambda w: w.lacks), whole
                    break
            else:
                self.asked.append((way, own))
        self.bends.append(bend)

    def performance(
        self,
        now: Score,
        before: Score,
        schedule: TaskSchedule | None = None,
        boundaries: Boundaries | None = None,
    ) -> Performance:
        """Return what has become of a score."""
        extra_s = now.duration - before.duration
        return Performance(now, self.stretches(), extra_s, schedule, boundaries)

    def stretches(self) -> tuple[Stretch, ...]:
        """Return what takes longer in the end, in order of time."""
        out = []
        for way, old in self.asked:
            start, end = self._after(old.start), self._after(old.end)
            if end - start > old.duration:
                out.append(Stretch(way, start, end, old.duration))
        return tuple(sorted(out, key=lambda s: (s.start_s, s.end_s, s.way.side)))

    def _after(self, time: Fraction) -> Fraction:
        return reduce(lambda t, bend: bend(t), self.bends, time)

    def _before(self, time: Fraction) -> Fraction:
        return reduce(lambda t, bend: bend.inverse(t), reversed(self.bends), time)


def performed(
    score: Score,
    evaluator: Evaluator,
    selection: KeySelection,
    solver: PostureSolver,
    pace: Pace,
    rest: Array,
) -> Performance:
    """Bend the time of a score until no way of an arm is too short for its length.

    AZee does not say how transitions are performed, and a score's offsets were read off signs of
    other lengths. Each round solves the key postures at the boundaries, finds the ways that need
    longer than they have and stretches the score there. What is around them moves: nesting, order
    and coincidences stay. Fixed parts keep their length, and accents their own clock.

    Args: solver: should remember its answers, since most postures are asked for in every round.
        rest: (V,) the posture in which limbs are that nothing needs.
    """
    bends, now = _Bends(), score
    tried: set[_Identity] = set()
    for _ in range(ROUNDS):
        schedule, boundaries, ways = _solved(now, evaluator, selection, solver, pace, rest)
        lacking = [w for w in ways if _lacks_time(w)]
        bendable = [w for w in lacking if _identity(w) not in tried]
        bend = bend_for(bendable, fixed_intervals(now))
        if not bend.extra_s:
            return bends.performance(now, score, schedule, boundaries)
        tried.update(_identity(w) for w in bendable)
        bends.add(bend, bendable)
        now = warped(now, bend, lambda s: is_accent(s, evaluator.binding))
    return bends.performance(now, score)


def _lacks_time(way: Way) -> bool:
    has_s = way.interval.duration
    return way.needed_s > max(SLACK * has_s, SLACK_S + has_s)


_Identity: TypeAlias = tuple[str, tuple[str, ...], tuple[str, ...], Fraction]


def _identity(way: Way) -> _Identity:
    """Return what tells ways apart. One that a bend has not changed is not tried again.

    Such a way lies between boundaries of an accent, which keeps its clock.
    """
    return way.side, way.source, way.target, way.interval.duration


def _solved(
    score: Score,
    evaluator: Evaluator,
    selection: KeySelection,
    solver: PostureSolver,
    pace: Pace,
    rest: Array,
) -> tuple[TaskSchedule, Boundaries, list[Way]]:
    """Solve a score's key postures at boundaries; return all ways of arms between them, too."""
    coordinates, limbs = evaluator.rig.coordinates, selection.limbs
    schedule = bind(
        flatten(score), evaluator.rig, evaluator.binding, limbs, layered=not selection.flat
    )
    measure = Ways(evaluator, limbs.members, pace)
    motions = path_motions(schedule, evaluator.binding.dominant)
    deferred = boundaries_on_paths(motions, schedule)
    neutral = ReturnToNeutral(schedule.posture_tasks, limbs, rest)
    key_solver = KeyPostureSolver(
        coordinates, selection, solver, index_by_time(motions), neutral, schedule.recorded
    )
    boundaries = solve_boundaries(schedule, key_solver, evaluator, deferred, measure.needed_s)
    postures = boundaries.postures
    in_use = limbs_in_use(schedule, motions)
    interpolation = Interpolation(
        evaluator.rig, limbs, in_use, rest, not selection.flat, schedule.recorded
    )
    movement = interpolation.through(postures)
    paths = anchor(motions, postures, movement, evaluator)
    ways = [
        *measure.between_keys(postures, movement, motions),
        *measure.along_paths(paths.values(), movement),
        *measure.behind_targets(schedule, movement),
    ]
    return schedule, boundaries, ways
