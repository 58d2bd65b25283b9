"""A sign as it is notated, whichever notation it was read from.

Codes are those of gestural SiGML, whose attributes name what the symbols of HamNoSys mean.
Directions are letters: `u` up, `d` down, `l` the side of the non-dominant hand, `r` that of the
dominant one, `o` out, away from the signer, `i` in, towards the signer.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from azee.lexicon.codeset import words

# Hands ------------------------------------------------------------------------------------------

BASES = words(
    "fist flat finger2 finger23 finger23spread finger2345 pinch12 pinchall pinch12open"
    " cee12 ceeall cee12open"
)
BENDS: dict[str, tuple[float, float]] = {
    "straight": (0, 0),
    "bent": (1, 0),
    "round": (0.45, 0.42),
    "hooked": (0, 1),
    "dblbent": (0.8, 0.55),
    "dblhooked": (0.45, 1),
    "halfbent": (0.5, 0),
}
"""How far a finger is bent at the knuckle and hooked beyond, 0 to 1, as the core's rules say."""
THUMBS = frozenset(("out", "across", "opposed"))
DIGITS = "12345"
"""Thumb, index, middle, ring and little finger."""


def is_bend(code: str) -> bool:
    """Whether a code is a bend: by name, or a digit from 0 to 4 for each of three joints."""
    return code in BENDS or (len(code) == 3 and all(c in "01234" for c in code))


def bend_of(code: str | None) -> tuple[float, float]:
    """Return how far a bend is at the knuckle and beyond it, 0 to 1; 4 is a right angle."""
    if code is None:
        return BENDS["straight"]
    if code in BENDS:
        return BENDS[code]
    knuckle, middle, end = (int(c) / 4 for c in code)
    return knuckle, (middle + end) / 2


@dataclass(frozen=True, slots=True)
class Heading:
    """A direction, or the one halfway between two."""

    first: str
    second: str | None = None


@dataclass(frozen=True, slots=True)
class Form:
    """A shape of the hand with its modifiers."""

    base: str
    bend: str | None = None
    thumb: str | None = None
    opening: str | None = None


@dataclass(frozen=True, slots=True)
class Crossing:
    """A digit that touches or crosses another, at a part of it."""

    digit: str
    other: str
    part: str


@dataclass(frozen=True, slots=True)
class HandShape:
    """A form, or one between two, and what single digits do.

    fingers: the digits that the form is about, where they are not the usual ones.
    bends: the bend of single digits. exempt: digits that do not take part.
    """

    form: Form
    second: Form | None = None
    fingers: str = ""
    bends: tuple[tuple[str, str], ...] = ()
    exempt: str = ""
    crossing: Crossing | None = None
    thumb_enclosed: bool = False


@dataclass(frozen=True, slots=True)
class HandConfig:
    """What is said of a hand: its shape, where its fingers point, where its palm looks."""

    shape: HandShape | None = None
    fingers: Heading | None = None
    palm: Heading | None = None
    is_absolute: bool = False
    """Whether left and right are those of the signer, not of the hands."""

    def then(self, other: HandConfig) -> HandConfig:
        """Return this with what another says instead."""
        return HandConfig(
            other.shape or self.shape,
            other.fingers or self.fingers,
            other.palm or self.palm,
            self.is_absolute or other.is_absolute,
        )


# Places -----------------------------------------------------------------------------------------

FACE = words(
    "forehead eyebrows eyes uppereyelid lowereyelid nose nostrils ear earlobe cheek lips upperlip"
    " lowerlip tongue teeth chin underchin"
)
TRUNK = words("headtop head neck shouldertop shoulders chest stomach belowstomach")
ARM = frozenset(("upperarm", "elbow", "elbowinside", "lowerarm"))
BODY = FACE | TRUNK | ARM
HAND = words(
    "tip nail pad midjoint base side palm handback thumbside pinkyside thumbball wristback"
    " lowerarm elbow elbowinside upperarm"
)
SIDES = words("left_beside left_at right_at right_beside front back palmar dorsal radial ulnar")


@dataclass(frozen=True, slots=True)
class HandPart:
    """A part of a hand or an arm. `digits` is empty for parts that are no finger's."""

    digits: str = ""
    part: str | None = None
    side: str | None = None


@dataclass(frozen=True, slots=True)
class OnHand:
    """A place at a part of the other hand, or between two; `own` is what is there."""

    at: HandPart
    second: HandPart | None = None
    contact: str | None = None
    own: HandPart | None = None


@dataclass(frozen=True, slots=True)
class OnBody:
    """A place at the body or before it, or between two; `own` is what is there.

    contact: touch, close, armextended or None.
    """

    at: str | None
    side: str | None = None
    second: str | None = None
    second_side: str | None = None
    contact: str | None = None
    own: HandPart | None = None
    behind: bool = False


@dataclass(frozen=True, slots=True)
class Constellation:
    """Two hands beside each other: the weak hand's part, the strong hand's, and where both are."""

    weak: OnHand | None = None
    strong: OnHand | None = None
    place: OnBody | None = None
    contact: str | None = None


@dataclass(frozen=True, slots=True)
class EachAt:
    """A place for each hand."""

    strong: OnBody | OnHand | None = None
    weak: OnBody | OnHand | None = None


Location: TypeAlias = OnBody | OnHand | Constellation | EachAt


@dataclass(frozen=True, slots=True)
class Posture:
    """What hands are like and where they are, as far as it is said.

    both: of the hand or hands that the sign is about. strong, weak: of one hand, where they differ.
    """

    both: HandConfig = HandConfig()
    strong: HandConfig | None = None
    weak: HandConfig | None = None
    location: Location | None = None


# Movements --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Manner:
    """How a movement is done. speed: times as fast."""

    fast: bool = False
    slow: bool = False
    tense: bool = False
    rest: bool = False
    halt: bool = False
    speed: float = 1.0


PLAIN = Manner()


@dataclass(frozen=True, slots=True)
class Straight:
    """A movement in a direction; with `curve` in an arc that bulges that way."""

    heading: Heading
    size: str | None = None
    curve: str | None = None
    curve_size: str | None = None
    zigzag: str | None = None
    brushed: OnHand | OnBody | None = None
    manner: Manner = PLAIN


@dataclass(frozen=True, slots=True)
class Circle:
    """A circle about an axis, right-handed. start, end: hours of a clock face, as directions."""

    axis: Heading
    size: str | None = None
    turns: int = 1
    start: str | None = None
    end: str | None = None
    ellipse: str | None = None
    manner: Manner = PLAIN


@dataclass(frozen=True, slots=True)
class Wrist:
    """nodding, swinging, twisting, stircw or stirccw."""

    kind: str
    size: str | None = None
    manner: Manner = PLAIN


@dataclass(frozen=True, slots=True)
class FingerPlay:
    """Fingers that move one after the other; no digits are all of them."""

    digits: str = ""
    manner: Manner = PLAIN


@dataclass(frozen=True, slots=True)
class Still:
    """A hand that does not move."""


@dataclass(frozen=True, slots=True)
class Target:
    """Movements that end in a posture."""

    moves: tuple[Movement, ...]
    posture: Posture
    manner: Manner = PLAIN


@dataclass(frozen=True, slots=True)
class Together:
    """Movements at the same time."""

    moves: tuple[Movement, ...]
    manner: Manner = PLAIN


@dataclass(frozen=True, slots=True)
class InTurn:
    """Movements one after the other; `fused` ones run into each other."""

    moves: tuple[Movement, ...]
    fused: bool = False
    manner: Manner = PLAIN


@dataclass(frozen=True, slots=True)
class ForEach:
    """A movement of the strong hand and one of the weak hand."""

    strong: Movement
    weak: Movement
    manner: Manner = PLAIN


@dataclass(frozen=True, slots=True)
class Repeat:
    """A movement more than once.

    kind: fromstart, fromstart_several, continue, continue_several, reverse, tofroto, manyrandom.
    """

    move: Movement
    kind: str = "fromstart"
    again: str | None = None
    shift: Heading | None = None
    alternating: bool = False
    manner: Manner = PLAIN


Movement: TypeAlias = (
    Straight | Circle | Wrist | FingerPlay | Still | Target | Together | InTurn | ForEach | Repeat
)

# Signs ------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Symmetry:
    """What the weak hand does: what the strong hand does, flipped as told."""

    left_right: bool = False
    up_down: bool = False
    out_in: bool = False
    out_of_phase: bool = False


@dataclass(frozen=True, slots=True)
class Manual:
    """A part of a sign with one initial posture. `symmetry` is None for signs of one hand."""

    posture: Posture
    moves: tuple[Movement, ...] = ()
    symmetry: Symmetry | None = None
    weak_alone: bool = False
    holds_over: bool = False


@dataclass(frozen=True, slots=True)
class Tier:
    """A movement of head, trunk, shoulders, eyes or mouth, by the code of its notation."""

    name: str
    code: str
    amount: float = 1.0
    speed: float = 1.0


@dataclass(frozen=True, slots=True)
class NonManual:
    """What the rest of the body does; `tiers` of the same name follow one another."""

    mouthing: str = ""
    tiers: tuple[Tier, ...] = ()


@dataclass(frozen=True, slots=True)
class NotationFault:
    """Something in a file that its notation does not allow, and how it was read all the same."""

    kind: str
    detail: str
    line: int = 0


@dataclass(frozen=True, slots=True)
class Sign:
    """A sign of a lexicon."""

    gloss: str
    manuals: tuple[Manual, ...]
    nonmanual: NonManual = NonManual()
    faults: tuple[NotationFault, ...] = field(default=(), compare=False)
