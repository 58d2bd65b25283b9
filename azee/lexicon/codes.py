"""What the letters of directions mean as vectors: fingers, palms, movements, bulges of arcs."""

from __future__ import annotations

from azee.lexicon.model import Heading
from azee.lexicon.vectors import TINY, Vector, cross, dot, length, plus, times, unit

_LETTERS: dict[str, Vector] = {
    "u": (0, 1, 0),
    "d": (0, -1, 0),
    "l": (1, 0, 0),
    "r": (-1, 0, 0),
    "o": (0, 0, 1),
    "i": (0, 0, -1),
}
_PALMS = frozenset("udlr")


def is_direction(code: str) -> bool:
    """Whether a code is made of letters that do not cancel each other."""
    return bool(code) and all(c in _LETTERS for c in code) and length(_sum(code)) > TINY


def is_palm(code: str) -> bool:
    """Whether a code says how a hand is turned about its fingers: u, d, l, r and between."""
    return is_direction(code) and set(code) <= _PALMS


def _sum(code: str) -> Vector:
    total = (0.0, 0.0, 0.0)
    for letter in code:
        total = plus(total, _LETTERS[letter])
    return total


def direction(heading: Heading) -> Vector:
    """Return the unit vector of a heading; between two directions that cancel it is the first."""
    first = unit(_sum(heading.first))
    if heading.second is None:
        return first
    both = plus(first, unit(_sum(heading.second)))
    return unit(both) if length(both) > TINY else first


def palm_normal(fingers: Vector, palm: Heading) -> Vector:
    """Return where a palm looks, for fingers that point along a unit vector.

    Codes turn the hand about its fingers. `l` looks along the horizontal normal that points left;
    where the fingers point left or right themselves, it looks in or out. `u` is square to both and
    looks up; where the fingers point up it looks in, where they point down, out. (Measured on the
    engine of JASigning in 208 combinations.)
    """
    x, _, z = fingers
    across = length((x, 0, z))
    left: Vector = (z / across, 0, -x / across) if across > TINY else (1, 0, 0)
    turned = z < -TINY
    if turned:
        left = times(left, -1)
    up = cross(fingers, left)
    if turned:
        up = times(up, -1)
    axes = {"l": left, "r": times(left, -1), "u": up, "d": times(up, -1)}

    def normal(code: str) -> Vector:
        total = (0.0, 0.0, 0.0)
        for letter in code:
            total = plus(total, axes[letter])
        return unit(total)

    first = normal(palm.first)
    if palm.second is None:
        return first
    both = plus(first, normal(palm.second))
    return unit(both) if length(both) > TINY else first


def bulge(way: Vector, code: str) -> Vector:
    """Return the unit vector toward which an arc bulges: the axis of a code, squared to the way.

    Where axis and way are parallel, `u` and `r` bulge outward, `d` and `l` inward. (Measured on
    the engine of JASigning.)
    """
    axis = _LETTERS[code]
    along = dot(axis, way)
    if abs(abs(along) - 1) < TINY:
        return (0, 0, 1) if code in "ur" else (0, 0, -1)
    return unit(plus(axis, times(way, -along)))
