"""Vectors, points and paths. All stay symbolic: only a posture gives them coordinates."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from azee.lang.machine import Machine
from azee.lang.native import Group, Native, Occurrence, Operand, Option
from azee.lang.values import Kind, ListValue, PointValue, SiteValue, Value
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
    Nrm,
    Opp,
    Out,
    Path,
    Point,
    Rotated,
    Scale,
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
    Zigzag,
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


_RATIO = "the ratio of height and width of a circle is greater than 0"


def _circle(
    at: Occurrence,
    axis: Vector,
    radius_m: float,
    turns: float = 1.0,
    *,
    phase: float,
    ratio: float,
) -> Path:
    if radius_m <= 0:
        raise at.fault("number-range", "the radius of a circle is greater than 0", "radius")
    if ratio <= 0:
        raise at.fault("number-range", _RATIO, "ratio")
    return Circle(axis, radius_m, turns, math.radians(phase), ratio)


def _spiral(
    at: Occurrence,
    axis: Vector,
    radius_m: float,
    last_m: float,
    turns: float = 1.0,
    *,
    phase: float,
    ratio: float,
) -> Path:
    if min(radius_m, last_m) < 0 or not max(radius_m, last_m):
        message = "the radii of a spiral are 0 or more, and one of them is greater"
        raise at.fault("number-range", message, "radius")
    if ratio <= 0:
        raise at.fault("number-range", _RATIO, "ratio")
    return Circle(axis, radius_m, turns, math.radians(phase), ratio, last_m)


def _around(centre: Point, axis: Vector, turns: float = 1.0) -> Path:
    return Around(centre, axis, turns)


def _wave(at: Occurrence, side: Vector, waves: float = 1.0) -> Path:
    if waves <= 0:
        raise at.fault("number-range", "there are more than 0 waves", "number")
    return Wave(side, waves)


MOST_CORNERS = 1000
"""More corners on one way than any body shows."""


def _zigzag(at: Occurrence, side: Vector, corners: float = 2.0) -> Path:
    if not (corners == int(corners) and 1 <= corners <= MOST_CORNERS):
        message = f"the corners of a zigzag are a whole number from 1 to {MOST_CORNERS}"
        raise at.fault("number-range", message, "number")
    return Zigzag(side, int(corners))


def _slide(bone: Bone, path: Path = Straight()) -> Path:  # noqa: B008 - it is frozen
    return Slide(bone, path)


def _through(at: Occurrence, machine: Machine, values: tuple[Value, ...]) -> Path:
    points: list[Point] = []
    for i, value in enumerate(values):
        for item in value.content if isinstance(value, ListValue) else (value,):
            machine.spend(1, at.span)
            if isinstance(item, SiteValue):
                points.append(SitePoint(item.content))
            elif isinstance(item, PointValue):
                points.append(item.content)
            else:
                message = f"`through` wants points, not {item.kind.value}"
                label = f"this holds {item.kind.value}"
                raise at.fault("wrong-type", message, "point", i, label=label)
    if not points:
        raise at.fault("number-range", "`through` wants at least one point")
    return Through(tuple(points))


def _native(
    name: str,
    meaning: str,
    operands: tuple[Operand, ...],
    result: Kind,
    function: Callable[..., Any],
    example: str,
    *,
    options: tuple[Option, ...] = (),
    uses_machine: bool = False,
    published: bool = False,
    only_name_published: bool = False,
) -> Native:
    return Native(
        name,
        Group.GEOMETRY,
        meaning,
        operands,
        options,
        uses_machine=uses_machine,
        result=result,
        function=function,
        example=example,
        published=published,
        only_name_published=only_name_published,
    )


_TURNS = Operand("turns", "how many", (Kind.NUMBER,), optional=True)
_RING = (
    Option(
        "phase",
        "degrees beyond the highest point at which it starts: 30 for each hour of a clock whose "
        "hands go round the axis",
        _number("phase", "degrees"),
        0.0,
    ),
    Option("ratio", "its height over its width, for an ellipse", _number("ratio", "height"), 1.0),
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
        "swing",
        "A dynamic direction: on the shorter arc from one to another while its block lasts.",
        (_vector("start"), _vector("end")),
        Kind.VECTOR,
        _builds(Swing),
        "swing ^up ^fwd",
    ),
    _native(
        "was",
        "Where a point was when another block ended: one beside the block in which this stands, "
        "or beside one around it.",
        (Operand("block", "the block's name", (Kind.SYMBOL,)), _point()),
        Kind.POINT,
        _builds(Was),
        "was 'P1 @WR(s)",
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
            _TURNS,
        ),
        Kind.PATH,
        _circle,
        "circle ^fwd .05 2 'phase 90",
        options=_RING,
    ),
    _native(
        "spiral",
        "A circle whose radius changes evenly on the way.",
        (
            _vector("axis"),
            _number("radius", "metres of the reference signer at the start"),
            _number("last", "the same at the end"),
            _TURNS,
        ),
        Kind.PATH,
        _spiral,
        "spiral ^fwd .02 .08 3",
        options=_RING,
    ),
    _native(
        "around",
        "About a point, right-handed about the axis, as far from it as start and end are. The "
        "turn is the one from start to end that is nearest to so many, one unless said.",
        (_point("centre", "the centre"), _vector("axis"), _TURNS),
        Kind.PATH,
        _builds(_around),
        "around ^Mssp ^fwd .5",
    ),
    _native(
        "wave",
        "To and fro along a vector, to either side by its length, so many times on the way.",
        (_vector("side"), Operand("number", "how many", (Kind.NUMBER,), optional=True)),
        Kind.PATH,
        _wave,
        "wave (scale ^up .03) 2",
    ),
    _native(
        "zigzag",
        "With corners on either side of the way by turns, two unless said, first to that of the "
        "vector and by its length. The site nearly stops at each.",
        (_vector("side"), Operand("number", "how many corners", (Kind.NUMBER,), optional=True)),
        Kind.PATH,
        _zigzag,
        "zigzag (scale ^up .04) 5",
    ),
    _native(
        "slide",
        "A path, the straight one unless said, laid on the skin of a part of the body. The site "
        "touches that part all the way.",
        (_BONE, Operand("path", "a path", (Kind.PATH,), optional=True)),
        Kind.PATH,
        _builds(_slide),
        "slide !f_arm(w)",
    ),
    _native(
        "through",
        "A centripetal Catmull–Rom curve through points, or through those of a list.",
        (
            Operand(
                "point",
                "points or lists of them",
                (Kind.POINT, Kind.LIST),
                rest=True,
                least=1,
                raw=True,
            ),
        ),
        Kind.PATH,
        _through,
        "through ^Rssp ^Mssp ^Lssp",
        uses_machine=True,
    ),
)
