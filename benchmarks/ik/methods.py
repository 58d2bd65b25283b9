"""Methods in this process: ours in several settings, the published one, scipy's, the LM kernel."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from azee_rig.rig import Rig
from azee_solver.anatomy import anatomy
from azee_solver.broadphase import Collisions
from azee_solver.descent import soft_descent
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side
from azee_solver.options import SolveOptions
from azee_solver.program import Cost, Program
from azee_solver.residuals import lower
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport
from azee_solver.starts import starts
from azee_solver.tape import Tape
from azee_solver.two_level import solve_two_level
from benchmarks.ik.clock import Clock
from benchmarks.ik.levenberg import NOTHING, Flat
from benchmarks.ik.problems import TIGHT, Problem

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Answer:
    """A posture (V,) and its cost. rounds: of the two-level method, per IK problem."""

    q: Array
    seconds: float
    evaluations: int
    rounds: tuple[int, ...] = ()


Method = Callable[[Rig, Problem], Answer]

FULL = SolveOptions()
APART = replace(FULL, overlap=0.0, overlap_m=math.inf)
BARE = replace(APART, posture=0.0, comfort=0.0)
STARTS = 10
"""Number of starts (idle and random ones) of the methods that are a single descent each."""
FEW_STARTS = 4
"""The same for slower methods."""


def ours(options: SolveOptions) -> Method:
    """Run `solve`: problems are built, grouped, solved, widened and measured again."""

    def method(rig: Rig, problem: Problem) -> Answer:
        idle = rig.coordinates.idle
        clock = Clock()
        report = solve(
            rig,
            problem.tasks,
            dominant=Side.RIGHT,
            start=idle,
            reference=idle,
            options=options,
        )
        return _answer(report, clock)

    return method


def two_level(rig: Rig, problem: Problem) -> Answer:
    """Listing 1 of the 2018 paper."""
    idle = rig.coordinates.idle
    clock = Clock()
    report = solve_two_level(rig, problem.tasks, dominant=Side.RIGHT, start=idle, reference=idle)
    rounds = tuple(p.iterations for p in report.problems if p.iterations is not None)
    return replace(_answer(report, clock), rounds=rounds)


def _answer(report: SolveReport, clock: Clock) -> Answer:
    return Answer(report.coordinates, clock.seconds(), report.evaluations)


def ours_laid_out(rig: Rig, problem: Problem) -> Answer:
    """Run our descents alone, with posture and joint-limit cost; laying out is not timed."""
    idle = np.array(rig.coordinates.idle)
    evaluator = Evaluator(rig, Side.RIGHT)
    moving = anatomy(rig.chain, rig.coordinates).moved_by(problem.free)
    tape = Tape(evaluator, rig.chain.frames(idle), moving)
    asked = dict(enumerate(problem.tasks))
    residuals = lower(tape, asked, FULL.tolerance, {})
    cost = Cost(
        idle,
        FULL.posture * rig.coordinates.stiffness**2,
        np.full(len(idle), FULL.comfort),
        0.0,
    )
    free = sorted(problem.free)
    program = Program(rig, idle, free, tape, residuals.rows, Collisions.none(), cost)
    known = list(starts(rig.coordinates, program.free, idle))
    best, worst = idle[free], math.inf
    clock = Clock()
    for start in known:
        x = soft_descent(program, start, FULL)
        program(x, np.empty(0))
        ratio = max(residuals.ratios(program.lengths(), asked, FULL.tolerance).values())
        if ratio < worst:
            best, worst = x, ratio
        if worst <= 1.0:
            break
    rounds = FULL.finish_work // len(best)
    best = program.gauss_newton(
        best, rounds=rounds, tolerance=FULL.finish_tolerance, keep_damping=True
    )
    seconds = clock.seconds()
    q = idle
    q[free] = best
    return Answer(q, seconds, program.evaluations)


def lm_kernel(*, full: bool) -> Method:
    """Return the kernel of `levenberg` as a method; the time excludes laying out.

    Args: full: whether to minimise the posture cost too, with the same weights as ours.
    """

    def method(rig: Rig, problem: Problem) -> Answer:
        flat = Flat(rig, problem.constraints, problem.free, TIGHT)
        stiffness = rig.coordinates.stiffness[flat.free]
        keep = math.sqrt(FULL.posture) * stiffness if full else NOTHING
        known = list(_random_starts(rig, flat))
        best, worst, evaluations = known[0], math.inf, 0
        clock = Clock()
        for start in known:
            q, count = flat.descend(start, keep)
            evaluations += count
            far = flat.worst(q)
            if far < worst:
                best, worst = q, far
            if worst <= 1.0:
                break
        return Answer(best, clock.seconds(), evaluations)

    return method


def scipy_trf(rig: Rig, problem: Problem) -> Answer:
    """Run `scipy.optimize.least_squares`, method trf, with the LM kernel's Jacobian."""
    flat = Flat(rig, problem.constraints, problem.free, TIGHT)
    known = list(_random_starts(rig, flat))[:FEW_STARTS]
    best, worst, evaluations = known[0], math.inf, 0
    clock = Clock()
    for start in known:
        q = start.copy()

        def posture(x: Array, q: Array = q) -> Array:
            q[flat.free] = x
            return q

        found = least_squares(
            lambda x: flat.residuals(posture(x))[0],
            start[flat.free],
            lambda x: flat.residuals(posture(x))[1],
            bounds=(flat.lower, flat.upper),
            method="trf",
            ftol=1e-8,
            xtol=1e-8,
            max_nfev=100,
        )
        evaluations += int(found.nfev)
        far = flat.worst(posture(found.x))
        if far < worst:
            best, worst = posture(found.x).copy(), far
        if worst <= 1.0:
            break
    return Answer(best, clock.seconds(), evaluations)


def _random_starts(rig: Rig, flat: Flat) -> Iterator[Array]:
    """Yield idle, moved off its limits, then random postures; the same for every problem."""
    rng = np.random.default_rng(0)
    room = 1e-3 * (flat.upper - flat.lower)
    first = np.array(rig.coordinates.idle)
    first[flat.free] = np.clip(first[flat.free], flat.lower + room, flat.upper - room)
    yield first
    for _ in range(STARTS - 1):
        q = first.copy()
        q[flat.free] = flat.lower + rng.uniform(0.15, 0.85, len(flat.free)) * (
            flat.upper - flat.lower
        )
        yield q


METHODS: dict[str, Method] = {
    "ours, everything on": ours(FULL),
    "ours, no collision": ours(APART),
    "ours, bare": ours(BARE),
    "ours, descents alone": ours_laid_out,
    "two-level": two_level,
    "scipy trf": scipy_trf,
    "LM kernel, full objective": lm_kernel(full=True),
    "LM kernel": lm_kernel(full=False),
}
