"""An example of every member of the unions of geometry and constraints, for what reads them all.

A new member is added here, and then passes through the tests of evaluation, kernels, footprints,
solving, notation, mirror images and scores. A point made of points
comes back in `MOVING_POINTS` with each of its parts moving. Numbers are exact in binary, angles
whole degrees, so that texts give them back.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, replace
from typing import Any

from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import (
    Arc,
    Around,
    Between,
    Bone,
    Circle,
    Cross,
    Dir,
    FreePoint,
    JointPoint,
    Moving,
    NamedPoint,
    Nrm,
    Opp,
    Out,
    Path,
    Point,
    Rotated,
    Scale,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Slide,
    Straight,
    Swing,
    Through,
    Towards,
    Unit,
    VDiff,
    Vec,
    Vector,
    VSum,
    VTranslate,
    Was,
    Wave,
    WorldPoint,
    Zigzag,
)

S, W = Side.STRONG, Side.WEAK
TIP, CHIN = Site("I_TIP", S), SitePoint(Site("CH"))
UP, SLANTED = Vec(0.0, 1.0, 0.0), Vec(0.5, 1.0, 0.25)
PALM, OTHER_PALM, HEAD = Bone("palm", S), Bone("palm", W), Bone("head")
OTHER_TIP = SitePoint(Site("I_TIP", W))
RIGHT_SPACE = FreePoint(-0.25, -0.25, 0.375)

VECTORS: tuple[Vector, ...] = (
    SLANTED,
    Out(S),
    Dir(OTHER_PALM),
    Nrm(OTHER_PALM),
    Opp(Dir(HEAD)),
    Unit(SLANTED),
    Scale(Nrm(HEAD), 0.5),
    VSum((SLANTED, Dir(OTHER_PALM))),
    VDiff(SLANTED, Nrm(OTHER_PALM)),
    Cross(Nrm(HEAD), SLANTED),
    Towards(CHIN, OTHER_TIP),
    Rotated(Nrm(OTHER_PALM), SLANTED, math.radians(30)),
    Swing(SLANTED, Nrm(OTHER_PALM)),
)
MOVING = Moving(Straight(), RIGHT_SPACE, VTranslate(OTHER_TIP, Vec(0.0, 0.0, 0.1)))
POINTS: tuple[Point, ...] = (
    RIGHT_SPACE,
    NamedPoint(SigningSpace.SSSP),
    OTHER_TIP,
    JointPoint(OTHER_PALM),
    VTranslate(CHIN, Vec(0.0, -0.1, 0.2)),
    Between(OTHER_TIP, CHIN, 0.25),
    MOVING,
    WorldPoint(-0.2, 1.2, 0.3),
    Was("A", OTHER_TIP, (-0.2, 1.2, 0.3)),
)


def moving_parts(point: Point) -> Iterator[Point]:
    """Yield a point made of points once for each of them, which then moves."""
    whole: Any = point
    for field in fields(point):
        part = getattr(whole, field.name)
        if isinstance(part, Point):
            yield replace(whole, **{field.name: MOVING})
        if isinstance(part, tuple) and all(isinstance(item, Point) for item in part):
            for n in range(len(part)):
                yield replace(whole, **{field.name: (*part[:n], MOVING, *part[n + 1 :])})


MOVING_POINTS: tuple[Point, ...] = tuple(made for point in POINTS for made in moving_parts(point))
PATHS: tuple[Path, ...] = (
    Straight(),
    Arc(Scale(Nrm(OTHER_PALM), 0.125)),
    Circle(Vec(0.0, 0.0, 1.0), 0.0625, 1.25),
    Circle(Vec(0.0, 0.0, 1.0), 0.0625, 1.25, math.radians(60), 0.5, 0.125),
    Around(VTranslate(OTHER_TIP, Vec(0.0, 0.0, 0.1)), Vec(0.0, 0.0, 1.0), 1.0),
    Wave(Scale(Nrm(OTHER_PALM), 0.125), 1.5),
    Zigzag(Scale(Nrm(OTHER_PALM), 0.125), 3),
    Slide(Bone("f_arm", W), Straight()),
    Through((VTranslate(OTHER_TIP, Vec(0.0, 0.0, 0.1)),)),
)
CONSTRAINTS: tuple[Constraint, ...] = (
    Place(TIP, RIGHT_SPACE),
    Place(TIP, RIGHT_SPACE, within_m=0.0625),
    Place(TIP, RIGHT_SPACE, 0.125, within_m=0.0625),
    Orient(BoneAxis.NRM, PALM, Relation.ALONG, Opp(UP)),
    Orient(BoneAxis.NRM, PALM, Relation.ALONG, UP, math.radians(25)),
    Orient(BoneAxis.DIR, PALM, Relation.ACROSS, UP, math.radians(25)),
    Look(Vec(0.25, 0.0, 1.0)),
    LookAt(VTranslate(CHIN, Vec(0.25, 0.0, 1.0))),
    Morph("index_bend", S, 0.5),
    Morph("index_bend", S, 0.5, math.radians(30)),
    Rotate(HEAD, UP, math.radians(10)),
    Trill(PALM, UP, 5.0, math.radians(12)),
    Trill(PALM, UP, 5.0, math.radians(30), math.radians(15), math.radians(90), 2.0),
    Transpath(TIP, Arc(Vec(0.0, 0.125, 0.0))),
)


def title(value: object) -> str:
    """Name a constraint for a test by its class, and by those of its point, vector and path."""
    parts = [value]
    for name in ("point", "vector", "path"):
        parts += [inner] if (inner := getattr(parts[-1], name, None)) is not None else []
    return "-".join(type(part).__name__ for part in parts)
