"""The plan of a movement: its key postures and the curves through them, a step a line.

The numbers are those of the steps in docs/motion.md.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.avoidance import CollisionAvoidance
from azee.motion.curves.capsule_overlap import CapsuleOverlaps
from azee.motion.curves.movement import Interpolation, Movement
from azee.motion.keys.boundaries import Boundaries, NeededTime, solve_boundaries
from azee.motion.keys.in_between import InBetweenSolver
from azee.motion.keys.key_posture_solver import KeyPostureSolver
from azee.motion.keys.neutral import ReturnToNeutral
from azee.motion.keys.path_keys import PathKeys
from azee.motion.keys.residual_monitor import ResidualMonitor
from azee.motion.keys.transpath import (
    PathMotion,
    boundaries_on_paths,
    index_by_time,
    path_motions,
)
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.key_posture import KeyPosture, PostureSolver
from azee.motion.tasks.key_selection import KeySelection
from azee.motion.tasks.schedule import TaskSchedule
from azee_solver.evaluate import Evaluator

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """Key postures in order of time, the movement through them, and what measures it.

    monitor: measures its residuals.
    """

    postures: tuple[KeyPosture, ...]
    movement: Movement
    monitor: ResidualMonitor


def plan(
    schedule: TaskSchedule,
    evaluator: Evaluator,
    selection: KeySelection,
    solver: PostureSolver,
    frame_times: Sequence[Fraction],
    rest: Array,
    needed_s: NeededTime | None = None,
    solved: Boundaries | None = None,
) -> Plan:
    """Plan the movement that meets a schedule at the given frames inside the score.

    Args: rest: (V,) the posture in which limbs are that nothing needs. needed_s: what a block that
        ends early leaves for the way; a quick transition by default. solved: the boundaries, if
        they are solved already.
    """
    coordinates, limbs = evaluator.rig.coordinates, selection.limbs

    # 4. Find from which placement to which each path leads.
    motions = path_motions(schedule, evaluator.binding.dominant)
    deferred = boundaries_on_paths(motions, schedule)

    # 5. Solve a key posture at every boundary of blocks, in order of time; those on paths wait.
    neutral = ReturnToNeutral(schedule.posture_tasks, limbs, rest)
    key_solver = KeyPostureSolver(
        coordinates, selection, solver, index_by_time(motions), neutral, schedule.recorded
    )
    boundaries = solved or solve_boundaries(schedule, key_solver, evaluator, deferred, needed_s)

    # 6. Join the key postures to a movement, limb by limb, by minimum jerk.
    in_use = limbs_in_use(schedule, motions)
    interpolation = Interpolation(
        evaluator.rig, limbs, in_use, rest, not selection.flat, schedule.recorded
    )
    monitor = ResidualMonitor(evaluator, schedule, {}, boundaries.early_ends)
    in_between = InBetweenSolver(monitor, selection, solver, boundaries.unmet, boundaries.eased)
    keys = PathKeys(motions, [*boundaries.postures], in_between, interpolation, frame_times)
    joined = keys.join_boundaries()

    # 7. Measure where paths start and end, in key postures, else on the joined movement.
    keys.anchor_paths(joined)

    # 8. Solve the boundaries that lie on paths.
    keys.solve_deferred(deferred, joined)

    # 9. In flat mode add keys at even steps along paths and behind moving targets.
    if selection.flat:
        keys.sample_paths(joined)
        keys.sample_moving_targets()
    movement = keys.movement(joined)

    # 10. Lead the movement round the body where it would go through it.
    if not selection.flat:
        avoidance = CollisionAvoidance(evaluator, schedule, in_use, CapsuleOverlaps(evaluator))
        movement = avoidance.avoid_collisions(movement)

    return Plan(tuple(keys.postures), movement, keys.in_between.monitor)


def limbs_in_use(
    schedule: TaskSchedule, motions: Iterable[PathMotion]
) -> IntervalIndex[frozenset[str]]:
    """Return the limbs that tasks, paths and recordings use, by when they do."""
    used = [
        *((b.body, b.limbs) for b in schedule.recorded),
        *((t.interval, t.used_limbs) for t in schedule.posture_tasks),
        *((m.between, m.task.limbs) for m in motions),
    ]
    return IntervalIndex(dict.fromkeys(used))
