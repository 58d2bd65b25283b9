"""Which of several solutions of a moment to take."""

from __future__ import annotations

from collections.abc import Iterable

from azee_solver.constraint import Place
from azee_solver.moment import Moment
from azee_solver.solution import Solution

CLEARLY = 0.7
"""Moving more of the body is worth it for misses below this part of the others."""


def best_of(moment: Moment, solutions: Iterable[Solution]) -> Solution:
    """Return the best of several solutions, those that move least of the body first."""
    best, *others = solutions
    for other in others:
        if _is_better(moment, other, best):
            best = other
    return best


def _is_better(moment: Moment, one: Solution, other: Solution) -> bool:
    """Whether a solution is worth moving more of the body than another does.

    By the number of misses, then by missed places, then by all misses, then by overlap.
    """
    a, b = _misses(one), _misses(other)
    if len(a) != len(b):
        return len(a) < len(b)
    places = [
        sum(r for i, r in misses.items() if isinstance(moment.constraints[i], Place))
        for misses in (a, b)
    ]
    if abs(places[0] - places[1]) > 1.0:
        return places[0] < places[1]
    ratio = sum(a.values()) / sum(b.values()) if b else 1.0
    if not CLEARLY < ratio < 1 / CLEARLY:
        return ratio < 1
    depth = [max(r.overlap_m for r in s.results) for s in (one, other)]
    return depth[0] < depth[1] - moment.options.overlap_m


def fewest_able(narrower: Iterable[Solution], widest: Solution) -> list[Solution]:
    """Return those of narrower solutions that can miss as few tasks as the widest one does.

    Giving up tasks leaves at least one missed in every group that misses now.
    """
    fewest = len(_misses(widest))
    return [s for s in narrower if sum(bool(r.missed()) for r in s.results) <= fewest]


def _misses(solution: Solution) -> dict[int, float]:
    """Tasks that are missed though they are defined, in tolerances."""
    return {i: r.ratios[i] for r in solution.results for i in r.missed() - r.undefined}
