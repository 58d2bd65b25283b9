"""The trajectory problem against the same problem solved by numpy, and the banded factor."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

import azee_solver.trajectory as trajectories
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.anatomy import anatomy
from azee_solver.body import Body
from azee_solver.constraint import Constraint, Place
from azee_solver.evaluate import Evaluator, evaluator
from azee_solver.geometry import FreePoint, Side, Site
from azee_solver.options import SolveOptions
from azee_solver.program import Cost, Program
from azee_solver.residuals import lower
from azee_solver.tape import Tape
from azee_solver.task import Task
from azee_solver.trajectory import ORDER, Refills, Stage, Trajectory

TIP = Site("I_TIP", Side.STRONG)
NEAR, FAR = Place(TIP, FreePoint(-0.1, 0.1, 0.35)), Place(TIP, FreePoint(-0.15, 0.12, 0.33))
FPS = 30.0


@cache
def rig() -> Rig:
    return load_rig()


def of_body() -> Evaluator:
    return evaluator(rig(), Side.RIGHT)


def program(*constraints: Constraint) -> Program:
    idle = rig().coordinates.idle
    options = SolveOptions()
    body = Body(rig(), of_body(), idle, {}, options, constraints)
    every = frozenset(range(len(idle)))
    tape = Tape(
        of_body(), body.frames(idle), anatomy(rig().chain, rig().coordinates).moved_by(every)
    )
    tasks = {i: Task(c, (), Fraction(0), i) for i, c in enumerate(constraints)}
    rows = lower(tape, tasks, options.tolerance, {}).rows
    nothing = np.zeros(len(idle))
    collisions = body.obstacles.for_problem(every, frozenset())
    return Program(
        rig(), idle, sorted(every), tape, rows, collisions, Cost(idle, nothing, nothing, 0.0)
    )


def no_refills(frames: range, q: NDArray[np.float64]) -> Refills:
    T = len(frames)
    return Refills(
        np.zeros(T, dtype=np.int64), np.zeros((T, 1), dtype=np.int64), np.zeros((T, 1, 5))
    )


def trajectory(
    of_frame: list[int], programs: list[Program], smooth: float, overlap: float = 0.0
) -> Trajectory:
    T, V = len(of_frame), len(rig().coordinates)
    return Trajectory(
        programs, np.array(of_frame), np.tile(rig().coordinates.idle, (T, 1)), np.ones((T, V)),
        np.zeros((T, V), dtype=np.bool_), np.full(V, smooth), rig().coordinates.lower,
        rig().coordinates.upper, overlap, no_refills,
    )  # fmt: skip


def tip(q: NDArray[np.float64]) -> NDArray[np.float64]:
    return of_body().site(TIP, rig().chain.frames(q))


def target(place: Place) -> NDArray[np.float64]:
    return of_body().point(place.point, rig().chain.frames(rig().coordinates.idle))


FREE, HELD, ELSEWHERE = 0, 1, 2


def test_what_is_in_force_is_met_in_its_frames_and_the_rest_follows_smoothly() -> None:
    frames = [FREE] * 6 + [HELD] * 6 + [FREE] * 6 + [ELSEWHERE] * 6 + [FREE] * 6
    q = trajectory(frames, [program(), program(NEAR), program(FAR)], 10.0).solve(FPS)
    where = tip(q)
    for t, kind in enumerate(frames):
        if kind != FREE:
            wanted = target(NEAR if kind == HELD else FAR)
            assert np.linalg.norm(where[t] - wanted) < 1e-3
    assert np.abs(np.diff(q, 2, axis=0)).max() < 0.2
    assert q[0] == pytest.approx(rig().coordinates.idle, abs=0.05)


def test_a_smoother_answer_costs_more_of_the_reference() -> None:
    frames = [FREE] * 12 + [HELD] * 6 + [FREE] * 12
    rough, smooth = (
        trajectory(frames, [program(), program(NEAR)], s).solve(FPS) for s in (1.0, 100.0)
    )
    bend = [np.sum(np.diff(q, 2, axis=0) ** 2) for q in (rough, smooth)]
    away = [np.sum((q - rig().coordinates.idle) ** 2) for q in (rough, smooth)]
    assert bend[1] < bend[0]
    assert away[1] > away[0]


def test_the_answer_has_no_slope_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trajectories, "WHOLE", Stage(1.0, 0.0, 40, 1e-9))
    monkeypatch.setattr(trajectories, "MET_SHARE", math.inf)
    frames = [FREE] * 4 + [HELD] * 5 + [FREE] * 4
    programs = [program(), program(NEAR)]
    smooth = 5.0
    problem = trajectory(frames, programs, smooth)
    q = problem.solve(FPS)

    def cost(x: NDArray[np.float64]) -> float:
        d = x - rig().coordinates.idle
        total = float(np.sum(d**2)) + smooth * float(np.sum(np.diff(d, ORDER, axis=0) ** 2))
        misses = np.linalg.norm(tip(x) - target(NEAR), axis=1)
        return total + float(np.sum(misses[np.array(frames) == HELD] ** 2)) / 1e-6

    base = cost(q)
    rng = np.random.default_rng(0)
    inside = (q > rig().coordinates.lower + 1e-3) & (q < rig().coordinates.upper - 1e-3)
    for _ in range(20):
        nudge = rng.normal(size=q.shape) * inside
        nudge *= 1e-5 / np.abs(nudge).max()
        assert cost(q + nudge) + cost(q - nudge) > 2 * base - 1e-9
        slope = (cost(q + nudge) - cost(q - nudge)) / 2e-5
        assert abs(slope) < 0.2


def test_fixed_coordinates_and_limits_are_kept() -> None:
    frames = [HELD] * 8
    problem = trajectory(frames, [program(), program(NEAR)], 1.0)
    elbow = rig().coordinates.index["f_arm_R.flexion"]
    problem.fixed[:, elbow] = True
    q = problem.solve(FPS)
    assert np.all(q[:, elbow] == rig().coordinates.idle[elbow])
    assert np.all(q >= rig().coordinates.lower)
    assert np.all(q <= rig().coordinates.upper)


def test_coordinates_stay_inside_their_limits_unless_something_is_missed_by_that() -> None:
    limits = rig().coordinates
    problem = trajectory([HELD] * 8, [program(), program(NEAR)], 1.0)
    q = problem.solve(FPS)
    room = np.minimum(q - limits.lower, limits.upper - q).min(axis=0)
    some = np.clip(room - math.radians(1), 0.0, math.radians(10))
    kept = replace(problem, near_limits=np.tile(some, (8, 1))).solve(FPS)
    assert np.all((kept >= limits.lower + some) & (kept <= limits.upper - some))
    too_much = np.minimum(room + math.radians(10), 0.45 * (limits.upper - limits.lower))
    needed = replace(problem, near_limits=np.tile(too_much, (8, 1))).solve(FPS)
    assert np.linalg.norm(tip(needed) - target(NEAR), axis=1).max() < 1e-3


def test_windows_join_without_a_seam() -> None:
    frames = ([FREE] * 20 + [HELD] * 20) * 4
    q = trajectory(frames, [program(), program(NEAR)], 10.0).solve(FPS)
    jerk = np.abs(np.diff(q, 3, axis=0)).max(axis=1)
    seams = [n * round(1.5 * FPS) for n in (1, 2, 3)]
    inside = np.array([t for t in range(len(jerk)) if min(abs(t - s) for s in seams) > 5])
    at_seams = np.array([t for t in range(len(jerk)) if min(abs(t - s) for s in seams) <= 5])
    assert jerk[at_seams].max() <= 1.2 * jerk[inside].max()


def test_bodies_are_pushed_apart() -> None:
    index = rig().coordinates.index
    problem = trajectory([FREE] * 10, [program()], 1.0, overlap=SolveOptions().overlap)
    problem.reference[:, index["arm_R.abduction"]] = rig().coordinates.lower[
        index["arm_R.abduction"]
    ]
    problem.reference[:, index["arm_R.flexion"]] = 0.0
    problem.reference[:, index["f_arm_R.flexion"]] = math.radians(90)
    problem.reference[:, index["arm_R.rotation"]] = math.radians(60)
    body = Body(rig(), of_body(), rig().coordinates.idle, {}, SolveOptions(), ())

    def depth(q: NDArray[np.float64]) -> float:
        return max((o.depth_m for o in body.obstacles.overlaps(q)), default=0.0)

    before, after = depth(problem.reference[5]), depth(problem.solve(FPS)[5])
    assert before > 0.02
    assert after < 0.25 * before


def test_no_frame_is_no_problem() -> None:
    empty = trajectory([], [program()], 1.0)
    assert empty.solve(FPS).shape == (0, len(rig().coordinates))
