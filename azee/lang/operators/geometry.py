"""Vectors and points. All stay symbolic: only a posture gives them coordinates."""

from __future__ import annotations

import math

from azee.lang.geometric import BONE, builds, geometric, number, point, vector
from azee.lang.native import Operand
from azee.lang.values import Kind
from azee_solver.geometry import (
    Between,
    Cross,
    Dir,
    FreePoint,
    JointPoint,
    Moving,
    Nrm,
    Opp,
    Out,
    Rotated,
    Scale,
    Swing,
    Towards,
    Unit,
    VDiff,
    Vec,
    Vector,
    VSum,
    VTranslate,
    Was,
)

_SIDE = Operand("side", "s, w, L or R", (Kind.SIDE,))


def _rotated(vector: Vector, axis: Vector, angle_deg: float) -> Vector:
    return Rotated(vector, axis, math.radians(angle_deg))


_XYZ = (
    number("x", "metres to the signer's left"),
    number("y", "metres up"),
    number("z", "metres forward"),
)

OPERATORS = (
    geometric(
        "vec",
        "A vector in the signer's frame.",
        _XYZ,
        Kind.VECTOR,
        builds(Vec),
        "vec 0 .1 0",
        only_name_published=True,
    ),
    geometric(
        "dir",
        "The direction of a bone in the posture, from its proximal to its distal end.",
        (BONE,),
        Kind.VECTOR,
        builds(Dir),
        "dir !f_arm(s)",
        published=True,
    ),
    geometric(
        "nrm",
        "The normal of a bone in the posture; a hand's points out of its palm.",
        (BONE,),
        Kind.VECTOR,
        builds(Nrm),
        "nrm !palm(s)",
        published=True,
    ),
    geometric(
        "oppvect",
        "The opposite vector.",
        (vector(),),
        Kind.VECTOR,
        builds(Opp),
        "oppvect (nrm !palm(s))",
        published=True,
    ),
    geometric(
        "out",
        "Away from the middle of the body, towards a side.",
        (_SIDE,),
        Kind.VECTOR,
        builds(Out),
        "out s",
    ),
    geometric(
        "in",
        "From a side towards the middle.",
        (_SIDE,),
        Kind.VECTOR,
        builds(lambda side: Opp(Out(side))),
        "in s",
    ),
    geometric(
        "unit",
        "The same direction, of length one.",
        (vector(),),
        Kind.VECTOR,
        builds(Unit),
        "unit vec(1, 1, 0)",
    ),
    geometric(
        "scale",
        "A vector times a number.",
        (vector(), number("factor", "a number")),
        Kind.VECTOR,
        builds(Scale),
        "scale ^up .1",
    ),
    geometric(
        "vsum",
        "The sum of vectors.",
        (Operand("vector", "a vector", (Kind.VECTOR,), rest=True, least=1),),
        Kind.VECTOR,
        builds(VSum),
        "vsum ^up ^fwd",
    ),
    geometric(
        "vdiff",
        "The first vector minus the second.",
        (vector("left"), vector("right")),
        Kind.VECTOR,
        builds(VDiff),
        "vdiff ^up ^fwd",
    ),
    geometric(
        "cross",
        "The cross product: square to both, right-handed.",
        (vector("left"), vector("right")),
        Kind.VECTOR,
        builds(Cross),
        "cross ^left ^up",
    ),
    geometric(
        "towards",
        "The unit vector from one point to another.",
        (point("start"), point("end")),
        Kind.VECTOR,
        builds(Towards),
        "towards @NO ^addressee",
    ),
    geometric(
        "rotated",
        "A vector turned about an axis, right-handed, by degrees.",
        (vector(), vector("axis"), number("angle", "degrees")),
        Kind.VECTOR,
        builds(_rotated),
        "rotated ^fwd ^up 30",
    ),
    geometric(
        "swing",
        "A dynamic direction: on the shorter arc from one to another while its block lasts.",
        (vector("start"), vector("end")),
        Kind.VECTOR,
        builds(Swing),
        "swing ^up ^fwd",
    ),
    geometric(
        "was",
        "Where a point was when another block ended: one beside the block in which this stands, "
        "or beside one around it.",
        (Operand("block", "the block's name", (Kind.SYMBOL,)), point()),
        Kind.POINT,
        builds(Was),
        "was 'P1 @WR(s)",
    ),
    geometric(
        "point",
        "A point in metres of a reference signer, from the middle of the shoulder line; "
        "scaled by arm length to the body that plays.",
        _XYZ,
        Kind.POINT,
        builds(FreePoint),
        "point 0 -.2 .3",
    ),
    geometric(
        "vtranslate",
        "A point moved by a vector, in metres of the reference signer.",
        (point(), vector()),
        Kind.POINT,
        builds(VTranslate),
        "vtranslate ^Mssp (scale ^up .1)",
        published=True,
    ),
    geometric(
        "between",
        "A point between two, at a fraction of the way.",
        (point("start"), point("end"), number("fraction", "0 is the start, 1 the end")),
        Kind.POINT,
        builds(Between),
        "between @CH @FH .3",
    ),
    geometric(
        "midpoint",
        "The point halfway between two.",
        (point("start"), point("end")),
        Kind.POINT,
        builds(lambda start, end: Between(start, end, 0.5)),
        "midpoint @CK(L) @CK(R)",
    ),
    geometric(
        "joint",
        "The proximal end of a bone: where it is hinged.",
        (BONE,),
        Kind.POINT,
        builds(JointPoint),
        "joint !f_arm(s)",
    ),
    geometric(
        "moving",
        "A dynamic point: on the path from one point to another while its block lasts.",
        (
            Operand("path", "a path", (Kind.PATH,)),
            point("start"),
            point("end"),
        ),
        Kind.POINT,
        builds(Moving),
        "moving straight ^Rssp ^Lssp",
    ),
)
