"""Which site of a hand a notated part of it is."""

from __future__ import annotations

from azee.lexicon.model import DIGITS, HandPart, HandShape
from azee.lexicon.places import Site
from azee.lexicon.vectors import Vector, cross, dot

FINGER = dict(zip(DIGITS, "TIMRL", strict=True))
"""The letter of a digit in the names of sites."""
_WHOLE = {
    "palm": "PA",
    "handback": "H_BACK",
    "pinkyside": "H_EDGE",
    "thumbball": "T_BALL",
    "wristback": "WR",
    "lowerarm": "F_ARM",
    "elbow": "EL",
    "elbowinside": "ELi",
    "upperarm": "ARM",
}
_INNER = ("palmar", "front")
_OUTER = ("dorsal", "back")
_PHALANX = {"base": 1, "midjoint": 2, "side": 2}
_CLEAR = 0.3
"""How much of a direction must be sideways for left and right of a finger to be clear."""


def site_of(
    part: HandPart,
    hand: str,
    fingers: Vector | None,
    palm: Vector | None,
    shape: HandShape | None = None,
) -> Site:
    """Return the site of a part of one hand.

    Left and right of a finger depend on how the hand is held: `fingers` and `palm` are the
    directions of its fingers and of its palm. shape: a thumb that lies along the index is the
    thumb's side of the hand.
    """
    digit = _middle_digit(part.digits)
    if digit:
        return _of_digit(FINGER[digit], part, hand, _thumb_side(part.side, hand, fingers, palm))
    match part.part:
        case "thumbside":
            return Site("T_BACK", hand, 2) if _thumb_is_beside(shape) else Site("I_KNt", hand, 1)
        case "palm" if part.side in _OUTER:
            return Site("H_BACK", hand)
        case "wristback" if part.side in _INNER:
            return Site("WRi", hand)
        case "tip" | "pad" | "nail" | "midjoint" | "base" | "side":
            sideways = _thumb_side(part.side, hand, fingers, palm)
            return _of_digit("I", part, hand, sideways)
        case None:
            return Site("H_BACK" if part.side in _OUTER else "PA", hand)
        case name:
            return Site(_WHOLE[name], hand)


def usual_site(shape: HandShape | None, hand: str, *, touches: bool) -> Site:
    """Return what is meant where no part of the hand is said: the palm, or a tip that touches."""
    base = "flat" if shape is None else shape.form.base
    if touches and base not in ("flat", "fist", "finger2345"):
        return Site("I_TIP", hand)
    return Site("PA", hand)


def _thumb_is_beside(shape: HandShape | None) -> bool:
    """Whether the thumb lies along the index, as it does where nothing else is said of it."""
    return shape is not None and shape.form.base in ("flat", "fist") and shape.form.thumb is None


def _middle_digit(digits: str) -> str:
    """Return one digit for several: the middle one of three, the first of two."""
    return digits[len(digits) // 2] if len(digits) > 2 else digits[:1]


def _thumb_side(
    side: str | None, hand: str, fingers: Vector | None, palm: Vector | None
) -> bool | None:
    """Whether a side is that of the thumb; None where no side of a finger is said or it is open."""
    if side in ("radial", "ulnar"):
        return side == "radial"
    if side is None or side in (*_INNER, *_OUTER):
        return None
    if fingers is None or palm is None:
        return True
    towards_thumb = cross(fingers, palm)
    right = dot(towards_thumb, (-1, 0, 0)) * (1 if hand == "s" else -1)
    if abs(right) < _CLEAR:
        return True
    return (right > 0) == side.startswith("right")


def _of_digit(letter: str, part: HandPart, hand: str, thumb_side: bool | None) -> Site:
    if part.part in (None, "tip"):
        return Site(f"{letter}_TIP", hand)
    if part.part in _PHALANX:
        return _of_joint(letter, _PHALANX[part.part], part, hand, thumb_side)
    if thumb_side is None:
        inner = part.part == "pad" or part.side in _INNER
        return Site(f"{letter}_{'PAD' if inner else 'NA'}", hand)
    if letter == "I" and not thumb_side:
        return Site("I_KNl", hand, 3)
    if letter == "T":
        return Site("T_KNt" if thumb_side else "T_l", hand, 3 if thumb_side else 2)
    return Site(f"{letter}_{'t' if thumb_side else 'l'}", hand, 3)


def _of_joint(
    letter: str, phalanx: int, part: HandPart, hand: str, thumb_side: bool | None
) -> Site:
    if part.part == "side" and thumb_side is None:
        return Site("T_l" if letter == "T" else f"{letter}_t", hand, 2)
    if thumb_side is None:
        if letter == "T" and part.side in _INNER:
            return Site("T_INT", hand, phalanx)
        return Site(f"{letter}_{'KNi' if part.side in _INNER else 'KN'}", hand, phalanx)
    if letter in "MR":
        return Site(f"{letter}_{'t' if thumb_side else 'l'}", hand, phalanx)
    return Site(f"{letter}_{'KNt' if thumb_side else 'KNl'}", hand, phalanx)
