"""What a sign of gestural SiGML says of its first and last posture, read without `azee.lexicon`.

Only what needs no model of movement: where fingers point, where the palm looks, where the hand is
at the start, and the directions at the end where one target says them. Formulas are written anew
from docs/lexicon.md; vectors are x to the signer's left, y up, z forward, of a right-handed signer.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET  # trusted files of our own
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from benchmarks.lexicon_touch import Touch

Array = NDArray[np.float64]

LETTERS = {
    "u": (0, 1, 0),
    "d": (0, -1, 0),
    "l": (1, 0, 0),
    "r": (-1, 0, 0),
    "o": (0, 0, 1),
    "i": (0, 0, -1),
}
UP = np.array([0.0, 1.0, 0.0])
MIRROR = np.array([-1.0, 1.0, 1.0])

FORWARD = {"close": 0.54, None: 0.69, "armextended": 0.83}
AT = {"close": 0.25, None: 0.29, "armextended": 0.34}
BESIDE = {"close": 0.51, None: 0.57, "armextended": 0.65}
HEIGHT = {
    "headtop": 0.69,
    "head": 0.41,
    "neck": 0.13,
    "shouldertop": 0.08,
    "shoulders": 0.0,
    "chest": -0.25,
    "stomach": -0.50,
    "belowstomach": -0.66,
}
"""In arms of the signer, shoulder to wrist."""
FACE_SITES = {
    "forehead": ("FH", "FH_L", "FH_R"),
    "eyebrows": ("EB_L", "EB_R", "EBi_L", "EBi_R"),
    "eyes": ("EYE_L", "EYE_R"),
    "nose": ("NO", "NO_L", "NO_R"),
    "nostrils": ("NSP",),
    "ear": ("EAR_L", "EAR_R"),
    "earlobe": ("LOBE_L", "LOBE_R"),
    "cheek": ("CK_L", "CK_R"),
    "lips": ("MO", "MO_L", "MO_R"),
    "chin": ("CH", "CH_L", "CH_R"),
    "neck": ("NK", "NK_L", "NK_R"),
}
"""Sites of the body of which a hand that touches there should touch one."""
SKIN_SITES = FACE_SITES | {
    "forehead": ("FH", "FH_L", "FH_R", "TE_L", "TE_R"),
    "eyes": ("EYE_L", "EYE_R", "CB_L", "CB_R"),
    "lips": ("MO", "MO_L", "MO_R", "CDL_L", "CDL_R"),
    "uppereyelid": ("EYE_L", "EYE_R"),
    "lowereyelid": ("EYE_L", "EYE_R"),
    "upperlip": ("MO", "MO_L", "MO_R"),
    "lowerlip": ("MO", "MO_L", "MO_R"),
    "underchin": ("CH", "CH_L", "CH_R", "NK"),
    "headtop": ("HEAD", "HEAD_L", "HEAD_R"),
    "head": ("FH", "TE_L", "TE_R", "HEAD_L", "HEAD_R"),
    "shouldertop": ("SH_L", "SH_R"),
    "shoulders": ("ST", "ST_L", "ST_R"),
    "chest": ("ST", "ST_L", "ST_R", "ABST", "ABST_L", "ABST_R"),
    "stomach": ("ABST", "ABST_L", "ABST_R"),
    "belowstomach": ("AB", "AB_L", "AB_R"),
}
"""Sites about which the skin of a part of the body is, and of what is beside it."""
FACE_RADIUS_M, TRUNK_RADIUS_M = 0.03, 0.08
"""How far about its sites the skin of a part of the face reaches, and that of the trunk."""
BODY_BONES = ("head", "neck", "back_1", "back_2", "clav_L", "clav_R", "arm_L", "arm_R")
HAND_BONES = ("palm", "thumb", "index", "middle", "ring", "little")
OWN_BONES = {
    "palm": ("palm",),
    "handback": ("palm",),
    "thumbside": ("palm", "index", "thumb"),
    "pinkyside": ("palm", "little"),
    "thumbball": ("palm", "thumb"),
    "wristback": ("palm", "f_arm"),
    "lowerarm": ("f_arm",),
}
"""Bones whose skin is a part of the hand."""


@dataclass
class Hand:
    """What is said of one hand; None is nothing."""

    fingers: Array | None = None
    palm: Array | None = None
    place: Array | None = None
    """Of the palm, in arms from the middle of the shoulder line; NaN where nothing is said."""
    touched: tuple[str, ...] = ()
    touch: Touch | None = None


@dataclass
class Posture:
    """Both hands, s and w; only those that are spoken of. sides: which of the body's they are."""

    hands: dict[str, Hand] = field(default_factory=dict)
    sides: dict[str, str] = field(default_factory=lambda: {"s": "R", "w": "L"})

    def mirrored(self) -> Posture:
        """Return the posture of a left-handed signer."""

        def seen(vector: Array | None) -> Array | None:
            return None if vector is None else vector * MIRROR

        hands = {
            name: Hand(seen(h.fingers), seen(h.palm), seen(h.place), h.touched, h.touch)
            for name, h in self.hands.items()
        }
        return Posture(hands, {"s": "L", "w": "R"})


def unit(vector: Array) -> Array:
    """Return the unit vector."""
    size = np.linalg.norm(vector)
    return np.asarray(vector / size if size > 1e-9 else vector)


def direction(first: str, second: str | None = None) -> Array:
    """Return the unit vector of a code, or the one halfway between two."""
    one = unit(sum((np.array(LETTERS[c], float) for c in first), np.zeros(3)))
    if not second:
        return one
    both = one + direction(second)
    return unit(both) if np.linalg.norm(both) > 1e-6 else one


def palm(fingers: Array, first: str, second: str | None = None) -> Array:
    """Return where the palm looks: up and left, projected square to the fingers."""
    level = np.array([fingers[2], 0.0, -fingers[0]])
    left = unit(level) if np.linalg.norm(level) > 1e-6 else np.array([1.0, 0.0, 0.0])
    if left[0] < -1e-9:
        left = -left
    over = UP - fingers.dot(UP) * fingers
    if np.linalg.norm(over) > 1e-6:
        upward = unit(over)
    else:
        upward = np.array([0.0, 0.0, -1.0 if fingers[1] > 0 else 1.0])
    known = {"u": upward, "d": -upward, "l": left, "r": -left}
    one = unit(sum((known[c] for c in first), np.zeros(3)))
    if not second:
        return one
    both = one + unit(sum((known[c] for c in second), np.zeros(3)))
    return unit(both) if np.linalg.norm(both) > 1e-6 else one


class Reader:
    """Reads one sign with a single part; `start` and `end` are its postures."""

    def __init__(self, text: bytes) -> None:
        root = ET.fromstring(text)
        manual = root.find(".//sign_manual")
        assert manual is not None
        self.is_simple = manual.find("sign_manual") is None
        self._manual = manual
        self._both = manual.get("both_hands") == "true"
        self._flip = np.array(
            [
                -1.0 if manual.get("lr_symm") == "true" else 1.0,
                -1.0 if manual.get("ud_symm") == "true" else 1.0,
                -1.0 if manual.get("oi_symm") == "true" else 1.0,
            ]
        )
        self._codes: dict[str, dict[str, tuple[str, str | None]]] = {"s": {}, "w": {}}

    @property
    def _named(self) -> tuple[str, ...]:
        if self._both:
            return ("s", "w")
        return ("w",) if self._manual.get("nondominant") == "true" else ("s",)

    def start(self) -> Posture:
        """Read the posture at the start."""
        for element in self._manual:
            self._take(element)
        found = self._oriented()
        locations = [e for e in self._manual if e.tag == "location_bodyarm"]
        if len(locations) == 1 and not self._manual.findall("handconstellation"):
            self._locate(found, locations[0])
        for name, touch in self._touches():
            found.hands.setdefault(name, Hand()).touch = touch
        return found

    def _touches(self) -> Iterator[tuple[str, Touch]]:
        """Yield what each hand touches at the start."""
        for element in self._manual:
            if element.tag in ("location_bodyarm", "location_hand"):
                for name in self._named:
                    yield from _touch(name, element)
            elif element.tag == "split_location":
                for name, part in zip("sw", element, strict=False):
                    yield from _touch(name, part)
            elif element.tag == "handconstellation" and element.get("contact") == "touch":
                parts = element.findall("location_hand")
                own = _bones(parts[1]) if len(parts) == 2 else HAND_BONES
                other = _bones(parts[0]) if len(parts) == 2 else HAND_BONES
                yield "s", Touch(own, other, (), 0.0)

    def end(self) -> Posture | None:
        """Read the directions at the end; None where a movement may have changed them again."""
        targets = [
            target
            for target in self._manual.iter("tgt_motion")
            if any(_turns(e) for e in target.iter("handconfig"))
        ]
        if not targets:
            return self._oriented()
        if len(targets) > 1 or any(
            targets[0] in list(e.iter())
            for tag in ("rpt_motion", "split_motion", "seq_motion")
            for e in self._manual.iter(tag)
        ):
            return None
        for element in targets[0]:
            self._take(element)
        return self._oriented()

    def _take(self, element: ET.Element) -> None:
        """Note directions; those for both hands are mirrored for the weak one, letter by letter."""
        if element.tag == "handconfig":
            for name in self._named:
                mirrored = self._both and name == "w"
                for key, codes in _directions(element):
                    first, second = (self._mirrored(c) if mirrored else c for c in codes)
                    assert first is not None
                    self._codes[name][key] = first, second
        elif element.tag == "split_handconfig":
            for name, config in zip("sw", element, strict=False):
                self._codes[name].update(_directions(config))

    def _mirrored(self, code: str | None) -> str | None:
        if code is None:
            return None
        pairs = zip(("lr", "ud", "oi"), self._flip, strict=True)
        table = dict[str, str]()
        for pair, flip in pairs:
            if flip < 0:
                table |= {pair[0]: pair[1], pair[1]: pair[0]}
        return "".join(table.get(c, c) for c in code)

    def _oriented(self) -> Posture:
        found = Posture()
        for name, codes in self._codes.items():
            hand = Hand()
            if "extfidir" in codes:
                hand.fingers = direction(*codes["extfidir"])
                if "palmor" in codes:
                    hand.palm = palm(hand.fingers, *codes["palmor"])
            if codes:
                found.hands[name] = hand
        return found

    def _locate(self, found: Posture, location: ET.Element) -> None:
        where, second = location.get("location"), location.get("second_location")
        contact = location.get("contact")
        own = location.find("location_hand")
        on_skin = where in FACE_SITES and where != "neck" and contact is None
        if contact == "touch" or on_skin:
            beside = "beside" in f"{location.get('side')}{location.get('second_side')}"
            if where in FACE_SITES and not (second or location.get("second_side") or beside):
                for name in self._named:
                    found.hands.setdefault(name, Hand()).touched = FACE_SITES[where]
            return
        if where not in HEIGHT or (second is not None and second not in HEIGHT) or own is not None:
            return
        heights = [HEIGHT[where]] + ([HEIGHT[second]] if second else [])
        sides = [location.get("side")]
        if second or location.get("second_side"):
            sides.append(location.get("second_side"))
        x = float(np.mean([_sideways(side, contact) for side in sides]))
        if self._both and not any(sides):
            x = np.nan
        place = np.array([x, np.mean(heights), FORWARD[contact]])
        for name in self._named:
            mirrored = self._both and name == "w"
            found.hands.setdefault(name, Hand()).place = place * (MIRROR if mirrored else 1.0)


def _touch(name: str, element: ET.Element) -> Iterator[tuple[str, Touch]]:
    """Yield the touch of one hand, s or w, at a part of the body or of the other hand."""
    if element.get("contact") != "touch":
        return
    inner = element.find("location_hand")
    own = HAND_BONES if inner is None else _bones(inner)
    if element.tag == "location_hand":
        yield name, Touch(own, _bones(element), (), 0.0)
        return
    places = [element.get("location"), element.get("second_location")]
    sites, second = (SKIN_SITES.get(place or "", ()) for place in places)
    if sites:
        face = places[0] in FACE_SITES or places[0] == "underchin"
        if face:
            yield name, Touch(own, BODY_BONES, sites, FACE_RADIUS_M, second)
        else:  # the skin between its sites belongs to a part of the trunk, too
            yield name, Touch(own, BODY_BONES, sites, TRUNK_RADIUS_M, second or sites)


def _bones(part: ET.Element) -> tuple[str, ...]:
    """Return the bones of a part of a hand: its digits, or those of a part of the palm."""
    digits = part.get("digits")
    if digits:
        return tuple(HAND_BONES[int(digit)] for digit in digits)
    return OWN_BONES.get(part.get("location") or "", HAND_BONES)


def _directions(element: ET.Element) -> Iterator[tuple[str, tuple[str, str | None]]]:
    for name, letters in (("extfidir", "udlroi"), ("palmor", "udlr")):
        code = element.get(name)
        if code and set(code) <= set(letters):
            second = element.get(f"second_{name}")
            yield name, (code, second if second and set(second) <= set(letters) else None)


def _turns(element: ET.Element) -> bool:
    return any(True for _ in _directions(element))


def _sideways(side: str | None, contact: str | None) -> float:
    if not side or side.split("_")[0] not in ("left", "right"):
        return 0.0
    sign = 1 if side.startswith("left") else -1
    return sign * (AT if side.endswith("_at") else BESIDE)[contact]
