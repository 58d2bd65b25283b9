"""The compiled objective against finite differences, and its frames against the chain's own."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from stick_body import stick_body

from azee_rig.chain import Frames
from azee_rig.rig import Rig
from azee_solver import block, nlopt_backend
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
from azee_solver.demand import Demand
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import (
    Between,
    Bone,
    Cross,
    Dir,
    FreePoint,
    JointPoint,
    Moving,
    NamedPoint,
    Nrm,
    Opp,
    Out,
    Point,
    Rotated,
    Scale,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Straight,
    Towards,
    Unit,
    VDiff,
    Vec,
    Vector,
    VSum,
    VTranslate,
)
from azee_solver.layout import Layout
from azee_solver.program import Cost, Program, Row
from azee_solver.residuals import Tolerance, lower
from azee_solver.tape import Tape

S, W = Side.STRONG, Side.WEAK
UP = Vec(0.0, 1.0, 0.0)
PALM_S, PALM_W, HEAD = Bone("palm", S), Bone("palm", W), Bone("head")
TIP_S, TIP_W = SitePoint(Site("I_TIP", S)), SitePoint(Site("I_TIP", W))
CREASE_W = SitePoint(Site("ELi", W))
"""A site that rides on two nodes."""

VECTORS: list[Vector] = [
    UP,
    Out(S),
    Dir(PALM_S),
    Nrm(HEAD),
    Opp(Dir(PALM_W)),
    Unit(VSum((Dir(PALM_S), Scale(Nrm(PALM_W), 0.7), UP))),
    VDiff(Dir(PALM_S), Nrm(HEAD)),
    Cross(Dir(PALM_S), Dir(PALM_W)),
    Towards(JointPoint(PALM_S), SitePoint(Site("CH"))),
    Towards(TIP_S, TIP_W),
    Rotated(Dir(PALM_S), VSum((Nrm(PALM_W), UP)), 0.7),
    Rotated(Rotated(UP, Nrm(PALM_S), 0.4), Cross(Nrm(HEAD), Dir(PALM_W)), -1.9),
]

POINTS: list[Point] = [
    FreePoint(0.1, -0.2, 0.3),
    NamedPoint(SigningSpace.SSSP),
    TIP_W,
    CREASE_W,
    JointPoint(HEAD),
    JointPoint(Bone("back_1")),
    VTranslate(TIP_W, Scale(Dir(PALM_W), 0.05)),
    VTranslate(SitePoint(Site("FH")), Rotated(UP, Dir(PALM_S), 1.0)),
    Between(TIP_S, SitePoint(Site("CH")), 0.3),
    Moving(Straight(), TIP_W, SitePoint(Site("ST"))),
]


class Case:
    """A problem on the stick body with all coordinates free, about a random posture."""

    def __init__(self, seed: int, free: list[int] | None = None) -> None:
        self.rig: Rig = stick_body()
        limits = self.rig.coordinates
        random = np.random.default_rng(seed)
        self.q = limits.lower + random.uniform(0.05, 0.95, len(limits)) * (
            limits.upper - limits.lower
        )
        self.free = list(range(len(limits))) if free is None else free
        moving = np.zeros(len(self.rig.chain.names), dtype=np.bool_)
        for node in range(len(moving)):
            parent = self.rig.chain.parents[node]
            run = slice(self.rig.chain.dof_start[node], self.rig.chain.dof_start[node + 1])
            own = np.isin(self.rig.chain.dof_coordinate[run], self.free).any()
            moving[node] = own or (parent >= 0 and moving[parent])
        self.evaluator = Evaluator(self.rig, Side.RIGHT)
        self.tape = Tape(self.evaluator, self.rig.chain.frames(self.q), moving)

    def program(
        self, rows: list[Row], collisions: Collisions | None = None, **cost: float
    ) -> Program:
        every = np.ones(len(self.q))
        return Program(
            self.rig,
            self.q,
            self.free,
            self.tape,
            rows,
            collisions or Collisions.none(),
            Cost(
                self.rig.coordinates.idle,
                cost.get("keep", 0.0) * every,
                cost.get("comfort", 0.0) * every,
                cost.get("overlap", 0.0),
                {1: 0, 7: 3} if cost.get("keep") else {},
            ),
        )


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
    asked = {0: Demand(constraint)}
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


# Broad phase, NLopt through C, polish ----------------------------------------------------------


def everything(seed: int) -> tuple[Case, Program]:
    """A problem with every kind of term."""
    case = Case(seed)
    tape, capsules = case.tape, case.rig.capsules
    rows = [
        Row(block.MEET, tape.site(Site("I_TIP", S)), tape.point(POINTS[0]), 1e4),
        Row(block.AT_DISTANCE, tape.site(Site("PA", W)), tape.point(POINTS[2]), 1e4, 0.1),
        Row(block.MEET, tape.axis(PALM_S, BoneAxis.NRM), tape.unit(tape.vector(VECTORS[8])), 9e2),
        Row(block.MEET, tape.axis(PALM_W, BoneAxis.DIR), tape.unit(tape.vector(VECTORS[5])), 9e2),
        Row(block.PERPENDICULAR, tape.axis(HEAD, BoneAxis.DIR), tape.vector(VECTORS[7]), 9e2),
    ]
    reach = capsules.radius[capsules.pairs].sum(axis=1) + 0.02
    collisions = Collisions(capsules.pairs, reach)
    return case, case.program(rows, collisions, keep=1.0, comfort=3.0, overlap=1e4)


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


@pytest.mark.parametrize("seed", range(3))
def test_nlopt_gives_the_same_bytes_through_c_and_through_python(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    case, program = everything(seed)
    x = case.q[program.free]
    assert nlopt_backend.c_interface() is not None
    compiled = program.descend(x, max_evaluations=150, tolerance=1e-6)
    monkeypatch.setattr(nlopt_backend, "c_interface", lambda: None)
    called = program.descend(x, max_evaluations=150, tolerance=1e-6)
    assert compiled.tobytes() == called.tobytes()
    assert program(compiled, np.empty(0)) < 0.5 * program(x, np.empty(0))


@pytest.mark.parametrize("seed", range(4))
def test_polishing_ends_where_nothing_pulls_but_into_a_limit(seed: int) -> None:
    case, program = everything(seed)
    start = program.descend(case.q[program.free], max_evaluations=100, tolerance=1e-2)
    before = program(start, np.empty(0))
    x = program.polish(start, rounds=300, tolerance=1e-14)
    gradient = np.empty(len(x))
    assert program(x, gradient) <= before
    assert np.all(x >= program.lower)
    assert np.all(x <= program.upper)
    at_limit = ((x == program.lower) & (gradient > 0)) | ((x == program.upper) & (gradient < 0))
    first = np.empty(len(x))
    program(start, first)
    assert np.abs(gradient[~at_limit]).max() < 1e-3 * np.abs(first).max()


def test_polishing_a_single_coordinate_is_newton_s_method() -> None:
    """One parabola: a step or two reach its bottom to the last digits."""
    case = Case(3, [stick_body().coordinates.index["head.axial"]])
    program = case.program([], keep=2.0)
    x = program.polish(np.array([0.4]), rounds=10, tolerance=0.0)
    assert x[0] == pytest.approx(case.rig.coordinates.idle[program.free[0]], abs=1e-9)


@pytest.mark.parametrize("free", [[], [3], None], ids=["nothing", "one", "everything"])
def test_kernels_write_nowhere_but_into_their_block(
    free: list[int] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With nothing to move, matrices have no first row: a loop over it would end in the heap."""
    untouched, blocks = 4242, []
    lay_out = Layout.block

    def padded(layout: Layout) -> NDArray[np.int64]:
        whole = np.full(layout.size + 64, untouched)
        whole[: layout.size] = lay_out(layout)
        blocks.append(whole)
        return whole[: layout.size]

    monkeypatch.setattr(Layout, "block", padded)
    case = Case(5, free)
    program = case.program([], keep=2.0, comfort=1.0)
    x = case.q[program.free]
    program(x, np.empty(len(x)))
    x = program.descend(x, max_evaluations=10, tolerance=1e-6)
    program.polish(x, rounds=10, tolerance=0.0)
    (block,) = blocks
    assert np.all(block[-64:] == untouched)
