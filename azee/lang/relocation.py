"""Moves what a score does to another place: its points in space, not the sites of the body."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from azee.lang.known_vector import is_zero
from azee.lang.reflection import Change
from azee_solver.geometry import (
    Between,
    FreePoint,
    JointPoint,
    Moving,
    NamedPoint,
    Opp,
    Point,
    Side,
    SigningSpace,
    SitePoint,
    Vector,
    VSum,
    VTranslate,
    WorldPoint,
)


@dataclass
class Relocation(Change):
    """Moves points in space by a vector, in metres of the reference signer.

    The addressee, sites and joints stay, and so does what is measured from them. A point that was
    moved before by the opposite vector gets its first form again: there and back is nowhere.
    """

    vector: Vector
    moved: int = field(default=0, init=False)
    """How many points have got the vector."""

    def node(self, node: Any) -> Any:
        """Return a part of a constraint with its points in space moved."""
        if isinstance(node, Point):
            return self.point(node)
        return Change.node(self, node)

    def point(self, point: Point) -> Point:
        """Return a point moved, or what it is made of."""
        match point:
            case NamedPoint(SigningSpace.ADDRESSEE) | SitePoint() | JointPoint():
                return point
            case VTranslate(FreePoint() | NamedPoint() | WorldPoint() as inner, vector) if (
                inner != NamedPoint(SigningSpace.ADDRESSEE) and _opposite(vector, self.vector)
            ):
                return inner
            case FreePoint() | NamedPoint() | WorldPoint():
                self.moved += 1
                return VTranslate(point, self.vector)
            case VTranslate() | Between() | Moving():
                changed: Point = self.rebuilt(point)
                return changed


def _opposite(one: Vector, other: Vector) -> bool:
    if one == Opp(other) or other == Opp(one):
        return True
    both = VSum((one, other))
    return is_zero(both, Side.LEFT) and is_zero(both, Side.RIGHT)
