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
from azee.motion.keys.plan import Plan, plan
from azee.motion.keys.rest import DEFAULT, RESTS, Rest, rest_posture
from azee.motion.overlay.accents import layers as accent_layers
from azee.motion.overlay.accents import shortfalls as accent_shortfalls
from azee.motion.overlay.blinks import BLINK, blinks, boundaries, lids_busy
from azee.motion.overlay.face import RAMP_S, face_weights
from azee.motion.overlay.hanging_arms import yielding_to_leans
from azee.motion.overlay.labels import labels
from azee.motion.overlay.life import AFTER_S, BEFORE_S
from azee.motion.overlay.life import life as life_of
from azee.motion.overlay.recordings import life_share, recorded_face
from azee.motion.overlay.saturation import saturated
from azee.motion.overlay.seed import seed_of
from azee.motion.overlay.trill import add_trills, oscillation
from azee.motion.projection.projection import Reference, inside, on_living_body, project
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.key_posture import PostureSolver, Search
from azee.motion.tasks.key_selection import MODES, KeySelection, Mode
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.recordings import imposed
from azee.motion.tasks.schedule import TaskSchedule, bind
from azee.motion.tasks.tracks import Track, tracks
from azee.motion.tasks.turning import with_turns
from azee.motion.timing.pace import Pace
from azee.motion.timing.performed import TIMINGS, Performance, Timing, performed
from azee.motion.timing.recalled import recalled
from azee.motion.timing.remembering import RememberingSolver
from azee.motion.timing.way_round import turning_as_joints_do
from azee.motion.timing.ways import Ways
from azee.quality.constraint_results import constraint_results
from azee.quality.likeness import likeness
from azee.quality.measures import PenetrationSearch, block_times, peaks
from azee.quality.motion_report import MotionReport, limit_excess
from azee.quality.recordings import as_played
from azee.quality.task_spans import task_spans
from azee.score.provenance import Provenance
from azee.score.score import Score
from azee.score.stretch import paced
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.evaluate import Evaluator
from azee_solver.evaluate import evaluator as evaluator_of
from azee_solver.geometry import Side
from azee_solver.options import SolveOptions
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]

PACE = Pace()
"""How fast arms go by default."""


@dataclass(frozen=True, slots=True, eq=False)
class Animation:
    """A clip with its report.

    score: as performed; all times are those of its time line. key_times: of all key postures, on
    the clip's time line. lead_s: when the score's time line starts in the clip; before, the signer
    stands at rest and moves into the first key posture. tracks: which block keys
    what, on the score's time line. provenance: whose testimony the rules of its text are; none for
    a score that no text was given for.
    """

    score: Score
    clip: Clip
    report: MotionReport
    key_times: tuple[float, ...]
    lead_s: float
    tracks: tuple[Track, ...] = ()
    provenance: Provenance | None = None


def animate(
    score: Score,
    rig: Rig,
    *,
    fps: float = 30.0,
    dominant: Side = Side.RIGHT,
    mode: Mode = "tracks",
    seed: int | None = None,
    life: bool = True,
    rest: Rest = DEFAULT,
    precise: bool = False,
    solver: PostureSolver | None = None,
    timing: Timing | None = None,
    tempo: float = 1.0,
    pace: Pace = PACE,
) -> Animation:
    """Make a body play a score.

    Args: fps: frames per second, positive. mode: which limbs key postures key. seed: of the
        blinks and of life; by default `seed_of(score)`. life: whether to add these. rest: where
        arms are that nothing needs. precise: whether to meet constraints at any price of comfort.
        solver: what solves key postures; `azee_solver.solve` if none
        is given. timing: whether ways that are too long for their time get more of it; by default
        they do in tracks and not in flat mode. tempo: how many times faster all is that is not
        fixed. pace: how fast arms go.
    What names a bone, site or morph that the rig lacks is left out.

    Raises: ValueError: an unknown mode, timing or rest, or a frame rate or tempo that is none.
    """
    if timing is None:
        timing = "exact" if mode == "flat" else "performed"
    if timing not in TIMINGS:
        raise ValueError(f"there is no timing '{timing}'; the timings are: {', '.join(TIMINGS)}")
    if not (math.isfinite(tempo) and tempo > 0):
        raise ValueError(f"nobody signs {tempo} times as fast")
    if mode not in MODES:
        raise ValueError(f"there is no mode '{mode}'; the modes are: {', '.join(MODES)}")
    if rest not in RESTS:
        raise ValueError(f"there is no rest '{rest}'; the rests are: {', '.join(RESTS)}")
    if not (math.isfinite(fps) and fps > 0):
        raise ValueError(f"{fps} frames per second make no clip")
    evaluator = evaluator_of(rig, dominant)
    selection = KeySelection(Limbs.of(rig.coordinates), mode)
    rate = Fraction(fps)
    layered = not selection.flat
    seed = seed_of(score) if seed is None else seed

    # 1. Give ways their time: scale the score, and bend it where an arm has too far to go.
    #    Before, find the ends of turns, and the places of points as they were.
    postures = solver or default_solver(rig, dominant, precise)
    score = paced(with_turns(score, dominant), 1 / Fraction(str(float(tempo))))
    if timing == "performed":
        postures = RememberingSolver(postures)
    at_rest = rest_posture(rig, rest, dominant)
    score = recalled(score, evaluator, selection, postures, at_rest)
    score = turning_as_joints_do(score, evaluator, selection, postures, at_rest)
    performance, needed_s = Performance(score), None
    if timing == "performed":
        performance = performed(score, evaluator, selection, postures, pace, at_rest)
        score, needed_s = performance.score, Ways(evaluator, selection.limbs.members, pace).needed_s

    # 2. Project the nested score on one time line; of what is performed there is one already.
    schedule = performance.schedule
    timeline = flatten(score) if schedule is None else schedule.timeline

    # 3. Bind every constraint to the body: a timed task says which limbs it moves and reads.
    if schedule is None:
        schedule = bind(timeline, rig, evaluator.binding, selection.limbs, layered=layered)

    # 4 to 10. Solve key postures and join them to a movement.
    frames_inside = [n / rate for n in range(math.floor(score.duration * rate) + 1)]
    planned = plan(
        schedule, evaluator, selection, postures, frames_inside, at_rest, needed_s,
        performance.boundaries,
    )  # fmt: skip

    # 11. Sample the movement at the clip's frames, and lay accents and life on it.
    times, lead_s = _frame_times(score.duration, planned.movement, schedule, rate)
    reference = _with_layers(planned, schedule, times, seed if life else None, layered=layered)
    if layered and rest == "hanging":
        aside = np.where(reference.played, 0.0, yielding_to_leans(rig, reference.q, at_rest))
        reference = replace(reference, q=reference.q + aside)

    # 12. Draw it onto the constraints in force; in flat mode it stays as it is.
    if layered:
        planned = on_living_body(planned, reference, seed if life else None)
        q = project(planned, reference, float(fps))
    else:
        q = np.clip(reference.q, rig.coordinates.lower, rig.coordinates.upper)
    samples = inside(times, q, kinematics.frames(rig.chain, q), score.duration)

    # 13. Add trills, the face, blinks, and lids that follow the eyes.
    seconds = np.array([float(time) for time in times])
    shortfalls = accent_shortfalls(schedule.accents, reference.q, q, seconds, evaluator)
    q, trill_shortfalls = _with_trills(q, seconds, schedule, evaluator)
    weights = face_weights(
        schedule.facial_morphs, rig.face_morphs, tuple(rig.units), dominant, seconds
    )
    if life:
        at = boundaries(score, schedule.all, q, seconds, rig.coordinates)
        weights = _with_blinks(weights, seconds, schedule, at, rig, dominant, seed)
    weights = weights + recorded_face(schedule.recorded, tuple(rig.units), seconds)
    weights = saturated(_with_lids(weights, q, rig), rig)

    # 14. Make the clip, measure it and report.
    clip = _clip(score, rig, seconds, q, weights, lead_s)
    penetration = PenetrationSearch(rig, dominant, schedule, clip.coordinates, seconds)
    excess, joint = limit_excess(q, rig.coordinates)
    report = MotionReport(
        rig=rig.name,
        fps=float(fps),
        mode=mode,
        duration_s=float(clip.times[-1]),
        lead_s=lead_s,
        score_s=float(score.duration),
        measure_constraints=partial(
            constraint_results,
            schedule,
            planned,
            samples,
            {**shortfalls, **trill_shortfalls},
            float(fps),
        ),
        max_excess_rad=excess,
        excess_joint=joint,
        postures=planned.postures,
        blocks=tuple(block_times(schedule.all, planned.monitor.early_ends)),
        measure_peaks=partial(peaks, q, float(fps), rig.coordinates.names, lead_s),
        measure_penetration=penetration,
        measure_likeness=partial(
            likeness,
            clip,
            rig,
            score,
            task_spans(schedule.all, planned.monitor.early_ends, schedule.recorded),
            zero_s=lead_s,
            dominant=dominant,
        ),
        timing=timing,
        tempo=float(tempo),
        stretched=performance.stretched,
        extra_s=float(performance.extra_s),
        recordings=tuple(map(as_played, schedule.recorded)),
        measure_fingers=penetration.between_fingers,
    )
    moments = {float(p.time) for p in planned.postures}
    moments |= {t for block in schedule.recorded for t in block.moments_s}
    key_times = tuple(sorted(time + lead_s for time in moments))
    by_block = tracks(schedule, planned.postures, selection, rig.coordinates)
    return Animation(score, clip, report, key_times, lead_s, by_block)


def default_solver(rig: Rig, dominant: Side, precise: bool = False) -> PostureSolver:
    """Return what solves key postures where nothing else is given: `azee_solver.solve`."""

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
) -> tuple[tuple[Fraction, ...], float]:
    """Return all frames on the score's time line, and the lead before its zero in seconds.

    The lead is a whole number of frames, so that the score starts on one.
    """
    first, last = min(0.0, movement.start_s), max(float(score_s), movement.end_s)
    if schedule.facial_morphs:
        last = max(last, float(score_s) + RAMP_S)
    before = math.ceil((BEFORE_S - first) * rate)
    after = math.ceil((last + AFTER_S) * rate)
    return tuple(n / rate for n in range(-before, after + 1)), float(before / rate)


def _with_layers(
    planned: Plan,
    schedule: TaskSchedule,
    times: Sequence[Fraction],
    seed: int | None,
    *,
    layered: bool,
) -> Reference:
    """Sample the movement and add accents and, with a seed, life."""
    evaluator = planned.monitor.evaluator
    seconds = np.array([float(time) for time in times])
    q = planned.movement.sample(seconds)
    accents = accent_layers(schedule.accents, seconds, evaluator)
    if seed is not None and layered:
        lively = life_share(schedule.recorded, seconds, q.shape[1])
        q = q + lively * life_of(evaluator.rig, q, seconds, seed)
    played = imposed(schedule.recorded, times, q.shape[1]).mask
    return Reference(tuple(times), q + accents.offsets, accents.asked, played)


def _with_trills(
    q: Array, times: Array, schedule: TaskSchedule, evaluator: Evaluator
) -> tuple[Array, dict[int, float]]:
    """Add trills to coordinates (T, V); return also by how much they fall short, by rank.

    A trill turns the bone as its joints can in the posture in the middle of its block.
    """
    trills = []
    for task in schedule.trills:
        middle = float(task.interval.start + task.interval.end) / 2
        posture = q[int(np.abs(times - middle).argmin())]
        trills.append(oscillation(task, posture, evaluator))
    return add_trills(q, times, trills, evaluator.rig.coordinates)


def _with_blinks(
    weights: Array,
    times: Array,
    schedule: TaskSchedule,
    boundaries_s: Sequence[float],
    rig: Rig,
    dominant: Side,
    seed: int,
) -> Array:
    """Add blinks to the weights of the face units, (T, units)."""
    rng = np.random.default_rng((seed, 1))
    busy = lids_busy(schedule.facial_morphs, rig.face_morphs, dominant, times)
    closing = rig.face_morphs.get(BLINK, {})
    return weights + blinks(closing, tuple(rig.units), busy, boundaries_s, times, rng)


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
