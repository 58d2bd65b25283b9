"""Constraints and geometry in words close to AZee's own, with sides bound: for reports."""

from __future__ import annotations

import math
from dataclasses import fields
from enum import Enum
from itertools import pairwise

from azee_solver.constraint import (
    BoneAxis,
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
    Bone,
    Dir,
    NamedPoint,
    Nrm,
    Opp,
    Out,
    Path,
    Point,
    Side,
    Site,
    SitePoint,
    Vec,
    Vector,
    WorldPoint,
)

_DIRECTIONS = {
    (0.0, 1.0, 0.0): "up",
    (0.0, -1.0, 0.0): "down",
    (0.0, 0.0, 1.0): "forward",
    (0.0, 0.0, -1.0): "back",
    (1.0, 0.0, 0.0): "left",
    (-1.0, 0.0, 0.0): "right",
}


def geometry(expr: Vector | Point | Path, dominant: Side) -> str:
    """Put a vector, point or path in one line."""
    match expr:
        case Vec(x, y, z):
            return _DIRECTIONS.get((x, y, z), f"vec {_numbers(x, y, z)}")
        case Out(side):
            return "left" if side.bound(dominant) is Side.LEFT else "right"
        case Dir(bone):
            return f"dir of {bone.key(dominant)}"
        case Nrm(bone):
            return f"nrm of {bone.key(dominant)}"
        case Opp(inner):
            return f"against {geometry(inner, dominant)}"
        case NamedPoint(place):
            return place.value
        case SitePoint(site):
            return site.key(dominant)
        case WorldPoint(x, y, z):
            return f"({_numbers(x, y, z)}) m"
        case _:
            operands = [_operand(getattr(expr, f.name), dominant) for f in fields(expr)]
            return f"{type(expr).__name__.lower()}({', '.join(operands)})"


def _operand(value: object, dominant: Side) -> str:
    match value:
        case Bone() | Site():
            return value.key(dominant)
        case tuple():
            return ", ".join(_operand(v, dominant) for v in value)
        case float() | int():
            return f"{value:g}"
        case Enum():
            return str(value.value)
        case _:
            return geometry(value, dominant)  # type: ignore[arg-type]


def _numbers(*values: float) -> str:
    return " ".join(f"{v:.4g}" for v in values)


def subject(constraint: Constraint, dominant: Side) -> str:
    """Name what a constraint speaks of: a site, a bone's axis, the gaze or a morph."""
    match constraint:
        case Place(site) | Transpath(site):
            return f"place {site.key(dominant)}"
        case Orient(axis, bone):
            return f"{axis.value} of {bone.key(dominant)}"
        case Look() | LookAt():
            return "gaze"
        case Morph():
            return f"morph {constraint.key(dominant)}"
        case Trill(bone) | Rotate(bone):
            return f"{type(constraint).__name__.lower()} {bone.key(dominant)}"


def target(constraint: Constraint, dominant: Side) -> str:
    """Say what a constraint wants of it."""
    match constraint:
        case Place(_, point, distance):
            where = geometry(point, dominant)
            return f"at {where}" if not distance else f"{1000 * distance:g} mm from {where}"
        case Orient(_, _, relation, vector):
            return f"{relation.value} {geometry(vector, dominant)}"
        case Look(vector):
            return f"along {geometry(vector, dominant)}"
        case LookAt(point):
            return f"at {geometry(point, dominant)}"
        case Morph(_, _, weight):
            return f"{weight:g}"
        case Rotate(_, axis, angle):
            return f"by {math.degrees(angle):g}° about {geometry(axis, dominant)}"
        case Trill(_, axis):
            return f"about {geometry(axis, dominant)}"
        case Transpath(_, path):
            return f"along {geometry(path, dominant)}"


def whole(constraint: Constraint, dominant: Side) -> str:
    """Subject and target in one phrase."""
    return f"{subject(constraint, dominant)} {target(constraint, dominant)}"


def problem(constraints: list[Constraint], dominant: Side) -> str:
    """Name of a problem: its placement, then the bones that it orients."""
    words = [whole(c, dominant) for c in constraints if isinstance(c, Place)]
    gazes = [whole(c, dominant) for c in constraints if isinstance(c, Look | LookAt)]
    turns: dict[str, list[str]] = {}
    for c in constraints:
        if isinstance(c, Orient):
            turns.setdefault(c.bone.key(dominant), []).append(_axis(c.axis))
        elif isinstance(c, Rotate):
            turns.setdefault(c.bone.key(dominant), []).append("turn")
    bones = ", ".join(f"{bone} {'+'.join(axes)}" for bone, axes in turns.items())
    return ", ".join([*words, *gazes, *([f"orient {bones}"] if bones else [])])


def _axis(axis: BoneAxis) -> str:
    return axis.value


def sentence(parts: list[str]) -> str:
    """Join parts as `a`, `a and b`, `a, b and c`."""
    if len(parts) < 2:
        return "".join(parts)
    joints = [", "] * (len(parts) - 2) + [" and "]
    return parts[0] + "".join(j + b for (_, b), j in zip(pairwise(parts), joints, strict=True))
