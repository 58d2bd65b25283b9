"""From a score to a clip with its report, a step a line.

The numbers are those of the steps in docs/motion.md.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.motion.curves.movement import Movement
from azee.motion.keys.plan import plan
from azee.motion.overlay.face import RAMP_S, face_weights
from azee.motion.overlay.idle import AFTER_S, BEFORE_S, BLINK, blinks, breathing, swaying
from azee.motion.overlay.labels import labels
from azee.motion.overlay.trill import add_trills, oscillation
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.key_posture import PostureSolver, Search
from azee.motion.tasks.key_selection import MODES, KeySelection, Mode
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.schedule import TaskSchedule, bind
from azee.motion.tasks.tracks import Track, tracks
from azee.quality.likeness import likeness
from azee.quality.measures import PenetrationSearch, block_times, peaks
from azee.quality.motion_report import MotionReport, constraint_results, limit_excess
from azee.quality.task_spans import task_spans
from azee.score.score import Score
from azee_rig.rig import Rig
from azee_solver.evaluate import Evaluator
from azee_solver.evaluate import evaluator as evaluator_of
from azee_solver.geometry import Side
from azee_solver.options import SolveOptions
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Animation:
    """A clip with its report.

    key_times: of all key postures, on the clip's time line. lead_s: when the score's time line
    starts in the clip; before, the signer stands in the neutral posture and moves into the first
    key posture. tracks: which block keys what, on the score's time line.
    """

    clip: Clip
    report: MotionReport
    key_times: tuple[float, ...]
    lead_s: float
    tracks: tuple[Track, ...] = ()


def animate(
    score: Score,
    rig: Rig,
    *,
    fps: float = 30.0,
    dominant: Side = Side.RIGHT,
    mode: Mode = "tracks",
    seed: int = 0,
    life: bool = True,
    precise: bool = False,
    solver: PostureSolver | None = None,
) -> Animation:
    """Make a body play a score.

    Args: fps: frames per second, positive. mode: which limbs key postures key. seed: of the
        blinks, breaths and sway. life: whether to add these. precise: whether to meet
        constraints at any price of comfort. solver: what solves key postures; `azee_solver.solve`
        if none is given.
    What names a bone, site or morph that the rig lacks is left out.

    Raises: ValueError: an unknown mode or a frame rate that is none.
    """
    if mode not in MODES:
        raise ValueError(f"there is no mode '{mode}'; the modes are: {', '.join(MODES)}")
    if not (math.isfinite(fps) and fps > 0):
        raise ValueError(f"{fps} frames per second make no clip")
    evaluator = evaluator_of(rig, dominant)
    selection = KeySelection(Limbs.of(rig.coordinates), mode)
    rate = Fraction(fps)

    # 1. Project the nested score on one time line.
    timeline = flatten(score)

    # 2. Bind every constraint to the body: a timed task says which limbs it moves and reads.
    schedule = bind(timeline, rig, evaluator.binding, selection.limbs)

    # 3 to 10. Solve key postures and join them to a movement.
    frames_inside = [n / rate for n in range(math.floor(score.duration * rate) + 1)]
    planned = plan(
        schedule,
        evaluator,
        selection,
        solver or _default_solver(rig, dominant, precise),
        frames_inside,
    )

    # 11. Sample the movement at the clip's frames, and add trills, face, idle motion and lids.
    times, lead_s = _frame_times(score.duration, planned.movement, schedule, rate)
    q = planned.movement.sample(times)
    q, trill_shortfalls = _with_trills(q, times, schedule, planned.movement, evaluator)
    weights = face_weights(
        schedule.facial_morphs, rig.face_morphs, tuple(rig.units), dominant, times
    )
    if life:
        q, weights = _with_idle_motion(q, weights, times, schedule, rig, seed)
    weights = _with_lids(weights, q, rig)

    # 12. Make the clip, measure it and report.
    clip = _clip(score, rig, times, q, weights, lead_s)
    excess, joint = limit_excess(q, rig.coordinates)
    report = MotionReport(
        rig=rig.name,
        fps=float(fps),
        mode=mode,
        duration_s=float(clip.times[-1]),
        lead_s=lead_s,
        score_s=float(score.duration),
        constraints=constraint_results(schedule, planned, trill_shortfalls, float(fps)),
        max_excess_rad=excess,
        excess_joint=joint,
        postures=planned.postures,
        blocks=tuple(block_times(schedule.all, planned.monitor.early_ends)),
        peaks=peaks(q, float(fps), rig.coordinates.names, lead_s),
        measure_penetration=PenetrationSearch(rig, dominant, schedule, clip.coordinates, times),
        measure_likeness=partial(
            likeness,
            clip,
            rig,
            score,
            task_spans(schedule.all, planned.monitor.early_ends),
            zero_s=lead_s,
            dominant=dominant,
        ),
    )
    key_times = tuple(float(p.time) + lead_s for p in planned.postures)
    by_block = tracks(schedule, planned.postures, selection, rig.coordinates)
    return Animation(clip, report, key_times, lead_s, by_block)


def _default_solver(rig: Rig, dominant: Side, precise: bool) -> PostureSolver:
    def answer(
        ik_tasks: Sequence[Task],
        *,
        start: Array,
        reference: Array,
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        options = SolveOptions(precise=precise, fixed=fixed)
        if search is Search.LOCAL:
            options = replace(options, far=False, patience=0)
        return solve(
            rig, ik_tasks, dominant=dominant, start=start, reference=reference, options=options
        )

    return answer


def _frame_times(
    score_s: Fraction, movement: Movement, schedule: TaskSchedule, rate: Fraction
) -> tuple[Array, float]:
    """Return all frames on the score's time line, (T,) seconds, and the lead before its zero.

    The lead is a whole number of frames, so that the score starts on one.
    """
    first, last = min(0.0, movement.start_s), max(float(score_s), movement.end_s)
    if schedule.facial_morphs:
        last = max(last, float(score_s) + RAMP_S)
    before = math.ceil((BEFORE_S - first) * rate)
    after = math.ceil((last + AFTER_S) * rate)
    return np.array([float(n / rate) for n in range(-before, after + 1)]), float(before / rate)


def _with_trills(
    q: Array, times: Array, schedule: TaskSchedule, movement: Movement, evaluator: Evaluator
) -> tuple[Array, dict[int, float]]:
    """Add trills to coordinates (T, V); return also by how much they fall short, by rank.

    A trill turns the bone as its joints can in the posture in the middle of its block.
    """
    trills = []
    for task in schedule.trills:
        middle = float(task.interval.start + task.interval.end) / 2
        posture = np.asarray(movement.sample(np.array([middle]))[0])
        trills.append(oscillation(task, posture, evaluator))
    return add_trills(q, times, trills, evaluator.rig.coordinates)


def _with_idle_motion(
    q: Array, weights: Array, times: Array, schedule: TaskSchedule, rig: Rig, seed: int
) -> tuple[Array, Array]:
    """Add breathing, blinks and sway to coordinates (T, V) and face weights, inside the limits."""
    rng = np.random.default_rng(seed)
    coordinates, tasks = rig.coordinates, schedule.body_tasks
    q = q + breathing(coordinates, tasks, times, rng)
    q = np.clip(q, coordinates.lower, coordinates.upper)
    closing = rig.face_morphs.get(BLINK, {})
    weights = weights + blinks(closing, tuple(rig.units), schedule.facial_morphs, times, rng)
    q = q + swaying(coordinates, tasks, times, rng)
    return np.clip(q, coordinates.lower, coordinates.upper), weights


def _with_lids(weights: Array, q: Array, rig: Rig) -> Array:
    """Add the weights with which lids follow the eyes, (T, units)."""
    out, units = weights.copy(), tuple(rig.units)
    for unit, weight in rig.lid_weights(q).items():
        out[:, units.index(unit)] += weight
    return out


def _clip(score: Score, rig: Rig, times: Array, q: Array, weights: Array, lead_s: float) -> Clip:
    """Make a clip, which starts at zero, with those face units that ever have a weight."""
    used = np.flatnonzero(np.any(weights != 0.0, axis=0))
    names = tuple(tuple(rig.units)[i] for i in used)
    return Clip(times + lead_s, q, names, weights[:, used], labels(score, lead_s))
