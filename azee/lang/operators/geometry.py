"""Vectors, points and paths. All stay symbolic: only a posture gives them coordinates."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from azee.lang.native import Group, Native, Occurrence, Operand
from azee.lang.values import Kind
from azee_solver.geometry import (
    Arc,
    Between,
    Circle,
    Cross,
    Dir,
    FreePoint,
    JointPoint,
    Moving,
    Nrm,
    Opp,
    Out,
    Path,
    Rotated,
    Scale,
    Straight,
    Through,
    Towards,
    Unit,
    VDiff,
    Vec,
    Vector,
    VSum,
    VTranslate,
)


def _number(name: str, meaning: str) -> Operand:
    return Operand(name, meaning, (Kind.NUMBER,))


def _vector(name: str = "vector", meaning: str = "a vector") -> Operand:
    return Operand(name, meaning, (Kind.VECTOR,))


def _point(name: str = "point", meaning: str = "a point") -> Operand:
    return Operand(name, meaning, (Kind.POINT,))


_BONE = Operand("bone", "such as `!palm(s)`", (Kind.BONE,))
_SIDE = Operand("side", "s, w, L or R", (Kind.SIDE,))


def _builds(node: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function of an operator that puts its operands into a node, and no more."""
    return lambda at, *operands: node(*operands)


def _rotated(vector: Vector, axis: Vector, angle_deg: float) -> Vector:
    return Rotated(vector, axis, math.radians(angle_deg))


def _circle(at: Occurrence, axis: Vector, radius_m: float, turns: float = 1.0) -> Path:
    if radius_m <= 0:
        raise at.fault("number-range", "the radius of a circle is greater than 0", "radius")
    return Circle(axis, radius_m, turns)


def _native(
    name: str,
    meaning: str,
    operands: tuple[Operand, ...],
    result: Kind,
    function: Callable[..., Any],
    example: str,
    *,
    published: bool = False,
    only_name_published: bool = False,
) -> Native:
    return Native(
        name,
        Group.GEOMETRY,
        meaning,
        operands,
        result=result,
        function=function,
        example=example,
        published=published,
        only_name_published=only_name_published,
    )


_XYZ = (
    _number("x", "metres to the signer's left"),
    _number("y", "metres up"),
    _number("z", "metres forward"),
)

OPERATORS = (
    _native(
        "vec",
        "A vector in the signer's frame.",
        _XYZ,
        Kind.VECTOR,
        _builds(Vec),
        "vec 0 .1 0",
        only_name_published=True,
    ),
    _native(
        "dir",
        "The direction of a bone in the posture, from its proximal to its distal end.",
        (_BONE,),
        Kind.VECTOR,
        _builds(Dir),
        "dir !f_arm(s)",
        published=True,
    ),
    _native(
        "nrm",
        "The normal of a bone in the posture; a hand's points out of its palm.",
        (_BONE,),
        Kind.VECTOR,
        _builds(Nrm),
        "nrm !palm(s)",
        published=True,
    ),
    _native(
        "oppvect",
        "The opposite vector.",
        (_vector(),),
        Kind.VECTOR,
        _builds(Opp),
        "oppvect (nrm !palm(s))",
        published=True,
    ),
    _native(
        "out",
        "Away from the middle of the body, towards a side.",
        (_SIDE,),
        Kind.VECTOR,
        _builds(Out),
        "out s",
    ),
    _native(
        "in",
        "From a side towards the middle.",
        (_SIDE,),
        Kind.VECTOR,
        _builds(lambda side: Opp(Out(side))),
        "in s",
    ),
    _native(
        "unit",
        "The same direction, of length one.",
        (_vector(),),
        Kind.VECTOR,
        _builds(Unit),
        "unit vec(1, 1, 0)",
    ),
    _native(
        "scale",
        "A vector times a number.",
        (_vector(), _number("factor", "a number")),
        Kind.VECTOR,
        _builds(Scale),
        "scale ^up .1",
    ),
    _native(
        "vsum",
        "The sum of vectors.",
        (Operand("vector", "a vector", (Kind.VECTOR,), rest=True, least=1),),
        Kind.VECTOR,
        _builds(VSum),
        "vsum ^up ^fwd",
    ),
    _native(
        "vdiff",
        "The first vector minus the second.",
        (_vector("left"), _vector("right")),
        Kind.VECTOR,
        _builds(VDiff),
        "vdiff ^up ^fwd",
    ),
    _native(
        "cross",
        "The cross product: square to both, right-handed.",
        (_vector("left"), _vector("right")),
        Kind.VECTOR,
        _builds(Cross),
        "cross ^left ^up",
    ),
    _native(
        "towards",
        "The unit vector from one point to another.",
        (_point("start"), _point("end")),
        Kind.VECTOR,
        _builds(Towards),
        "towards @NO ^addressee",
    ),
    _native(
        "rotated",
        "A vector turned about an axis, right-handed, by degrees.",
        (_vector(), _vector("axis"), _number("angle", "degrees")),
        Kind.VECTOR,
        _builds(_rotated),
        "rotated ^fwd ^up 30",
    ),
    _native(
        "point",
        "A point in metres of a reference signer, from the middle of the shoulder line; "
        "scaled by arm length to the body that plays.",
        _XYZ,
        Kind.POINT,
        _builds(FreePoint),
        "point 0 -.2 .3",
    ),
    _native(
        "vtranslate",
        "A point moved by a vector, in metres of the reference signer.",
        (_point(), _vector()),
        Kind.POINT,
        _builds(VTranslate),
        "vtranslate ^Mssp (scale ^up .1)",
        published=True,
    ),
    _native(
        "between",
        "A point between two, at a fraction of the way.",
        (_point("start"), _point("end"), _number("fraction", "0 is the start, 1 the end")),
        Kind.POINT,
        _builds(Between),
        "between @CH @FH .3",
    ),
    _native(
        "midpoint",
        "The point halfway between two.",
        (_point("start"), _point("end")),
        Kind.POINT,
        _builds(lambda start, end: Between(start, end, 0.5)),
        "midpoint @CK(L) @CK(R)",
    ),
    _native(
        "joint",
        "The proximal end of a bone: where it is hinged.",
        (_BONE,),
        Kind.POINT,
        _builds(JointPoint),
        "joint !f_arm(s)",
    ),
    _native(
        "moving",
        "A dynamic point: on the path from one point to another while its block lasts.",
        (
            Operand("path", "a path", (Kind.PATH,)),
            _point("start"),
            _point("end"),
        ),
        Kind.POINT,
        _builds(Moving),
        "moving straight ^Rssp ^Lssp",
    ),
    _native("straight", "The straight path.", (), Kind.PATH, _builds(Straight), "straight"),
    _native(
        "arc",
        "A circular arc that bulges along a vector by the length of the vector.",
        (_vector("bulge"),),
        Kind.PATH,
        _builds(Arc),
        "arc vec(0, .05, 0)",
    ),
    _native(
        "arc-vect",
        "The published name of `arc`.",
        (_vector("bulge"),),
        Kind.PATH,
        _builds(Arc),
        "arc-vect vec(0, .05, 0)",
        only_name_published=True,
    ),
    _native(
        "circle",
        "Turns about an axis, one unless said, right-handed, on the way from start to end.",
        (
            _vector("axis"),
            _number("radius", "metres of the reference signer"),
            Operand("turns", "how many", (Kind.NUMBER,), optional=True),
        ),
        Kind.PATH,
        _circle,
        "circle ^fwd .05 2",
    ),
    _native(
        "through",
        "A centripetal Catmull–Rom curve through points.",
        (Operand("point", "a point", (Kind.POINT,), rest=True, least=1),),
        Kind.PATH,
        _builds(Through),
        "through ^Rssp ^Mssp ^Lssp",
    ),
)
