"""Names that are visible in every text: directions, places around the signer, sides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from azee.lang.values import PointValue, SideValue, Value, VectorValue
from azee_solver.geometry import NamedPoint, Side, SigningSpace, Vec


@dataclass(frozen=True, slots=True)
class NamedConstant:
    """`^name`, unless a parameter of that name shadows it."""

    name: str
    value: Value
    meaning: str
    published: bool


def _vector(name: str, x: float, y: float, z: float, meaning: str) -> NamedConstant:
    return NamedConstant(name, VectorValue(Vec(x, y, z)), meaning, published=name == "up")


def _point(place: SigningSpace, meaning: str, published: bool) -> NamedConstant:
    return NamedConstant(place.value, PointValue(NamedPoint(place)), meaning, published)


def _side(side: Side, meaning: str) -> NamedConstant:
    return NamedConstant(side.value, SideValue(side), meaning, published=False)


CONSTANTS: Mapping[str, NamedConstant] = {
    constant.name: constant
    for constant in (
        _vector("up", 0, 1, 0, "upwards"),
        _vector("down", 0, -1, 0, "downwards"),
        _vector("fwd", 0, 0, 1, "forwards, away from the signer"),
        _vector("back", 0, 0, -1, "backwards"),
        _vector("left", 1, 0, 0, "to the signer's left"),
        _vector("right", -1, 0, 0, "to the signer's right"),
        _point(SigningSpace.MSSP, "the middle of the signing space", published=True),
        _point(SigningSpace.RSSP, "its right side", published=True),
        _point(SigningSpace.LSSP, "its left side", published=True),
        _point(SigningSpace.SSSP, "its strong side", published=False),
        _point(SigningSpace.WSSP, "its weak side", published=False),
        _point(SigningSpace.ADDRESSEE, "where the addressee is", published=True),
        _side(Side.STRONG, "the strong side: that of the signer's dominant hand"),
        _side(Side.WEAK, "the weak side"),
        _side(Side.LEFT, "the left side"),
        _side(Side.RIGHT, "the right side"),
    )
}
