"""Paths of sites and points. They stay symbolic: only a posture gives them coordinates."""

from __future__ import annotations

import math

from azee.lang.geometric import BONE, builds, geometric, number, point, vector
from azee.lang.machine import Machine
from azee.lang.native import Occurrence, Operand, Option
from azee.lang.values import Kind, ListValue, PointValue, SiteValue, Value
from azee_solver.geometry import (
    Arc,
    Around,
    Bone,
    Circle,
    Path,
    Point,
    SitePoint,
    Slide,
    Straight,
    Through,
    Vector,
    Wave,
    Zigzag,
)

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


_TURNS = Operand("turns", "how many", (Kind.NUMBER,), optional=True)
_RING = (
    Option(
        "phase",
        "degrees beyond the highest point at which it starts: 30 for each hour of a clock whose "
        "hands go round the axis",
        number("phase", "degrees"),
        0.0,
    ),
    Option("ratio", "its height over its width, for an ellipse", number("ratio", "height"), 1.0),
)

OPERATORS = (
    geometric("straight", "The straight path.", (), Kind.PATH, builds(Straight), "straight"),
    geometric(
        "arc",
        "A circular arc that bulges along a vector by the length of the vector.",
        (vector("bulge"),),
        Kind.PATH,
        builds(Arc),
        "arc vec(0, .05, 0)",
    ),
    geometric(
        "arc-vect",
        "The published name of `arc`.",
        (vector("bulge"),),
        Kind.PATH,
        builds(Arc),
        "arc-vect vec(0, .05, 0)",
        only_name_published=True,
    ),
    geometric(
        "circle",
        "Turns about an axis, one unless said, right-handed, on the way from start to end.",
        (
            vector("axis"),
            number("radius", "metres of the reference signer"),
            _TURNS,
        ),
        Kind.PATH,
        _circle,
        "circle ^fwd .05 2 'phase 90",
        options=_RING,
    ),
    geometric(
        "spiral",
        "A circle whose radius changes evenly on the way.",
        (
            vector("axis"),
            number("radius", "metres of the reference signer at the start"),
            number("last", "the same at the end"),
            _TURNS,
        ),
        Kind.PATH,
        _spiral,
        "spiral ^fwd .02 .08 3",
        options=_RING,
    ),
    geometric(
        "around",
        "About a point, right-handed about the axis, as far from it as start and end are. The "
        "turn is the one from start to end that is nearest to so many, one unless said.",
        (point("centre", "the centre"), vector("axis"), _TURNS),
        Kind.PATH,
        builds(_around),
        "around ^Mssp ^fwd .5",
    ),
    geometric(
        "wave",
        "To and fro along a vector, to either side by its length, so many times on the way.",
        (vector("side"), Operand("number", "how many", (Kind.NUMBER,), optional=True)),
        Kind.PATH,
        _wave,
        "wave (scale ^up .03) 2",
    ),
    geometric(
        "zigzag",
        "With corners on either side of the way by turns, two unless said, first to that of the "
        "vector and by its length. The site nearly stops at each.",
        (vector("side"), Operand("number", "how many corners", (Kind.NUMBER,), optional=True)),
        Kind.PATH,
        _zigzag,
        "zigzag (scale ^up .04) 5",
    ),
    geometric(
        "slide",
        "A path, the straight one unless said, laid on the skin of a part of the body. The site "
        "touches that part all the way.",
        (BONE, Operand("path", "a path", (Kind.PATH,), optional=True)),
        Kind.PATH,
        builds(_slide),
        "slide !f_arm(w)",
    ),
    geometric(
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
