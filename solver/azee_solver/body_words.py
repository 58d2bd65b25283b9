"""Bones, joints and capsules of a body in plain English, for what is said about a posture.

A text's author knows the right forearm and degrees of pronation, not `f_arm_R.pronation`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

_NAME = re.compile(r"(?P<part>[a-z]+(?:_[a-z]+)*?)(?:_(?P<side>[LR]))?(?:_(?P<rest>[a-z]+|\d+))?")
_SIDES = {"L": "left ", "R": "right "}
_ORDINALS = {"1": "first", "2": "second", "3": "third"}

_FINGERS = {
    "thumb": "thumb",
    "index": "index finger",
    "middle": "middle finger",
    "ring": "ring finger",
    "little": "little finger",
}
_PARTS = {
    "arm": "upper arm",
    "back": "back",
    "clav": "clavicle",
    "collar": "collar",
    "elbow": "elbow",
    "eye": "eye",
    "f_arm": "forearm",
    "face": "face",
    "forearm": "forearm",
    "hand": "hand",
    "head": "head",
    "jaw": "jaw",
    "neck": "neck",
    "palm": "hand",
    "shoulder": "shoulder",
    "skull": "head",
    "trunk": "trunk",
    "upper_arm": "upper arm",
    **_FINGERS,
}
"""By the first words of AZee's bone names and of the names of capsules."""
_BACKS = {"1": "lower ", "2": "upper "}

_MOVEMENTS = {
    "abduction": ("move", "of abduction", "of adduction"),
    "axial": ("turn", "to the left", "to the right"),
    "deviation": ("bend", "to the thumb", "away from the thumb"),
    "elevation": ("move", "of elevation", "of depression"),
    "flexion": ("bend", "of flexion", "of extension"),
    "lateral": ("bend", "to the left", "to the right"),
    "pitch": ("turn", "up", "down"),
    "pronation": ("turn", "of pronation", "of supination"),
    "protraction": ("move", "of protraction", "of retraction"),
    "roll": ("turn", "towards the palm", "away from the palm"),
    "rotation": ("turn", "inward", "outward"),
    "yaw": ("turn", "to the left", "to the right"),
}
"""By the last word of a coordinate: what the bone does, and where to when it grows or shrinks."""


def bone_words(name: str) -> str:
    """Return what a bone is called: `the right forearm` for `f_arm_R`.

    A phalanx is called by the joint that turns it: `the second joint of the left index finger`.
    """
    part, side, rest = _split(name)
    if part in _FINGERS and rest in _ORDINALS:
        return f"the {_ORDINALS[rest]} joint of the {side}{_FINGERS[part]}"
    level = _BACKS.get(rest, "") if part == "back" else ""
    return f"the {side}{level}{_part(part)}"


def capsule_words(name: str) -> str:
    """Return what a capsule holds: `the left hand` for `hand_L_radial`."""
    part, side, _ = _split(name)
    return f"the {side}{_part(part)}"


def limit_words(name: str, limit_rad: float, *, upper: bool, more_rad: float) -> str:
    """Say that a coordinate is at its upper or lower limit, and by how much that is too little.

    A lower limit above zero is as much flexion, not extension below zero; what is beyond it is
    less flexion. So it is with upper limits below zero.

    Args: more_rad: how far beyond the limit it would have to go, above zero.
    """
    bone, _, movement = name.partition(".")
    verb, up, down = _MOVEMENTS.get(movement, ("move", f"of {movement}", f"of {movement}"))
    degrees = round(math.degrees(limit_rad))
    beyond_zero = degrees < 0 if upper else degrees > 0
    further, more = ("less", "less") if beyond_zero else ("further", "more")
    return (
        f"{bone_words(bone)} cannot {verb} {further}: it is at {abs(degrees)}° "
        f"{up if upper != beyond_zero else down} and needs {math.degrees(more_rad):.1f}° {more}"
    )


def listed(parts: Sequence[str]) -> str:
    """Join parts as `a`, `a and b`, `a, b and c`."""
    if len(parts) < 2:
        return "".join(parts)
    return f"{', '.join(parts[:-1])} and {parts[-1]}"


def _split(name: str) -> tuple[str, str, str]:
    """Return the part, its side as a word with a space, and what follows: a number or a word."""
    found = _NAME.fullmatch(name)
    if found is None:
        return name, "", ""
    return found["part"], _SIDES.get(found["side"], ""), found["rest"] or ""


def _part(part: str) -> str:
    return _PARTS.get(part, part.replace("_", " "))
