"""Runs all methods on all problems, measures every answer again and computes the figures."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from azee_rig.rig import Rig
from azee_solver.anatomy import anatomy
from azee_solver.collisions import Obstacles
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side
from benchmarks.ik.methods import Answer, Method
from benchmarks.ik.problems import LOOSE, TIGHT, Maker, Problem

TURN = 10
"""How many problems a method solves before the next method has its turn."""
WORST = 3
"""How many of the worst misses are kept."""


@dataclass(frozen=True, slots=True)
class Miss:
    """The worst residuals of one answer, metres and radians."""

    number: int
    length_m: float
    angle_rad: float

    def within(self, tolerance: tuple[float, float]) -> bool:
        """Whether all constraints are met."""
        return self.length_m <= tolerance[0] and self.angle_rad <= tolerance[1]

    @property
    def size(self) -> float:
        """The residual in units of our tolerances."""
        return max(self.length_m / TIGHT[0], self.angle_rad / TIGHT[1])


@dataclass(frozen=True, slots=True)
class Row:
    """The answers of a method to a class of problems.

    residuals: of every answer. overlaps_m: the overlap of its deepest pair of capsules beyond
        intended contacts; empty on a body without capsules. excess_rad: how far the worst
        coordinate leaves its limits; 0 for none. rounds: of the two-level method, per IK problem,
        all problems together.
    """

    body: str
    kind: str
    method: str
    seconds: tuple[float, ...]
    evaluations: tuple[int, ...]
    residuals: tuple[Miss, ...]
    overlaps_m: tuple[float, ...]
    excess_rad: float
    rounds: tuple[int, ...]

    @property
    def median_s(self) -> float:
        return float(np.median(self.seconds))

    @property
    def p95_s(self) -> float:
        return float(np.percentile(self.seconds, 95))

    def met(self, tolerance: tuple[float, float]) -> int:
        """Return how many problems were solved to a tolerance."""
        return sum(miss.within(tolerance) for miss in self.residuals)

    def as_json(self) -> dict[str, object]:
        worst = sorted(self.residuals, key=lambda miss: -miss.size)[:WORST]
        return {
            "body": self.body,
            "class": self.kind,
            "method": self.method,
            "problems": len(self.seconds),
            "median_s": self.median_s,
            "p95_s": self.p95_s,
            "median_evaluations": float(np.median(self.evaluations)),
            "met_1mm_05deg": self.met(TIGHT),
            "met_1cm_5deg": self.met(LOOSE),
            "deepest_overlap_m": max(self.overlaps_m, default=None),
            "median_overlap_m": float(np.median(self.overlaps_m)) if self.overlaps_m else None,
            "limit_excess_deg": math.degrees(self.excess_rad),
            "worst": [
                {
                    "problem": miss.number,
                    "length_m": miss.length_m,
                    "angle_deg": math.degrees(miss.angle_rad),
                }
                for miss in worst
            ],
            "rounds": list(self.rounds),
        }


def row(
    body: str, rig: Rig, method: str, problems: Sequence[Problem], answers: Sequence[Answer]
) -> Row:
    """Measure answers by forward kinematics that belongs to none of the methods."""
    evaluator = Evaluator(rig, Side.RIGHT)
    limits = rig.coordinates
    excess = max(float(np.max(np.maximum(limits.lower - a.q, a.q - limits.upper))) for a in answers)
    return Row(
        body,
        problems[0].kind,
        method,
        tuple(a.seconds for a in answers),
        tuple(a.evaluations for a in answers),
        tuple(_miss(evaluator, p, a) for p, a in zip(problems, answers, strict=True)),
        tuple(_overlap(evaluator, p, a) for p, a in zip(problems, answers, strict=True))
        if len(rig.capsules.pairs)
        else (),
        max(0.0, excess),
        tuple(count for a in answers for count in a.rounds),
    )


def _miss(evaluator: Evaluator, problem: Problem, answer: Answer) -> Miss:
    frames = evaluator.rig.chain.frames(answer.q)
    worst = {"m": 0.0, "rad": 0.0}
    for constraint in problem.constraints:
        residual, unit = evaluator.residual(constraint, frames, answer.q)
        worst[unit] = max(worst[unit], float(residual))
    return Miss(problem.number, worst["m"], worst["rad"])


def _overlap(evaluator: Evaluator, problem: Problem, answer: Answer) -> float:
    rig = evaluator.rig
    built = anatomy(rig.chain, rig.coordinates)
    found = Obstacles(evaluator.binding, built, problem.constraints).overlaps(answer.q)
    return max((overlap.depth_m for overlap in found), default=0.0)


def compared(
    body: str,
    rig: Rig,
    kinds: Sequence[str],
    count: int,
    methods: Mapping[str, Method],
    elsewhere: Mapping[str, Callable[[Rig, Sequence[Problem]], Sequence[Answer]]],
) -> Iterator[list[Row]]:
    """Yield the rows of one class after the other.

    Methods take turns every few problems, so that a slower processor affects all of them. Each
    warms up at the beginning of its turn.
    """
    maker = Maker(rig)
    for kind in kinds:
        problems = list(maker.problems(kind, count))
        answers: dict[str, list[Answer]] = {name: [] for name in methods}
        for first in range(0, count, TURN):
            for name, method in methods.items():
                method(rig, problems[first])
                answers[name] += [method(rig, p) for p in problems[first : first + TURN]]
        rows = [row(body, rig, name, problems, answers[name]) for name in methods]
        for name, solve in elsewhere.items():
            rows.append(row(body, rig, name, problems, solve(rig, problems)))
        yield rows


def behind_best(rows: Sequence[Row], clear_m: float = math.inf) -> dict[str, float]:
    """Return how far each method's worst answer is behind the best answer of any method, metres.

    This is for problems that cannot be solved, where the nearest posture is wanted.

    Args: clear_m: count only answers whose capsules overlap no deeper than this.
    """
    best = [
        min((m.length_m for m, clear in zip(misses, clears, strict=True) if clear), default=None)
        for misses, clears in zip(_by_problem(rows), _clear(rows, clear_m), strict=True)
    ]
    return {
        r.method: max(
            (
                mine.length_m - other
                for mine, other in zip(r.residuals, best, strict=True)
                if other is not None
            ),
            default=0.0,
        )
        for r in rows
    }


def of_solvable(rows: Sequence[Row], clear_m: float = math.inf) -> dict[str, tuple[int, int]]:
    """Return how many of the problems that any method solves each method solves, and of how many.

    Args: clear_m: count as solved only answers whose capsules overlap no deeper than this.
    """
    solvable = [
        any(miss.within(TIGHT) and clear for miss, clear in zip(misses, clears, strict=True))
        for misses, clears in zip(_by_problem(rows), _clear(rows, clear_m), strict=True)
    ]
    return {
        r.method: (
            sum(m.within(TIGHT) for m, can in zip(r.residuals, solvable, strict=True) if can),
            sum(solvable),
        )
        for r in rows
    }


def _by_problem(rows: Sequence[Row]) -> list[tuple[Miss, ...]]:
    return list(zip(*(r.residuals for r in rows), strict=True))


def _clear(rows: Sequence[Row], clear_m: float) -> list[tuple[bool, ...]]:
    """Return whether the capsules of each answer overlap no deeper than a bound."""
    clear = [
        [depth <= clear_m for depth in row.overlaps_m or [0.0] * len(row.seconds)] for row in rows
    ]
    return list(zip(*clear, strict=True))
