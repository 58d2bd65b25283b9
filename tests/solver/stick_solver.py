"""Moments solved on the body of sticks, and what is read from the result."""

from __future__ import annotations

import math
from dataclasses import replace

from stick_body import stick_body
from tree_sign import S, tasks

from azee_rig.rig import Rig
from azee_solver.constraint import (
    Constraint,
)
from azee_solver.geometry import (
    Bone,
    NamedPoint,
    Side,
    SigningSpace,
    Vec,
)
from azee_solver.options import SolveOptions
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport

RIG = stick_body()
IDLE = RIG.coordinates.idle
MSSP = NamedPoint(SigningSpace.MSSP)
FORWARD = Vec(0.0, 0.0, 1.0)
PALM, FOREARM = Bone("palm", S), Bone("f_arm", S)


def run(*constraints: Constraint, rig: Rig = RIG, **choices: object) -> SolveReport:
    options = replace(SolveOptions(), **choices)  # type: ignore[arg-type]
    return solve(
        rig,
        tasks(*constraints),
        dominant=Side.RIGHT,
        start=IDLE,
        reference=IDLE,
        options=options,
    )


def value(report: SolveReport, name: str) -> float:
    return math.degrees(report.coordinates[RIG.coordinates.index[name]])


def reason(report: SolveReport, i: int = 0) -> str:
    found = report.constraints[i].reason
    assert found is not None
    return found
