"""The sign tree, written by hand: the constraints of Nunnari et al. 2018, figure 5."""

from __future__ import annotations

from fractions import Fraction

from azee_solver.constraint import BoneAxis, Constraint, Orient, Place, Relation
from azee_solver.geometry import (
    Bone,
    Dir,
    FreePoint,
    Out,
    Point,
    Side,
    Site,
    SitePoint,
    Vec,
    Vector,
)
from azee_solver.task import Task

S, W = Side.STRONG, Side.WEAK
UP = Vec(0.0, 1.0, 0.0)
DIR, NRM = BoneAxis.DIR, BoneAxis.NRM
FINGERS = ("index", "middle", "ring", "little")
BESIDE_THE_FACE = FreePoint(-0.14, -0.24, 0.25)
"""For a right-handed signer: there the upright hand hides little of the face."""


def along(axis: BoneAxis, bone: Bone, vector: Vector) -> Orient:
    return Orient(axis, bone, Relation.ALONG, vector)


def tasks(*constraints: Constraint) -> list[Task]:
    return [Task(c, ("SIGN",), Fraction(0), i) for i, c in enumerate(constraints)]


def straight_fingers(side: Side) -> list[Constraint]:
    out: list[Constraint] = []
    for finger in FINGERS:
        first, second = Bone(finger, side, 1), Bone(finger, side, 2)
        out += [along(DIR, first, Dir(Bone("palm", side))), along(DIR, second, Dir(first))]
    return out


def tree(point: Point = BESIDE_THE_FACE, *, thumb: bool = False) -> list[Task]:
    forearm, palm = Bone("f_arm", S), Bone("palm", S)
    constraints: list[Constraint] = [
        Place(Site("H_BACK", W), point),
        along(NRM, Bone("palm", W), UP),
        along(DIR, Bone("palm", W), Dir(Bone("f_arm", W))),
        Place(Site("EL", S), SitePoint(Site("PA", W)), contact=True),
        along(DIR, forearm, UP),
        along(DIR, palm, UP),
    ]
    if thumb:
        constraints += [
            along(DIR, Bone("thumb", S, 3), Out(S)),
            along(NRM, Bone("thumb", S, 2), UP),
        ]
    return tasks(*constraints, *straight_fingers(S))
