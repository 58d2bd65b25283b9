"""Constraints and geometry back in AZee's own notation, on one line, for people to read."""

from __future__ import annotations

import math
from typing import assert_never

from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import (
    Arc,
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
    Site,
    SitePoint,
    Straight,
    Through,
    Towards,
    Unit,
    VDiff,
    Vec,
    Vector,
    VSum,
    VTranslate,
    WorldPoint,
)

DIRECTIONS: dict[tuple[float, float, float], str] = {
    (0, 1, 0): "^up",
    (0, -1, 0): "^down",
    (0, 0, 1): "^fwd",
    (0, 0, -1): "^back",
    (1, 0, 0): "^left",
    (-1, 0, 0): "^right",
}


def constraint_text(constraint: Constraint) -> str:
    """Return a constraint as AZee writes it, such as `place @EL(s) @PA(w) 'contact`."""
    match constraint:
        case Place(site=site, point=point, distance_m=distance, contact=contact):
            options = [*(["'dist", _number(distance)] if distance else []), *["'contact"] * contact]
            return _line("place", _part(site), _point(point), *options)
        case Orient(axis, bone, relation, vector):
            words = f"'{axis.value}", _part(bone), f"'{relation.value}", _vector(vector)
            return _line("orient", *words)
        case Look(vector):
            return _line("look", _vector(vector))
        case LookAt(point):
            return _line("lookat", _point(point))
        case Morph(name, side, weight):
            return _line("morph", f"'{name}", *([side.value] if side else []), _number(weight))
        case Trill(bone, axis, frequency_hz, amplitude_rad):
            rest = f"'freq {_number(frequency_hz)} 'amp {_degrees(amplitude_rad)}"
            return _line("trill", _part(bone), _vector(axis), rest)
        case Rotate(bone, axis, angle_rad):
            return _line("rotate", _part(bone), _vector(axis), _degrees(angle_rad))
        case Transpath(site, path):
            return _line("transpath", _part(site), _path(path))
        case _:
            assert_never(constraint)


def _line(*words: str) -> str:
    return " ".join(words)


def _call(name: str, *operands: str) -> str:
    return f"{name}({', '.join(operands)})"


def _part(part: Bone | Site) -> str:
    sign = "!" if isinstance(part, Bone) else "@"
    operands = [part.side.value] if part.side else []
    operands += [str(part.phalanx)] if part.phalanx else []
    return _call(sign + part.name, *operands) if operands else sign + part.name


def _vector(vector: Vector) -> str:
    match vector:
        case Vec(x, y, z):
            known = DIRECTIONS.get((x, y, z))
            return known or _call("vec", *map(_number, (x, y, z)))
        case Out(side):
            return _call("out", side.value)
        case Dir(bone):
            return _call("dir", _part(bone))
        case Nrm(bone):
            return _call("nrm", _part(bone))
        case Opp(Out(side)):
            return _call("in", side.value)
        case Opp(of):
            return _call("oppvect", _vector(of))
        case Unit(of):
            return _call("unit", _vector(of))
        case Scale(of, factor):
            return _call("scale", _vector(of), _number(factor))
        case VSum(vectors):
            return _call("vsum", *map(_vector, vectors))
        case VDiff(left, right):
            return _call("vdiff", _vector(left), _vector(right))
        case Cross(left, right):
            return _call("cross", _vector(left), _vector(right))
        case Towards(start, end):
            return _call("towards", _point(start), _point(end))
        case Rotated(of, axis, angle_rad):
            return _call("rotated", _vector(of), _vector(axis), _degrees(angle_rad))
        case _:
            assert_never(vector)


def _point(point: Point) -> str:
    match point:
        case FreePoint(x, y, z) | WorldPoint(x, y, z):
            return _call("point", *map(_number, (x, y, z)))
        case NamedPoint(place):
            return f"^{place.value}"
        case SitePoint(site):
            return _part(site)
        case JointPoint(bone):
            return _call("joint", _part(bone))
        case VTranslate(of, vector):
            return _call("vtranslate", _point(of), _vector(vector))
        case Between(start, end, fraction):
            return _call("between", _point(start), _point(end), _number(fraction))
        case Moving(path, start, end):
            return _call("moving", _path(path), _point(start), _point(end))
        case _:
            assert_never(point)


def _path(path: Path) -> str:
    match path:
        case Straight():
            return "straight"
        case Arc(bulge):
            return _call("arc", _vector(bulge))
        case Circle(axis, radius_m, turns):
            return _call("circle", _vector(axis), _number(radius_m), _number(turns))
        case Through(points):
            return _call("through", *map(_point, points))
        case _:
            assert_never(path)


def _number(value: float) -> str:
    return f"{value:.6g}"


def _degrees(angle_rad: float) -> str:
    return _number(round(math.degrees(angle_rad), 6))
