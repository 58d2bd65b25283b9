"""What a joint's name says about it: part of the body, side, finger.

Names come in families, `mixamorig:LeftForeArm`, `lowerarm_l`, `DEF-forearm.L.001`,
`J_Bip_L_LowerArm`, `lowerarm01.L`, `Bip01 L Finger12`, `leftLowerArm`, `LFArm`, but their words
are few. A name is cut into words, sides and prefixes are taken off, and what is left is looked up.
A prefix that nobody has heard of, such as its owner's name, is told by most joints' having it.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


COMMON, NEARLY_ALL = 0.6, 0.95
"""Share of a skeleton's joints that begin, or end, with the same word if it says nothing; and if
it is a bone's or a side's."""
FEW = 6
"""In a skeleton of fewer joints nothing is common."""
_LETTER_SIDE = re.compile(r"(?<![A-Z])([LR])(?=[A-Z]?[A-Z][a-z])")
_ORDINALS = {"first": "1", "second": "2", "third": "3", "fourth": "4", "fifth": "5"}
_PHALANGES = _words("mc pp mp dp cmc mcp pip dip")
_WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|\d+")
_SIDES = {"l": "L", "left": "L", "lf": "L", "lft": "L", "r": "R", "right": "R", "rt": "R"}
_PREFIXES = _words(
    """armature rig def org mixamorig bip biped cc base valve valvebiped j jnt joint bone skel
    skeleton character sk c adj sec human root bind skin bn smplhf smplx"""
)
_ENDS = _words("end nub tip top effector site leaf")
_TWISTS = _words("twist roll share")
_NOT_BONES = _words(
    """ik fk pole target ctrl control helper mch weapon prop socket attach camera brow lid lash
    jaw lip tongue teeth hair breast bust skirt cloth ear cheek nose chin mouth"""
)
_FILLERS = _words("finger fingers f proximal intermediate distal prox inter dist")
_METACARPAL = _words("metacarpal meta carpal inhand palm metacarpals mc cmc")
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
    "arm": "arm upperarm uparm uarm armupper humerus upper",
    "f_arm": "forearm farm lowerarm elbow armlower lowarm loarm radius fore",
    "palm": "hand wrist",
    "eye": "eye eyeball faceeye",
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


def read_names(names: Sequence[str]) -> list[Reading]:
    """Read a skeleton's names: a word that most of them begin or end with says nothing."""
    shared = _alike(min(names), max(names)) if len(names) >= FEW else 0
    words = [_cut(name[shared:]) for name in names]
    for end in (0, -1):
        while (common := _common([w[end] for w in words if len(w) > 1], len(words))) is not None:
            for w in words:
                if len(w) > 1 and w[end] == common:
                    del w[end]
    return [_read(w) for w in words]


def _alike(first: str, last: str) -> int:
    """Return how many letters two names begin with in common."""
    pairs = enumerate(zip(first, last, strict=False))
    return next((i for i, (a, b) in pairs if a != b), min(len(first), len(last)))


def read_name(name: str) -> Reading:
    """Read the name of a single joint."""
    return _read(_cut(name))


def _common(words: Sequence[str], joints: int) -> str | None:
    """Return the word that most joints share, if there is one."""
    if not words or joints < FEW:
        return None
    word, count = Counter(words).most_common(1)[0]
    known = word in {*_SIDES, *_KIND_OF, *DIGITS, *_ORDINALS, *_FILLERS}
    return word if count >= (NEARLY_ALL if known else COMMON) * joints else None


def _cut(name: str) -> list[str]:
    """Cut a name into words in small letters; a side that is one letter before a word is one."""
    tail = _LETTER_SIDE.sub(r" \1 ", re.split(r"[:|/]", name)[-1])
    words = [w.lower() for w in _WORD.findall(tail)]
    words = [part for word in words for part in _split(word)]
    joined: list[str] = []
    for word in words:
        if word == "arm" and joined[-1:] in (["u"], ["f"]):
            word = f"{joined.pop()}{word}"
        joined.append(word)
    return joined


def _read(words: Sequence[str]) -> Reading:
    sides = [_SIDES[w] for w in words if w in _SIDES]
    side = sides[0] if sides else ""
    plain = [w for w in words if w not in _SIDES and w not in _PREFIXES and not w.isdigit()]
    at = next((i for i, w in enumerate(words) if w in ("finger", "fingers")), len(words))
    numbers = [w for w in words[at:] if w.isdigit()]
    if any(w in _PHALANGES for w in plain):
        numbers += [_ORDINALS[w] for w in plain if w in _ORDINALS]
    if any(w in _NOT_BONES for w in plain):
        return Reading(side=side)
    end = any(w in _ENDS for w in plain)
    twist = any(w in _TWISTS for w in plain)
    plain = [w for w in plain if w not in _ENDS and w not in _TWISTS]
    digit = next((DIGITS[w] for w in plain if w in DIGITS), "")
    inside = bool(set(plain) & _METACARPAL) or "in" in plain
    if digit and not any(w in ("toe", "foot") for w in plain):
        return Reading("digit", side, digit, end, twist, inside)
    if numbers and "base" not in words:
        return Reading("finger", side, numbers[0][0], end, twist, inside)
    kind = _KIND_OF.get("".join(w for w in plain if w not in _FILLERS), "")
    # A hip with a side is where a leg begins, not the pelvis.
    return Reading("thigh" if kind == "pelvis" and side else kind, side, "", end, twist)


def _split(word: str) -> list[str]:
    """Take a side off a word that is written together with it, such as `lhand`."""
    for side in ("left", "right", "l", "r"):
        rest = word.removeprefix(side)
        if rest != word and (rest in _KIND_OF or rest in DIGITS):
            return [side, rest]
    return [word]
