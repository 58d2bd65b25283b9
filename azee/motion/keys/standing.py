"""Solving what is new at an instant beside what goes on standing.

A block that holds a posture holds it still: another that begins meanwhile moves what it needs and
leaves the rest where it is, so that a head shake moves the head alone. Where that does not do, all
is solved together.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.limbs import TRUNK, Limbs
from azee.motion.tasks.posture import KeyPosture, PostureSolver
from azee.motion.tasks.timed_task import Bound
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]


def solve_beside(
    last: KeyPosture,
    bounds: Sequence[Bound],
    tasks: Sequence[Task],
    current: Array,
    start: Array,
    reference: Array,
    *,
    limbs: Limbs,
    solver: PostureSolver,
) -> tuple[tuple[Task, ...], SolveReport] | None:
    """Return the tasks and an answer in which the limbs of lasting blocks have not moved.

    A head that none of the new ones speaks of keeps its own way if they can be met so.

    What the last posture could not meet, and no limb that moves now could help, is not asked
    again: it keeps the answer it had. Its tasks come last.

    Args: current: (V,) where the body is. start, reference: (V,) for limbs that move.
    Returns: none if there is nothing that stands, or if what is new cannot be met beside it.
    """
    changed = limbs.touching(np.flatnonzero(current != last.coordinates).tolist())
    before = {d.constraint for d in last.tasks}
    kept = [
        b
        for b in bounds
        if b.constraint in before and not b.dynamic and not (b.limbs | b.read_limbs) & changed
    ]
    new = [b for b in bounds if b not in kept]
    if not kept or not new:
        return None
    frees = [free_limbs(kept, new)]
    if "head" in frees[0] and not any(b.limb in ("head", "eyes") for b in new):
        frees.insert(0, free_limbs(kept, new, stays=_claimed(kept) | {"head"}))
    for free in frees:
        moving = np.array([name in free for name in limbs.names])[limbs.of_coordinate]
        if np.all(moving):
            continue
        missed = {c.task.constraint: c for c in last.report.constraints if not c.met}
        hopeless = {b.constraint for b in kept if b.constraint in missed and not b.limbs & free}
        asked = [d for d in tasks if d.constraint not in hopeless]
        left = [d for d in tasks if d.constraint in hopeless]
        report = solver(
            asked,
            start=np.where(moving, start, current),
            reference=reference,
            fixed=frozenset(np.flatnonzero(~moving).tolist()),
        )
        if report.met:
            unanswered = [replace(missed[d.constraint], task=d) for d in left]
            whole = replace(report, constraints=(*report.constraints, *unanswered))
            return (*asked, *left), whole
    return None


def _claimed(kept: Iterable[Bound]) -> frozenset[str]:
    """Return the trunk if a block that goes on has it: it carries both arms."""
    return frozenset((TRUNK,)) if any(TRUNK in b.limbs for b in kept) else frozenset()


def free_limbs(
    kept: Iterable[Bound], new: Iterable[Bound], stays: frozenset[str] | None = None
) -> frozenset[str]:
    """Return the limbs that must move for new requirements while others are kept.

    Those that the new ones speak of, and those of kept ones that share them or follow them.

    Args: stays: limbs that keep still; by default the trunk, which carries both arms, stays with
        the block that had it first.
    """
    kept = [*kept]
    if stays is None:
        stays = _claimed(kept)
    free = frozenset[str]().union(*(b.limbs for b in new)) - stays
    while True:
        drawn = [b.limbs for b in kept if free & (b.limbs | b.read_limbs)]
        wider = free.union(*drawn) - stays
        if wider == free:
            return free
        free = wider
