"""Key postures of a score before it is performed, for what has to be known of them first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee.motion.keys.boundaries import solve_boundaries
from azee.motion.keys.key_posture_solver import KeyPostureSolver
from azee.motion.keys.neutral import ReturnToNeutral
from azee.motion.keys.transpath import boundaries_on_paths, index_by_time, path_motions
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.key_posture import KeyPosture, PostureSolver
from azee.motion.tasks.key_selection import KeySelection
from azee.motion.tasks.schedule import bind
from azee.score.score import Score
from azee_solver.evaluate import Evaluator

Array = NDArray[np.float64]


def first_postures(
    score: Score, evaluator: Evaluator, selection: KeySelection, solver: PostureSolver, rest: Array
) -> tuple[KeyPosture, ...]:
    """Solve the key postures at the boundaries of a score.

    Args: rest: (V,) the posture of a body that nothing has moved yet.
    """
    rig, binding, limbs = evaluator.rig, evaluator.binding, selection.limbs
    schedule = bind(flatten(score), rig, binding, limbs, layered=not selection.flat)
    motions = path_motions(schedule, binding.dominant)
    deferred = boundaries_on_paths(motions, schedule)
    neutral = ReturnToNeutral(schedule.posture_tasks, limbs, rest)
    keys = KeyPostureSolver(
        rig.coordinates, selection, solver, index_by_time(motions), neutral, schedule.recorded
    )
    return solve_boundaries(schedule, keys, evaluator, deferred).postures
