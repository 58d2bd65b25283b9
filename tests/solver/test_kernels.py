"""The compiled objective against finite differences, and its frames against the chain's own."""

from __future__ import annotations

import math

import numpy as np
import pytest
from kernel_case import (
    CREASE_W,
    HEAD,
    PALM_S,
    POINTS,
    TIP_S,
    TIP_W,
    UP,
    VECTORS,
    Case,
    S,
    W,
)
from numpy.typing import NDArray
from stick_body import stick_body

from azee_rig.chain import Frames
from azee_rig.rig import Rig
from azee_solver import block
from azee_solver.broadphase import Collisions
from azee_solver.collisions import segment_distance
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Look,
    LookAt,
    Orient,
    Place,
    Relation,
    Rotate,
)
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import (
    Bone,
    Dir,
    FreePoint,
    Point,
    Side,
    Site,
    Vec,
    Vector,
)
from azee_solver.program import Cost, Program, Row
from azee_solver.residuals import lower
from azee_solver.tape import Tape
from azee_solver.task import Task
from azee_solver.tolerance import Tolerance


def slope(program: Program, x: NDArray[np.float64], v: int) -> float:
    """Central difference with one step of Richardson's extrapolation."""
    none = np.empty(0)

    def step(h: float) -> float:
        up, down = x.copy(), x.copy()
        up[v] += h
        down[v] -= h
        return (program(up, none) - program(down, none)) / (2 * h)

    return (4 * step(5e-5) - step(1e-4)) / 3


def check_gradient(program: Program, q: NDArray[np.float64]) -> None:
    x = q[program.free]
    gradient = np.empty(len(x))
    value = program(x, gradient)
    assert value > 0
    estimate = np.array([slope(program, x, v) for v in range(len(x))])
    scale = np.abs(estimate).max()
    assert scale > 0
    np.testing.assert_allclose(gradient, estimate, atol=1e-7 * scale, rtol=1e-6)


@pytest.mark.parametrize("expr", VECTORS, ids=lambda e: type(e).__name__)
@pytest.mark.parametrize("kind", [block.MEET, block.PERPENDICULAR])
def test_gradient_of_orientations(expr: Vector, kind: int) -> None:
    case = Case(1)
    rows = [
        Row(kind, case.tape.axis(Bone("f_arm", S), axis), case.tape.unit(case.tape.vector(expr)), w)
        for axis, w in ((BoneAxis.DIR, 2.0), (BoneAxis.NRM, 3.0))
    ]
    check_gradient(case.program(rows), case.q)


@pytest.mark.parametrize("expr", POINTS, ids=lambda e: type(e).__name__)
@pytest.mark.parametrize("kind", [block.MEET, block.AT_DISTANCE])
def test_gradient_of_places(expr: Point, kind: int) -> None:
    case = Case(2)
    site = case.tape.site(Site("M_TIP", S), 0.01)
    row = Row(kind, site, case.tape.point(expr, 0.4), 2.0, 0.1)
    check_gradient(case.program([row]), case.q)


@pytest.mark.parametrize("kind", [block.PERPENDICULAR, block.AT_DISTANCE])
def test_gradient_beyond_a_dead_zone(kind: int) -> None:
    case = Case(2)
    a, b = case.tape.axis(PALM_S, BoneAxis.DIR), case.tape.unit(case.tape.vector(VECTORS[5]))
    check_gradient(case.program([Row(kind, a, b, 2.0, slack=0.05)]), case.q)


@pytest.mark.parametrize("kind", [block.PERPENDICULAR, block.AT_DISTANCE])
def test_nothing_costs_in_a_dead_zone(kind: int) -> None:
    case = Case(2)
    a, b = case.tape.axis(PALM_S, BoneAxis.DIR), case.tape.unit(case.tape.vector(VECTORS[5]))
    program = case.program([Row(kind, a, b, 2.0, slack=2.5)])
    gradient = np.empty(len(program.free))
    assert program(case.q[program.free], gradient) == 0.0
    assert not gradient.any()
    assert program.lengths() == [0.0]


@pytest.mark.parametrize("distance", [0.0, 0.1])
def test_gradient_of_a_site_that_rides_on_two_nodes(distance: float) -> None:
    case = Case(8)
    tip, crease = case.tape.site(Site("I_TIP", S)), case.tape.site(Site("ELi", W), distance)
    check_gradient(case.program([Row(block.MEET, tip, crease, 2.0)]), case.q)


def test_gradient_of_rotations_and_gaze() -> None:
    case = Case(3)
    rows = []
    for rotate in (
        Rotate(Bone("back_2"), Vec(1.0, 0.5, 0.0), 0.3),
        Rotate(HEAD, Dir(PALM_S), -0.6),
        Rotate(Bone("back_1"), UP, 0.2),
    ):
        rows += [Row(block.MEET, a, b, 0.5) for a, b in case.tape.turned_frame(rotate)]
    centre, gaze = case.tape.gaze(Bone("eye", Side.LEFT))
    rows.append(Row(block.MEET, gaze, case.tape.towards(centre, case.tape.point(TIP_S)), 1.0))
    check_gradient(case.program(rows), case.q)


@pytest.mark.parametrize("seed", range(6))
def test_gradient_of_collisions_posture_and_comfort(seed: int) -> None:
    case = Case(seed)
    pairs = case.rig.capsules.pairs
    reach = case.rig.capsules.radius[pairs].sum(axis=1) + 0.12
    program = case.program([], Collisions(pairs, reach), keep=0.3, comfort=5.0, overlap=40.0)
    check_gradient(program, case.q)


def test_gradient_with_few_coordinates_free() -> None:
    rig = stick_body()
    free = [v for v, name in enumerate(rig.coordinates.names) if name.startswith(("arm_R", "back"))]
    case = Case(4, free)
    row = Row(block.MEET, case.tape.site(Site("I_TIP", S)), case.tape.point(POINTS[0]), 1.0)
    turn = Row(block.MEET, case.tape.unit(case.tape.vector(VECTORS[5])), case.tape.vector(UP), 2.0)
    pairs = rig.capsules.pairs
    reach = rig.capsules.radius[pairs].sum(axis=1) + 0.1
    check_gradient(case.program([row, turn], Collisions(pairs, reach), overlap=30.0), case.q)


@pytest.mark.parametrize("seed", range(3))
def test_frames_equal_those_of_the_chain(seed: int) -> None:
    case = Case(seed)
    rig = case.rig
    rows = [
        Row(block.MEET, case.tape.node_point(b, np.zeros(3)), case.tape.constant(np.ones(3)), 1.0)
        for b in range(len(rig.chain.names))
    ]
    program = case.program(rows)
    other = np.random.default_rng(99).uniform(rig.coordinates.lower, rig.coordinates.upper)
    program(other, np.empty(0))
    wanted = rig.chain.frames(other)
    run = slice(program.ints[block.POSITIONS], program.ints[block.POSITIONS + 1])
    np.testing.assert_allclose(program.reals[run].reshape(-1, 3), wanted.positions, atol=1e-13)
    run = slice(program.ints[block.ROTATIONS], program.ints[block.ROTATIONS + 1])
    np.testing.assert_allclose(program.reals[run].reshape(-1, 3, 3), wanted.rotations, atol=1e-13)


@pytest.mark.parametrize("expr", VECTORS, ids=lambda e: type(e).__name__)
def test_a_tape_gives_the_evaluator_s_vectors(expr: Vector) -> None:
    case = Case(5)
    row = Row(block.MEET, case.tape.vector(expr), case.tape.constant(np.zeros(3)), 1.0)
    value = case.program([row])(case.q, np.empty(0))
    wanted = case.evaluator.vector(expr, case.rig.chain.frames(case.q))
    assert value == pytest.approx(float(wanted @ wanted), rel=1e-12)


@pytest.mark.parametrize("expr", POINTS, ids=lambda e: type(e).__name__)
def test_a_tape_gives_the_evaluator_s_points(expr: Point) -> None:
    case = Case(6)
    place = np.array([0.3, 0.2, 0.1])
    row = Row(block.MEET, case.tape.point(expr, 0.25), case.tape.constant(place), 1.0)
    value = case.program([row])(case.q, np.empty(0))
    wanted = case.evaluator.point(expr, case.rig.chain.frames(case.q), 0.25) - place
    assert value == pytest.approx(float(wanted @ wanted), rel=1e-12)


@pytest.mark.parametrize(
    "constraint",
    [
        Place(Site("I_TIP", S), FreePoint(0.1, -0.2, 0.3)),
        Place(Site("I_TIP", S), FreePoint(0.1, -0.2, 0.3), 0.2),
        Place(Site("I_TIP", S), TIP_W, 0.1),
        Place(Site("I_TIP", S), CREASE_W, 0.1),
        Orient(BoneAxis.DIR, PALM_S, Relation.ALONG, VECTORS[5]),
        Orient(BoneAxis.NRM, PALM_S, Relation.ACROSS, VECTORS[6]),
        Rotate(HEAD, Vec(1.0, 0.5, 0.0), 0.4),
        Rotate(HEAD, Dir(PALM_S), 0.4),
        Look(Dir(PALM_S)),
        LookAt(TIP_W),
    ],
    ids=lambda c: type(c).__name__,
)
def test_a_miss_by_the_tolerance_costs_one(constraint: Constraint) -> None:
    """With tolerances as wide as the miss; chords stand for angles, so angles must be small."""
    case = Case(7)
    wanted, _ = case.evaluator.residual(constraint, case.rig.chain.frames(case.q), case.q)
    tolerance = Tolerance(float(wanted), float(wanted))
    asked = {0: Task(constraint)}
    residuals = lower(case.tape, asked, tolerance, {})
    program = case.program(list(residuals.rows))
    value = program(case.q, np.empty(0))
    ratio = residuals.ratios(program.lengths(), asked, tolerance)[0]
    assert ratio == pytest.approx(1.0, rel=1e-9)
    if isinstance(constraint, Place):
        assert value == pytest.approx(1.0, rel=1e-9)
    elif isinstance(constraint, Orient | Rotate):
        across = isinstance(constraint, Orient) and constraint.relation is Relation.ACROSS
        chord = math.sin(wanted) if across else 2 * math.sin(wanted / 2)
        assert value == pytest.approx((chord / wanted) ** 2, rel=1e-9)
    else:
        assert 0.0 < value < 2.0  # two eyes


def test_balls_pass_over_nothing_that_overlaps(signer: Rig) -> None:
    limits, capsules = signer.coordinates, signer.capsules
    pairs = np.vstack([capsules.pairs, capsules.finger_pairs])
    reach = capsules.radius[pairs].sum(axis=1)
    moving = np.ones(len(signer.chain.names), dtype=np.bool_)
    tape = Tape(Evaluator(signer, Side.RIGHT), signer.chain.frames(limits.idle), moving)
    nothing = np.zeros(len(limits))
    program = Program(
        signer,
        limits.idle,
        range(len(limits)),
        tape,
        [],
        Collisions(pairs, reach),
        Cost(nothing, nothing, nothing, 1.0),
    )
    balls = program.section(block.RUN_REACH)
    assert len(balls) < len(pairs) / 5
    near, random, overlapping = balls.copy(), np.random.default_rng(5), 0
    for _ in range(60):
        x = random.uniform(limits.lower, limits.upper)
        balls[:] = near
        value = program(x, np.empty(0))
        balls[:] = 1e3
        assert program(x, np.empty(0)) == value
        ends = signer.chain.frames(x)
        assert value == pytest.approx(float(np.sum(brute_overlaps(signer, pairs, ends) ** 2)))
        overlapping += value > 0
    assert overlapping > 20


def brute_overlaps(rig: Rig, pairs: NDArray[np.int64], frames: Frames) -> NDArray[np.float64]:
    capsules = rig.capsules
    R, o = frames.rotations[capsules.node], frames.positions[capsules.node]
    a = np.einsum("kij,kj->ki", R, capsules.a) + o
    b = np.einsum("kij,kj->ki", R, capsules.b) + o
    i, j = pairs.T
    gap = capsules.radius[i] + capsules.radius[j] - segment_distance(a[i], b[i], a[j], b[j])
    return np.asarray(np.maximum(gap, 0.0))
