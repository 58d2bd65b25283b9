"""What a joint's name says about it: part of the body, side, finger.

Names come in families, `mixamorig:LeftForeArm`, `lowerarm_l`, `DEF-forearm.L.001`,
`J_Bip_L_LowerArm`, `lowerarm01.L`, `Bip01 L Finger12`, `leftLowerArm`, but their words are few. A
name is cut into words, sides and prefixes are taken off, and what is left is looked up.
"""

from __future__ import annotations

import re
from dataclasses import dataclass


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|\d+")
_SIDES = {"l": "L", "left": "L", "lf": "L", "lft": "L", "r": "R", "right": "R", "rt": "R"}
_PREFIXES = _words(
    """armature rig def org mixamorig bip biped cc base valve valvebiped j jnt joint bone skel
    skeleton character sk c adj sec human root"""
)
_ENDS = _words("end nub tip top effector site leaf")
_TWISTS = _words("twist roll share")
_NOT_BONES = _words(
    """ik fk pole target ctrl control helper mch weapon prop socket attach camera brow lid lash
    jaw lip tongue teeth hair breast bust skirt cloth ear cheek nose chin mouth"""
)
_FILLERS = _words("finger fingers f proximal intermediate distal prox inter dist")
_METACARPAL = _words("metacarpal meta carpal inhand palm metacarpals mc cmc")
_ORDINALS = {
    "first": "thumb", "second": "index", "third": "middle", "fourth": "ring", "fifth": "little"
}  # fmt: skip
_SEGMENTS = _words("mc pp mp dp cmc mcp pip dip tip")
"""What stands beside an ordinal where it counts fingers, as in Xsens' `LeftSecondPP`."""
_UPPER, _FORE = re.compile(r"(?<![A-Za-z])([LR])UArm"), re.compile(r"(?<![A-Za-z])([LR])FArm")
"""OptiTrack Motive's arms; `LF` is elsewhere a left side."""
DIGITS = {
    "thumb": "thumb",
    "index": "index",
    "pointer": "index",
    "middle": "middle",
    "mid": "middle",
    "ring": "ring",
    "pinky": "little",
    "pinkie": "little",
    "pink": "little",
    "little": "little",
    "small": "little",
}
KINDS = {
    "pelvis": "pelvis hips hip cog hipscontrol",
    "spine": """spine chest upperchest lowerchest torso lowerback upperback lowback back abdomen
        waist thorax ribcage ribs stomach ab spinelower spineupper spinemid belly""",
    "neck": "neck lowerneck upperneck necklower neckupper",
    "head": "head skull",
    "clav": "clavicle collar collarbone clav scapula",
    "shoulder": "shoulder",
    "arm": "arm upperarm uparm armupper humerus upper",
    "f_arm": "forearm lowerarm elbow armlower lowarm loarm radius fore",
    "palm": "hand wrist",
    "eye": "eye eyeball",
    "thigh": "thigh upleg upperleg legupper femur hipjoint",
    "calf": "calf leg lowerleg shin knee loleg leglower",
    "foot": "foot ankle",
    "toe": "toe toes toebase ball toebase",
}
_KIND_OF = {word: kind for kind, words in KINDS.items() for word in words.split()}


@dataclass(frozen=True, slots=True)
class Reading:
    """What a name says.

    kind: a key of `KINDS`, `digit`, `finger` (numbered, not named) or "" where it says nothing.
    side: L, R or "". digit: of a digit its name, of a finger its number. end: it marks where a
    bone ends. twist: it shares a limb's turn. metacarpal: it lies inside the palm.
    """

    kind: str = ""
    side: str = ""
    digit: str = ""
    end: bool = False
    twist: bool = False
    metacarpal: bool = False


def read_name(name: str) -> Reading:
    """Read the name of a joint."""
    name = _FORE.sub(r"\1 ForeArm", _UPPER.sub(r"\1 UpperArm", re.split(r"[:|/]", name)[-1]))
    words = [w.lower() for w in _WORD.findall(name)]
    words = [part for word in words for part in _split(word)]
    sides = [_SIDES[w] for w in words if w in _SIDES]
    side = sides[0] if sides else ""
    plain = [w for w in words if w not in _SIDES and w not in _PREFIXES and not w.isdigit()]
    at = next((i for i, w in enumerate(words) if w in ("finger", "fingers")), len(words))
    numbers = [w for w in words[at:] if w.isdigit()]
    if any(w in _NOT_BONES for w in plain):
        return Reading(side=side)
    end = any(w in _ENDS for w in plain)
    twist = any(w in _TWISTS for w in plain)
    plain = [w for w in plain if w not in _ENDS and w not in _TWISTS]
    digit = next((DIGITS[w] for w in plain if w in DIGITS), "")
    if not digit and _SEGMENTS & set(words):
        digit = next((_ORDINALS[w] for w in plain if w in _ORDINALS), "")
    if digit and not any(w in ("toe", "foot") for w in plain):
        inside = bool(set(plain) & _METACARPAL) or "in" in plain
        return Reading("digit", side, digit, end, twist, inside)
    if numbers and "base" not in words:
        return Reading("finger", side, numbers[0][0], end, twist)
    key = "".join(w for w in plain if w not in _FILLERS)
    return Reading(_KIND_OF.get(key, ""), side, "", end, twist)


def _split(word: str) -> list[str]:
    """Take a side off a word that is written together with it, such as `lhand`."""
    for side in ("left", "right", "l", "r"):
        rest = word.removeprefix(side)
        if rest != word and (rest in _KIND_OF or rest in DIGITS):
            return [side, rest]
    return [word]
