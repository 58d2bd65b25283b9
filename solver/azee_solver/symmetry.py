"""Symmetric tasks are met symmetrically.

Groups are solved one after the other, and a second arm that has to keep clear of the first may end
in quite another posture: finger tips that meet before the signer had one elbow at the body and one
19 cm farther out. If the mirror image of a posture meets all that is asked as well as the posture
itself, each half of it, with its own image, is where the groups are solved once more.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from azee_rig.mirror import mirrored
from azee_solver import kinematics
from azee_solver.anatomy import Part
from azee_solver.constraint import Morph, Transpath, Trill
from azee_solver.group_search import solve_group
from azee_solver.moment import Moment
from azee_solver.result import Result
from azee_solver.solution import Solution

Array = NDArray[np.float64]

ALIKE_RAD = 0.05
"""Arms whose coordinates differ by less from side to side are symmetric."""
ALIKE = 2.0
"""By how many tolerances more the mirror image may miss."""


def symmetric(moment: Moment, solution: Solution) -> Solution:
    """Return a symmetric solution of symmetric tasks, else the one given.

    Of the two halves that of less posture cost is taken, if it meets as much.
    """
    anatomy = moment.body.anatomy
    free = frozenset().union(*(group.free for group in solution.groups))
    if not free >= anatomy.of(Part.ARM):
        return solution
    if _arms_are_alike(moment, solution.q) or not _is_symmetric(moment, solution.q):
        return solution
    found = [_solved_from(moment, solution, half) for half in _halves(moment, solution.q)]
    better = [
        other
        for other in found
        if _arms_are_alike(moment, other.q) and _meets_as_much(moment, other, solution)
    ]
    return min(better, key=lambda s: _posture_cost(moment, s.q), default=solution)


def _arms_are_alike(moment: Moment, q: Array) -> bool:
    arms = sorted(moment.body.anatomy.of(Part.ARM))
    return bool(np.abs(mirrored(moment.body.rig.coordinates, q) - q)[arms].max() < ALIKE_RAD)


def _is_symmetric(moment: Moment, q: Array) -> bool:
    """Whether the mirror image of a posture meets all that is asked as well as the posture."""
    body = moment.body
    both = np.stack([q, mirrored(body.rig.coordinates, q)])
    frames = kinematics.frames(body.rig.chain, both)
    measure = body.evaluator
    for task in moment.tasks:
        constraint = task.constraint
        if isinstance(constraint, Transpath | Trill) or (
            isinstance(constraint, Morph) and not measure.binding.is_skeletal(constraint)
        ):
            continue
        off, _ = measure.residual(constraint, frames, both, task.phase, moment.constraints)
        if not off[1] <= off[0] + ALIKE * moment.options.tolerance.of(constraint):
            return False
    return True


def _halves(moment: Moment, q: Array) -> Iterator[Array]:
    """Yield the symmetric postures (V,) that have the left half of a posture, and the right."""
    bones = [name.partition(".")[0].split("_") for name in moment.body.rig.coordinates.names]
    left, right = (np.array([side in bone for bone in bones]) for side in "LR")
    image = mirrored(moment.body.rig.coordinates, q)
    middle = 0.5 * (q + image)
    yield np.where(left, q, np.where(right, image, middle))
    yield np.where(right, q, np.where(left, image, middle))


def _solved_from(moment: Moment, solution: Solution, start: Array) -> Solution:
    """Solve all groups from a posture (V,), as near to it as can be."""
    body = replace(moment.body, reference=start, evaluations=0)
    q, results = moment.reference.copy(), list[Result]()
    for n, group in enumerate(solution.groups):
        later = frozenset().union(*(g.free for g in solution.groups[n + 1 :]))
        before = solution.results[n]
        result = before
        if before.ratios:
            result = solve_group(
                body,
                moment.tasks_of(group),
                q,
                group.free,
                unsettled=later,
                factors=dict.fromkeys(before.given_up, 1.0),
                first=[start],
                only_first=True,
                further=False,
            )
        q = q.copy()
        q[sorted(group.free)] = result.q[sorted(group.free)]
        results.append(result)
    moment.body.evaluations += body.evaluations
    return replace(solution, q=q, results=tuple(results))


def _meets_as_much(moment: Moment, one: Solution, other: Solution) -> bool:
    """Whether a solution misses no more than another and lies no deeper in the body."""
    deepest = max(r.overlap_m for r in other.results)
    allowed_m = max(deepest, moment.options.overlap_m)
    return one.missed() <= other.missed() and all(r.overlap_m <= allowed_m for r in one.results)


def _posture_cost(moment: Moment, q: Array) -> float:
    stiffness = moment.body.rig.coordinates.stiffness
    return float(np.sum((stiffness * (q - moment.reference)) ** 2))
