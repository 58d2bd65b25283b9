"""The movement as it is performed: key curves with layers on them, drawn onto the constraints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.keys.plan import Plan
from azee.motion.keys.residual_monitor import MovementSamples
from azee.motion.keys.transpath import PathEnd
from azee.motion.projection.frame_problems import FrameProblems
from azee_rig.chain import Frames
from azee_solver import kinematics
from azee_solver.options import SolveOptions

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """The movement that is wanted as far as constraints allow, at the frames of a clip.

    times: exact, on the score's time line. q: (T, V), not limited. accented: (T, V), where accents
    ask for what q has. played: (T, V), where q is a recording's, which is not changed.
    """

    times: tuple[Fraction, ...]
    q: Array
    accented: NDArray[np.bool_]
    played: NDArray[np.bool_]


LEAD = 0.018
"""Share of its time by which a site on its path is early or late at most, in the middle."""
LEAD_STEP = (5.0 - math.sqrt(5.0)) / 10.0
"""Multiples of it, taken modulo 1, differ by .17 to .45 from the next three: paths follow each
other, or every other one is the same again, as where a hand goes to and fro."""


def on_living_body(planned: Plan, reference: Reference, seed: int | None) -> Plan:
    """Return a plan whose paths start and end where the reference's body has their places.

    Keys are solved on a body without life. A path that starts at the chest starts a little
    elsewhere if the chest breathes meanwhile. With a seed, no two paths take their time alike, as
    nobody repeats a movement exactly.
    """
    monitor = planned.monitor
    chain = monitor.evaluator.rig.chain
    seconds = np.array([float(t) for t in reference.times])

    def carried(end: PathEnd) -> PathEnd:
        q = reference.q[int(np.abs(seconds - float(end.time)).argmin())]
        return end.carried(kinematics.frames(chain, q), monitor.evaluator)

    paths = {}
    for n, (rank, path) in enumerate(sorted(monitor.paths.items())):
        lead = 0.0 if seed is None else LEAD * (2.0 * ((n + seed % 1000) * LEAD_STEP % 1.0) - 1.0)
        motion = replace(path.motion, lead=lead)
        paths[rank] = replace(path, motion=motion, start=carried(path.start), end=carried(path.end))
    return replace(planned, monitor=replace(monitor, paths=paths))


def project(planned: Plan, reference: Reference, fps: float) -> Array:
    """Return the movement (T, V) nearest to a reference that meets what is in force, smoothly."""
    factors = {**_weights_beside_recordings(planned), **_weights_of_unmet(planned)}
    problems = FrameProblems(planned.monitor, factors, planned.postures, SolveOptions())
    problem = problems.trajectory(
        reference.times, reference.q, reference.accented, reference.played, fps
    )
    return problem.solve(fps)


PLAYED_WEIGHT = 9.0
"""Factor of the weight of what follows a recording: a fingertip on a forearm that moves by 20 cm in
a second is then within .5 mm of it, not 1.2 mm."""


def _weights_beside_recordings(planned: Plan) -> dict[int, float]:
    """Return factors of the weights of tasks whose targets a recording moves, by rank."""
    schedule = planned.monitor.schedule
    return {
        task.rank: PLAYED_WEIGHT
        for block in schedule.recorded
        for task in schedule.posture_tasks
        if task.read_limbs & block.limbs
    }


GIVEN_UP_COST = 0.4
"""What a constraint costs at the residual that a key posture leaves it, in tolerances squared."""


def _weights_of_unmet(planned: Plan) -> dict[int, float]:
    """Return factors of the weights of tasks that some key posture misses or eases, by rank.

    They go on drawing, but neither at the cost of what is met nor of the posture's comfort.
    """
    out: dict[int, float] = {}
    for posture in planned.postures:
        unmet = {c.task.constraint: c for c in posture.report.constraints if not c.met}
        for task in posture.timed_tasks if unmet else ():
            answer = unmet.get(task.constraint)
            if answer is not None:
                ratio = max(answer.residual / answer.tolerance, 1.0)
                out[task.rank] = min(GIVEN_UP_COST / ratio**2, out.get(task.rank, 1.0))
    return out


def inside(times: Sequence[Fraction], q: Array, frames: Frames, end: Fraction) -> MovementSamples:
    """Return the samples of a movement from the start of the score to its end."""
    rows = [i for i, time in enumerate(times) if 0 <= time <= end]
    part = slice(rows[0], rows[-1] + 1) if rows else slice(0, 0)
    return MovementSamples(tuple(times), q, frames).only(part)
