"""How much of the body each problem may move: as little as will do."""

from __future__ import annotations

import math

import numpy as np

from azee_solver.moment import Moment
from azee_solver.problems import Problem, Reach
from azee_solver.relaxed import DEEP_M
from azee_solver.solution import Solution

JUMP_RAD = math.radians(1.5)
"""Along a movement, a coordinate that changes by more from one step to the next jumps. More of the
body should then share the change."""


def least_reach(moment: Moment) -> tuple[Reach, ...]:
    """Return what each problem may move first.

    That is the part that its constraints name. Along a movement it is also what an earlier step has
    moved away from the reference, or the body would jump back (15 jumps of up to 5.9° in
    `benchmarks.continuity`; ADR 29).
    """
    return tuple(_least(moment, problem) for problem in moment.problems)


def _least(moment: Moment, problem: Problem) -> Reach:
    options, body = moment.options, moment.body
    if not options.inertia:
        return Reach.OWN
    moved = frozenset(np.flatnonzero(moment.start != body.reference).tolist())
    exact = frozenset(body.presets) - frozenset(body.yielding)
    moved &= problem.steps[Reach.ALL] - options.fixed - exact
    return next(r for r in Reach if moved <= problem.steps[r] or r is Reach.ALL)


def widened(moment: Moment, solution: Solution) -> tuple[Reach, ...] | None:
    """Let problems of groups that miss move more, where that can help; none if nothing can.

    Each such problem gets the least further reach that helps. More coordinates help a missed
    constraint if they change its residual. They help against an overlap too; fingers alone do so
    only if the overlap is no deeper than they are thick. Along a movement, more of the
    body may share what would else be a jump: that halves the jumps of `benchmarks.continuity`.
    """
    options, anatomy = moment.options, moment.body.anatomy
    wider = list(solution.reach)
    for group, result in zip(solution.groups, solution.results, strict=True):
        overlaps = result.overlap_m > options.overlap_m
        jumps = options.inertia > 0.0 and moment.jump(result.q) > JUMP_RAD
        affects = frozenset().union(
            *(moment.footprints[i].affected(anatomy) for i in result.unmet())
        )
        for p in group.problems:
            steps = moment.problems[p].steps
            for r in Reach:
                gained = steps[r] - group.free - options.fixed
                avoids = overlaps and (r > Reach.FINGERS or result.overlap_m < DEEP_M)
                if r > solution.reach[p] and gained and (avoids or jumps or gained & affects):
                    wider[p] = r
                    break
    return None if tuple(wider) == solution.reach else tuple(wider)
