"""Vectors whose numbers a text gives, without a body: enough to see which have no length."""

from __future__ import annotations

import math
from typing import TypeAlias

from azee_solver.geometry import (
    Cross,
    Dir,
    Nrm,
    Opp,
    Out,
    Rotated,
    Scale,
    Side,
    Swing,
    Towards,
    Unit,
    VDiff,
    Vec,
    Vector,
    VSum,
)

Numbers: TypeAlias = tuple[float, float, float]

TINY = 1e-9
"""A vector that is no longer has no direction; the solver draws the line at the same length."""
_ZERO: Numbers = (0.0, 0.0, 0.0)


def is_zero(vector: Vector, dominant: Side) -> bool:
    """Whether a vector is known to have no length, whatever body plays it."""
    found = known(vector, dominant)
    return found is not None and math.hypot(*found) <= TINY


def known(vector: Vector, dominant: Side) -> Numbers | None:
    """Return a vector in the signer's frame; None where only a posture gives it its numbers.

    A vector without direction has none either: what is made of it is no mistake of its own.
    """
    match vector:
        case Vec(x, y, z):
            return (x, y, z)
        case Out(side):
            return (1.0 if side.bound(dominant) is Side.LEFT else -1.0, 0.0, 0.0)
        case Dir() | Nrm():
            return None
        case Opp(inner):
            return _scaled(known(inner, dominant), -1.0)
        case Unit(inner):
            found = known(inner, dominant)
            length = 0.0 if found is None else math.hypot(*found)
            return _scaled(found, 1.0 / length) if length else None
        case Scale(inner, factor):
            return _ZERO if factor == 0.0 else _scaled(known(inner, dominant), factor)
        case VSum(vectors):
            total: Numbers | None = _ZERO
            for inner in vectors:
                total = _plus(total, known(inner, dominant))
            return total
        case VDiff(left, right):
            if left == right:
                return _ZERO
            return _plus(known(left, dominant), _scaled(known(right, dominant), -1.0))
        case Cross(left, right):
            return _ZERO if left == right else _cross(known(left, dominant), known(right, dominant))
        case Towards(start, end):
            return _ZERO if start == end else None
        case Rotated(inner, _, _):
            return _ZERO if is_zero(inner, dominant) else None
        case Swing():
            return None


def _scaled(vector: Numbers | None, factor: float) -> Numbers | None:
    if vector is None:
        return None
    return (factor * vector[0], factor * vector[1], factor * vector[2])


def _plus(a: Numbers | None, b: Numbers | None) -> Numbers | None:
    return None if a is None or b is None else (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def _cross(a: Numbers | None, b: Numbers | None) -> Numbers | None:
    if a is None or b is None:
        return None
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
