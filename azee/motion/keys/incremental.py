"""Incremental solving: new tasks are solved while the limbs of lasting tasks stay still.

A block that holds a posture holds it still. Another that begins meanwhile moves the limbs it needs
and leaves the rest where they are, so that a head shake moves the head alone. Where the new tasks
cannot be met so, all tasks are solved together.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.key_posture import KeyPosture, PostureSolver
from azee.motion.tasks.limbs import TRUNK, Limbs
from azee.motion.tasks.timed_task import TimedTask, limbs_moved
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]


def solve_incrementally(
    last: KeyPosture,
    tasks: Sequence[TimedTask],
    ik_tasks: Sequence[Task],
    current: Array,
    start: Array,
    reference: Array,
    *,
    limbs: Limbs,
    solver: PostureSolver,
) -> tuple[tuple[Task, ...], SolveReport] | None:
    """Return the IK tasks and an answer in which the limbs of lasting tasks have not moved.

    A head that no new task names stays as it is, if the new tasks can be met so.

    A lasting task that the last posture could not meet, and that no limb which moves now can help,
    is not solved again: it keeps the answer it had, and its IK task comes last.

    Args: tasks: all in force; ik_tasks: what they ask at this instant. current: (V,) where the
        body is. start, reference: (V,) for limbs that move.
    Returns: none if no task lasts or none is new, or if the new ones cannot be met so.
    """
    changed = limbs.touching(np.flatnonzero(current != last.coordinates).tolist())
    before = {t.constraint for t in last.ik_tasks}
    lasting = [
        t for t in tasks if t.constraint in before and not t.dynamic and not t.used_limbs & changed
    ]
    new = [t for t in tasks if t not in lasting]
    if not lasting or not new:
        return None
    unmet = {c.task.constraint: c for c in last.report.constraints if not c.met}
    for free in _choices_of_free_limbs(lasting, new):
        moving = np.array([name in free for name in limbs.names])[limbs.of_coordinate]
        if np.all(moving):
            continue
        infeasible = {t.constraint for t in lasting if t.constraint in unmet and not t.limbs & free}
        solved = [t for t in ik_tasks if t.constraint not in infeasible]
        left_out = [t for t in ik_tasks if t.constraint in infeasible]
        report = solver(
            solved,
            start=np.where(moving, start, current),
            reference=reference,
            fixed=frozenset(np.flatnonzero(~moving).tolist()),
        )
        if not report.missed:
            old_answers = [replace(unmet[t.constraint], task=t) for t in left_out]
            whole = replace(report, constraints=(*report.constraints, *old_answers))
            return (*solved, *left_out), whole
    return None


def _choices_of_free_limbs(
    lasting: Sequence[TimedTask], new: Sequence[TimedTask]
) -> list[frozenset[str]]:
    """Return the sets of limbs to try to move: without the head first, if no new task names it."""
    free = free_limbs(lasting, new)
    if "head" in free and not any(t.limb in ("head", "eyes") for t in new):
        return [free_limbs(lasting, new, stays=_trunk_in_use(lasting) | {"head"}), free]
    return [free]


def _trunk_in_use(lasting: Iterable[TimedTask]) -> frozenset[str]:
    """Return the trunk if a lasting task moves it: it carries both arms."""
    return frozenset((TRUNK,)) & limbs_moved(lasting)


def free_limbs(
    lasting: Iterable[TimedTask], new: Iterable[TimedTask], stays: frozenset[str] | None = None
) -> frozenset[str]:
    """Return the limbs that have to move for new tasks while others last.

    These are the limbs that new tasks move, and those of lasting tasks that move or read one of
    them, and so on.

    Args: stays: limbs that stay still. By default the trunk does, which carries both arms, if a
        lasting task moves it.
    """
    lasting = [*lasting]
    if stays is None:
        stays = _trunk_in_use(lasting)
    free = limbs_moved(new) - stays
    while True:
        wider = free | limbs_moved(t for t in lasting if free & t.used_limbs) - stays
        if wider == free:
            return free
        free = wider
