"""Vectors of three numbers: x to the signer's left, y up, z forward, as in AZee.

Notations speak of a right-handed signer: `r` is the side of the dominant hand. So are these
vectors. A rule is written with `out(s)` instead of left and right, so that it plays with either.
"""

from __future__ import annotations

from math import sqrt
from typing import TypeAlias

Vector: TypeAlias = tuple[float, float, float]

ZERO: Vector = (0.0, 0.0, 0.0)
TINY = 1e-6


def plus(a: Vector, b: Vector) -> Vector:
    """Return the sum."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def times(a: Vector, factor: float) -> Vector:
    """Return a multiple."""
    return a[0] * factor, a[1] * factor, a[2] * factor


def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product, right-handed."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def length(a: Vector) -> float:
    """Return the length."""
    return sqrt(dot(a, a))


def unit(a: Vector) -> Vector:
    """Return the vector of length 1 with the same direction; one without length stays."""
    size = length(a)
    return times(a, 1 / size) if size > TINY else a


def mirrored(a: Vector) -> Vector:
    """Return a direction or a place as seen in a mirror between left and right."""
    return -a[0], a[1], a[2]


def mirrored_axis(a: Vector) -> Vector:
    """Return an axis of turning as seen in that mirror: what turns in front turns back."""
    return a[0], -a[1], -a[2]


def is_close(a: Vector, b: Vector, tolerance: float = 1e-3) -> bool:
    """Whether two vectors differ by no more than a tolerance in each component."""
    return all(abs(p - q) <= tolerance for p, q in zip(a, b, strict=True))
