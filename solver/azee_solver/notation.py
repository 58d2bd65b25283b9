"""Constraints and geometry back in AZee's own notation, on one line, for people to read.

Reports, messages and drawings say with it what a text has said. Lengths are metres, angles degrees,
as texts have them; strong and weak stay what they are. Numbers keep six digits.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

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
    return " ".join(filter(None, _halves(constraint)))


def subject_text(constraint: Constraint) -> str:
    """Return its first half, its operator and what that moves: `place @EL(s)`, `look`."""
    return _halves(constraint)[0]


def target_text(constraint: Constraint) -> str:
    """Return its second half, what it asks of that: `@PA(w) 'contact`, `'along ^up`."""
    return _halves(constraint)[1]


def operator_text(constraint: Constraint) -> str:
    """Return the operator that makes such constraints: `place`."""
    return subject_text(constraint).partition(" ")[0]


def problem_text(constraints: Iterable[Constraint]) -> str:
    """Name constraints that are solved together: placements and gazes whole, others by subject.

    A placement at a point that motion code has measured, such as one on a path, has no text.
    """
    placed, gazes, turned = [], [], []
    for constraint in constraints:
        match constraint:
            case Place(point=WorldPoint()):
                placed.append(subject_text(constraint))
            case Place():
                placed.append(constraint_text(constraint))
            case Look() | LookAt():
                gazes.append(constraint_text(constraint))
            case Orient() | Morph() | Trill() | Rotate() | Transpath():
                turned.append(subject_text(constraint))
    return ", ".join([*placed, *gazes, *turned])


def _halves(constraint: Constraint) -> tuple[str, str]:
    match constraint:
        case Place(site, point, distance, contact, within):
            options = f" 'dist {number_text(distance)}" if distance else ""
            options += " 'contact" if contact else ""
            options += f" 'within {number_text(within)}" if within else ""
            return f"place {part_text(site)}", f"{point_text(point)}{options}"
        case Orient(axis, bone, vector=Swing(None)):
            return f"turning '{axis.value} {part_text(bone)}", ""
        case Orient(axis, bone, relation, vector, within):
            subject = f"orient '{axis.value} {part_text(bone)}"
            options = f" 'within {_degrees(within)}" if within else ""
            return subject, f"'{relation.value} {vector_text(vector)}{options}"
        case Look(vector):
            return "look", vector_text(vector)
        case LookAt(point):
            return "lookat", point_text(point)
        case Morph(name, side, weight, within):
            soft = f" 'soft {_degrees(within)}" if within else ""
            subject = f"morph '{name}" + (f" {side.value}" if side else "")
            return subject, f"{number_text(weight)}{soft}"
        case Trill(bone, axis, frequency_hz, amplitude_rad, back_rad, phase_rad, cycles):
            pace = "freq", frequency_hz
            if cycles is not None:
                pace = "cycles", cycles
            options = f"'{pace[0]} {number_text(pace[1])} 'amp {_degrees(amplitude_rad)}"
            options += "" if back_rad is None else f" 'back {_degrees(back_rad)}"
            options += f" 'phase {_degrees(phase_rad)}" if phase_rad else ""
            return f"trill {part_text(bone)}", f"{vector_text(axis)} {options}"
        case Rotate(bone, axis, angle_rad):
            return f"rotate {part_text(bone)}", f"{vector_text(axis)} {_degrees(angle_rad)}"
        case Transpath(site, path):
            return f"transpath {part_text(site)}", path_text(path)


def _call(name: str, *operands: str) -> str:
    return f"{name}({', '.join(operands)})"


def part_text(part: Bone | Site) -> str:
    """Return a bone or a site as AZee writes it, in a call if it takes operands."""
    sign = "!" if isinstance(part, Bone) else "@"
    operands = [part.side.value] if part.side else []
    operands += [str(part.phalanx)] if part.phalanx else []
    return _call(sign + part.name, *operands) if operands else sign + part.name


def vector_text(vector: Vector) -> str:
    """Return a vector as AZee writes it."""
    match vector:
        case Vec(x, y, z):
            known = DIRECTIONS.get((x, y, z))
            return known or _call("vec", *map(number_text, (x, y, z)))
        case Out(side):
            return _call("out", side.value)
        case Dir(bone):
            return _call("dir", part_text(bone))
        case Nrm(bone):
            return _call("nrm", part_text(bone))
        case Opp(Out(side)):
            return _call("in", side.value)
        case Opp(of):
            return _call("oppvect", vector_text(of))
        case Unit(of):
            return _call("unit", vector_text(of))
        case Scale(of, factor):
            return _call("scale", vector_text(of), number_text(factor))
        case VSum(vectors):
            return _call("vsum", *map(vector_text, vectors))
        case VDiff(left, right):
            return _call("vdiff", vector_text(left), vector_text(right))
        case Cross(left, right):
            return _call("cross", vector_text(left), vector_text(right))
        case Towards(start, end):
            return _call("towards", point_text(start), point_text(end))
        case Rotated(of, axis, angle_rad):
            return _call("rotated", vector_text(of), vector_text(axis), _degrees(angle_rad))
        case Swing(start, end):
            return _call("swing", *(vector_text(v) for v in (start, end) if v is not None))


def point_text(point: Point) -> str:
    """Return a point as AZee writes it; `world-point` is no operator, for no text makes one."""
    match point:
        case FreePoint(x, y, z):
            return _call("point", *map(number_text, (x, y, z)))
        case WorldPoint(x, y, z):
            return _call("world-point", *map(number_text, (x, y, z)))
        case NamedPoint(place):
            return f"^{place.value}"
        case SitePoint(site):
            return part_text(site)
        case JointPoint(bone):
            return _call("joint", part_text(bone))
        case VTranslate(of, vector):
            return _call("vtranslate", point_text(of), vector_text(vector))
        case Between(start, end, fraction):
            return _call("between", point_text(start), point_text(end), number_text(fraction))
        case Was(block, of):
            return _call("was", f"'{block}", point_text(of))
        case Moving(path, start, end):
            return _call("moving", path_text(path), point_text(start), point_text(end))


def path_text(path: Path) -> str:
    """Return a path as AZee writes it."""
    match path:
        case Straight():
            return "straight"
        case Arc(bulge):
            return _call("arc", vector_text(bulge))
        case Circle(axis, radius_m, turns, phase_rad, ratio, end_radius_m):
            ends = [radius_m] if end_radius_m is None else [radius_m, end_radius_m]
            options = [f"'phase = {_degrees(phase_rad)}"] if phase_rad else []
            options += [f"'ratio = {number_text(ratio)}"] if ratio != 1.0 else []
            name = "circle" if end_radius_m is None else "spiral"
            numbers = map(number_text, (*ends, turns))
            return _call(name, vector_text(axis), *numbers, *options)
        case Around(centre, axis, turns):
            return _call("around", point_text(centre), vector_text(axis), number_text(turns))
        case Wave(side, waves):
            return _call("wave", vector_text(side), number_text(waves))
        case Zigzag(side, corners):
            return _call("zigzag", vector_text(side), number_text(corners))
        case Slide(bone, inner):
            return _call("slide", part_text(bone), path_text(inner))
        case Through(points):
            return _call("through", *map(point_text, points))


def number_text(value: float) -> str:
    """Return a number with six digits at the most."""
    return f"{value:.6g}"


def _degrees(angle_rad: float) -> str:
    return number_text(round(math.degrees(angle_rad), 6))
