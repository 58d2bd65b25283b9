"""Problems of all kinds on the stick body, laid out for the kernels, about random postures."""

from __future__ import annotations

import numpy as np
from stick_body import stick_body

from azee_rig.rig import Rig
from azee_solver import block
from azee_solver.broadphase import Collisions
from azee_solver.constraint import (
    BoneAxis,
)
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
from azee_solver.program import Cost, Program, Row
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


def everything(seed: int, free: list[int] | None = None) -> tuple[Case, Program]:
    """A problem with every kind of term."""
    case = Case(seed, free)
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
