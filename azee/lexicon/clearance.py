"""Keeps hands before the body that a movement towards the signer would lead into it.

Notations tell where a movement goes, not where the body is in the way. Metres are those of the
reference signer, from the middle between the shoulders.
"""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, degrees, inf, radians, sin

from azee.lexicon.hands import Hand
from azee.lexicon.model import HandShape
from azee.lexicon.phrase import CircleWay
from azee.lexicon.places import Place, Site
from azee.lexicon.vectors import ZERO, Vector, cross, dot, plus, times, unit

SKIN_M = 0.01
"""How far before the body a hand ends."""
LEAST_CIRCLE = 0.4
"""Of its size that a circle keeps which is made smaller to stay before the body."""
_FRONTS = (
    (0.36, 0.12, 0.12, 0.12, 0.09),
    (0.12, 0.03, 0.06, 0.10, 0.09),
    (0.03, -0.20, 0.10, 0.13, 0.19),
    (-0.20, -0.50, 0.13, 0.13, 0.17),
)
"""Head, neck, chest and belly: heights of the upper and the lower end, how far forward the skin is
at both, and half the width."""
_SITES: dict[str, Vector] = {
    "ST": (0.069, -0.01, 0.10),
    "ABST": (0.068, -0.20, 0.13),
    "AB": (0.068, -0.33, 0.125),
    "NK": (0.05, 0.10, 0.06),
    "CH": (0.0, 0.15, 0.12),
    "CHu": (0.0, 0.13, 0.10),
    "MO": (0.0, 0.18, 0.13),
    "NO": (0.0, 0.21, 0.14),
    "NSP": (0.0, 0.20, 0.14),
    "EYE": (0.03, 0.24, 0.115),
    "EB": (0.03, 0.265, 0.12),
    "EBe": (0.045, 0.265, 0.11),
    "FH": (0.03, 0.295, 0.115),
    "TE": (0.063, 0.255, 0.065),
    "CB": (0.06, 0.22, 0.09),
    "CDL": (0.02, 0.175, 0.12),
    "CK": (0.04, 0.21, 0.11),
    "EAR": (0.075, 0.23, 0.03),
    "LOBE": (0.075, 0.20, 0.03),
}
"""Where sites of the body are, on its left."""
_ENDS = ("TIP", "PAD", "NA")
_THUMB_M = 0.07
_FINGERS_M, _BENT_M, _FIST_M = 0.128, 0.09, 0.06
"""How far digits reach beyond the middle of the palm: a thumb; fingers, straight, bent, closed."""
_WRIST_M, _BACK_M = 0.06, 0.03
"""How far from the middle of the palm the wrist and the back of the hand are."""


def cleared(hand: Hand, before: Hand | None = None) -> Hand:
    """Return a hand that touches nothing, moved forward until it is before the body.

    Args: before: the hand before the movement. One that turns on its way is led by its palm.
    """
    place, fingers, palm = hand.place, hand.pointing, hand.facing
    if place is None or place.touches or fingers is None or palm is None:
        return hand
    where = _where(place)
    if where is None:
        return hand
    reach_m = _reach_m(hand.shape)
    led_m = _led_by_m(hand.site, reach_m) * fingers[2]
    if before is not None and before.pointing not in (None, fingers) and _came_from(before, place):
        beyond_m = _led_by_m(before.site, _reach_m(before.shape))
        where, led_m = plus(where, times(before.pointing, -beyond_m)), 0.0
    front_m = _front_m(where)
    if front_m is None:
        return hand
    skin_m = SKIN_M
    if place.origin is not None and place.origin.touches:
        skin_m = 0.0  # it slides over the skin
    behind_m = max(-reach_m * fingers[2], _WRIST_M * fingers[2], 0.0) + _BACK_M * max(palm[2], 0.0)
    lacking_m = front_m + skin_m + behind_m - where[2] + led_m
    return replace(hand, place=_forward(place, lacking_m)) if lacking_m > 0 else hand


def circle_before_body(way: CircleWay, hand: Hand, *, is_start_told: bool = False) -> CircleWay:
    """Return a circle that does not lead into the body: it starts where it is nearest to it.

    So is a circle on the chest, from contact to contact. Where a notation tells the start, a circle
    in space is made smaller instead, to no less than `LEAST_CIRCLE`. One that would not lead into
    the body stays as it is.
    """
    place = hand.place
    where = None if place is None else _where(place)
    if place is None or where is None:
        return way
    nearest = _rearmost(way)
    step = plus(_on_circle(way, nearest), times(_on_circle(way, way.phase), -1))
    if step[2] > -SKIN_M:
        return way
    front_m = _front_m(plus(where, step))
    room_m = inf if front_m is None else where[2] - front_m - _BACK_M
    if room_m >= -step[2] and not place.touches:
        return way
    if not is_start_told:
        return replace(way, phase=nearest)
    share = 1.0 if place.touches else max(room_m / -step[2], LEAST_CIRCLE)
    return replace(way, radius_m=way.radius_m * share)


def _rearmost(way: CircleWay) -> int:
    """Return how many degrees beyond its top a circle is nearest to the signer."""
    top, beside = _spokes(way)
    return round(degrees(atan2(-beside[2], -top[2]))) % 360


def _on_circle(way: CircleWay, phase: int) -> Vector:
    """Return where a circle is, so many degrees beyond its top, from its middle, in metres."""
    top, beside = _spokes(way)
    angle = radians(phase)
    return plus(times(top, cos(angle)), times(beside, sin(angle)))


def _spokes(way: CircleWay) -> tuple[Vector, Vector]:
    """Return the ways from a circle's middle to its top and to a quarter beyond, in metres.

    The top is the highest point; of a level circle, the one farthest in front (as in `circle`).
    """
    axis = unit(way.axis)
    highest: Vector = (0, 0, 1) if abs(axis[1]) > 1 - 1e-6 else (0, 1, 0)
    top = unit(plus(highest, times(axis, -dot(axis, highest))))
    radius_m = way.radius_m
    return times(top, radius_m * way.ratio), times(cross(axis, top), radius_m)


def _came_from(before: Hand, place: Place) -> bool:
    """Whether a hand moved on to a place from where it was."""
    return before.place is not None and place.way_from(before.place) not in (None, ZERO)


def _led_by_m(site: Site | None, reach_m: float) -> float:
    """Return how far beyond the middle of the palm the site is that is placed."""
    if site is None or site.name.rpartition("_")[2] not in _ENDS:
        return 0.0
    return _THUMB_M if site.name.startswith("T_") else reach_m


def _where(place: Place) -> Vector | None:
    """Return where a place is; None at sites that move by themselves, or behind."""
    if any(site.name not in _SITES for site in place.sites):
        return None
    where = place.offset
    for site in place.sites:
        x, y, z = _SITES[site.name]
        side = {"s": -1, "w": 1, None: 0}[site.hand]
        where = plus(where, times((x * side, y, z), 1 / len(place.sites)))
    return where


def _front_m(where: Vector) -> float | None:
    """Return how far forward the body's skin is there; None above, below and beside it."""
    for top_m, low_m, front_m, lower_m, half_m in _FRONTS:
        if low_m <= where[1] <= top_m and abs(where[0]) <= half_m:
            share = (top_m - where[1]) / (top_m - low_m)
            return front_m + share * (lower_m - front_m)
    return None


def _reach_m(shape: HandShape | None) -> float:
    if shape is None or shape.form.base in ("flat", "finger2", "finger23", "finger23spread"):
        return _FINGERS_M if shape is None or shape.form.bend is None else _BENT_M
    return {"fist": _FIST_M, "finger2345": _FINGERS_M}.get(shape.form.base, _BENT_M)


def _forward(place: Place, by_m: float) -> Place:
    step: Vector = (0, 0, by_m)
    way = plus(place.way, step) if place.origin is not None else place.way
    return replace(place, offset=plus(place.offset, step), way=way)
