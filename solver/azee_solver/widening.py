"""How much of the body each problem may move: as little as will do."""

from __future__ import annotations

import math

import numpy as np

from azee_solver.anatomy import Part
from azee_solver.groups import Group
from azee_solver.moment import Moment
from azee_solver.problems import Problem, Reach
from azee_solver.solution import Solution

FINGER_M = 0.02
"""Deeper overlaps than a finger is thick are none that fingers get out of."""
JUMP_RAD = math.radians(1.5)
"""Along a movement, where a coordinate changes by more than this, more of the body may share it."""
IN_USE_RAD = math.radians(1.0)
"""A coordinate farther than this from the reference has been taken into use by an earlier step."""


def least_reach(moment: Moment) -> tuple[Reach, ...]:
    """Return what each problem may move first: along a movement, what the last step has moved."""
    return tuple(_least(moment, problem) for problem in moment.problems)


def _least(moment: Moment, problem: Problem) -> Reach:
    options, body = moment.options, moment.body
    if not options.inertia:
        return Reach.OWN
    trunk, head = body.anatomy.of(Part.TRUNK), body.anatomy.of(Part.HEAD)
    # Where the trunk may move the head moves too, to stay level.
    steps = [step | (head if step & trunk else frozenset()) for step in problem.steps]
    away = np.abs(moment.start - body.reference) > IN_USE_RAD / (1.0 + options.inertia)
    moved = frozenset(np.flatnonzero(away).tolist()) & steps[Reach.ALL]
    moved -= options.fixed | frozenset(body.presets)
    return next(r for r in Reach if moved <= steps[r] or r is Reach.ALL)


def widened(moment: Moment, solution: Solution) -> tuple[Reach, ...] | None:
    """Let problems of groups that miss move more, where that can help; none if nothing can."""
    options, anatomy = moment.options, moment.body.anatomy
    wider = list(solution.reach)
    for group, result in zip(solution.groups, solution.results, strict=True):
        unmet = result.unmet()
        in_the_way = result.overlap_m > options.overlap_m
        jumps = options.inertia > 0.0 and moment.jump(result.q) > JUMP_RAD
        if not unmet and not in_the_way and not jumps:
            continue
        affects = frozenset().union(*(moment.footprints[i].affected(anatomy) for i in unmet))
        for p in group.problems:
            steps = moment.problems[p].steps
            for r in Reach:
                gained = steps[r] - group.free - options.fixed
                linked = r is Reach.TRUNK > solution.reach[p] and _is_linked(moment, p, group)
                avoids = in_the_way and (r > Reach.FINGERS or result.overlap_m < FINGER_M)
                helps = gained & affects or (gained and (avoids or jumps))
                if r > solution.reach[p] and (helps or linked):
                    wider[p] = r
                    break
    return None if tuple(wider) == solution.reach else tuple(wider)


def _is_linked(moment: Moment, p: int, group: Group) -> bool:
    """Whether a problem depends on one that is not in its group."""
    return any(
        moment.problems[p].needs(other)
        for j, other in enumerate(moment.problems)
        if j not in group.problems
    )
