"""From a score to a clip: the whole of motion, step by step."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.motion.curves.movement import Movement
from azee.motion.keys.plan import plan
from azee.motion.overlay.face import RAMP_S, face_weights
from azee.motion.overlay.idle import AFTER_S, BEFORE_S, BLINK, blinks, breathing, swaying
from azee.motion.overlay.labels import labels
from azee.motion.overlay.trill import laid_on, oscillation
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.keying import MODES, Keying, Mode
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.posture import PostureSolver, Search
from azee.motion.tasks.timed_task import Bound, bind
from azee.motion.tasks.tracks import Track, tracks
from azee.quality.measures import block_times, peaks, penetrations
from azee.quality.motion_report import MotionReport, constraint_results, limit_excess
from azee.score.score import Score
from azee_rig.rig import Rig
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side
from azee_solver.options import SolveOptions
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Animation:
    """A clip with the report on it.

    key_times: of all key postures, on the clip's time line. lead_s: when the score's time line
    starts in the clip: the signer stands idle before and moves into the first posture. tracks: who
    keys what, on the score's time line.
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
    solver: PostureSolver | None = None,
) -> Animation:
    """Make a body play a score.

    Args: fps: frames per second, positive. mode: which limbs key postures key. seed: of the
        blinks, breaths and sway. life: whether there are any. solver: what solves key
        postures; `azee_solver.solve` if none is given.
    Raises: BindingError: the rig lacks a bone, site or morph that the score names.
        ValueError: an unknown mode or a frame rate that is none.
    """
    if mode not in MODES:
        raise ValueError(f"there is no mode '{mode}'; the modes are: {', '.join(MODES)}")
    if not (math.isfinite(fps) and fps > 0):
        raise ValueError(f"{fps} frames per second make no clip")
    evaluator = Evaluator(rig, dominant)
    limbs = Limbs.of(rig.coordinates)
    bound = bind(flatten(score), rig, evaluator.binding, limbs)
    keying = Keying(limbs, mode)
    rate = Fraction(fps)
    inside = [n / rate for n in range(math.floor(score.duration * rate) + 1)]
    solved = plan(bound, evaluator, keying, solver or _solver(rig, dominant), inside)
    lead, times = _frame_times(score.duration, solved.movement, bound.faces, rate)
    frames = np.array([float(t) for t in times])

    q = solved.movement.sample(frames)
    trills = [oscillation(b, _middle(b, solved.movement), evaluator) for b in bound.trills]
    q, short = laid_on(q, frames, trills, rig.coordinates)
    units = tuple(rig.units)
    weights = face_weights(bound.faces, rig.face_morphs, units, dominant, frames)
    if life:
        rng = np.random.default_rng(seed)
        q = q + breathing(rig.coordinates, bound.moving, frames, rng)
        np.clip(q, rig.coordinates.lower, rig.coordinates.upper, out=q)
        closing = rig.face_morphs.get(BLINK, {})
        weights += blinks(closing, units, bound.faces, frames, rng)
        q = q + swaying(rig.coordinates, bound.moving, frames, rng)
        np.clip(q, rig.coordinates.lower, rig.coordinates.upper, out=q)
    for unit, weight in rig.lid_weights(q).items():
        weights[:, units.index(unit)] += weight
    moving = np.flatnonzero(np.any(weights != 0.0, axis=0))
    lead_s = float(lead)
    clip = Clip(
        frames + lead_s,
        q,
        tuple(units[i] for i in moving),
        weights[:, moving],
        labels(score, lead_s),
    )
    excess, joint = limit_excess(q, rig.coordinates)
    report = MotionReport(
        rig=rig.name,
        fps=float(fps),
        mode=mode,
        duration_s=float(clip.times[-1]),
        lead_s=lead_s,
        score_s=float(score.duration),
        constraints=constraint_results(bound, solved, short, dominant),
        max_excess_rad=excess,
        excess_joint=joint,
        postures=solved.postures,
        blocks=tuple(block_times(bound.all, solved.gauge.giving_way)),
        peaks=peaks(q, float(fps), rig.coordinates.names, lead_s),
        look=lambda: penetrations(rig, q, frames, solved.clearing),
    )
    return Animation(
        clip,
        report,
        tuple(float(p.time) + lead_s for p in solved.postures),
        lead_s,
        tracks(bound, solved.postures, keying, rig.coordinates),
    )


def _solver(rig: Rig, dominant: Side) -> PostureSolver:
    def answer(
        tasks: Sequence[Task],
        *,
        start: Array,
        reference: Array,
        search: Search = Search.WIDE,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        options = SolveOptions(fixed=fixed)
        if search is Search.NEAR:
            options = replace(options, far=False, patience=0)
        return solve(
            rig, tasks, dominant=dominant, start=start, reference=reference, options=options
        )

    return answer


def _middle(bound: Bound, movement: Movement) -> Array:
    """Posture in the middle of a block, (V,)."""
    interval = bound.requirement.interval
    return np.asarray(movement.sample(np.array([float(interval.start + interval.end) / 2]))[0])


def _frame_times(
    score_s: Fraction, movement: Movement, faces: Sequence[Bound], rate: Fraction
) -> tuple[Fraction, list[Fraction]]:
    """Return the lead before the score's zero and all frames on the score's time line.

    The lead is a whole number of frames, so that the score starts on one.
    """
    first, last = min(0.0, movement.start_s), max(float(score_s), movement.end_s)
    if faces:
        last = max(last, float(score_s) + RAMP_S)
    before = math.ceil((BEFORE_S - first) * rate)
    after = math.ceil((last + AFTER_S) * rate)
    return before / rate, [n / rate for n in range(-before, after + 1)]
