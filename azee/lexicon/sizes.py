"""Lengths and times of the notations, in metres and seconds of AZee's reference signer.

Fractions of the arm, shoulder to wrist, are those that the engine of JASigning shows (measured),
and so are the times (its configuration).
"""

from __future__ import annotations

from azee.lexicon.model import Manner

ARM_M = 0.4808
"""Shoulder to wrist of the reference signer, whose metres AZee counts."""

STRAIGHT_M = {None: 0.30 * ARM_M, "small": 0.12 * ARM_M, "big": 0.48 * ARM_M}
"""How far a straight movement goes."""
RADIUS_M = {None: 0.5 * 0.30 * ARM_M, "small": 0.2 * 0.30 * ARM_M, "big": 0.30 * ARM_M}
"""The radius of a circle."""
BULGE = {None: 0.42, "small": 0.20, "big": 0.50}
"""How far an arc bulges, as a part of its chord: a half of tan(θ/4) for an arc of θ."""

FORWARD_M = {"close": 0.54 * ARM_M, None: 0.69 * ARM_M, "armextended": 0.83 * ARM_M}
"""How far before the shoulder line a place in space is."""
AT_SIDE_M = {"close": 0.25 * ARM_M, None: 0.29 * ARM_M, "armextended": 0.34 * ARM_M}
BESIDE_M = {"close": 0.51 * ARM_M, None: 0.57 * ARM_M, "armextended": 0.65 * ARM_M}
"""How far from the middle a place at or beside the body is."""
APART_M = 0.16 * ARM_M
"""How far from the middle each of two hands is, where nothing says on which side."""
HEIGHT_M = {
    "headtop": 0.69 * ARM_M,
    "forehead": 0.58 * ARM_M,
    "eyebrows": 0.53 * ARM_M,
    "eyes": 0.49 * ARM_M,
    "uppereyelid": 0.49 * ARM_M,
    "lowereyelid": 0.48 * ARM_M,
    "ear": 0.46 * ARM_M,
    "nose": 0.43 * ARM_M,
    "cheek": 0.42 * ARM_M,
    "head": 0.41 * ARM_M,
    "nostrils": 0.41 * ARM_M,
    "earlobe": 0.41 * ARM_M,
    "upperlip": 0.38 * ARM_M,
    "lips": 0.37 * ARM_M,
    "tongue": 0.37 * ARM_M,
    "teeth": 0.37 * ARM_M,
    "lowerlip": 0.36 * ARM_M,
    "chin": 0.31 * ARM_M,
    "underchin": 0.27 * ARM_M,
    "neck": 0.13 * ARM_M,
    "shouldertop": 0.08 * ARM_M,
    "shoulders": 0.0,
    "chest": -0.25 * ARM_M,
    "stomach": -0.50 * ARM_M,
    "belowstomach": -0.66 * ARM_M,
}
"""How high above the shoulder line a place in space is.

Parts of the face are as high as on the reference signer; they count in space where a place is
between one of them and a part of the trunk.
"""
OFF_FACE_M = {"close": 0.16 * ARM_M, "armextended": 0.62 * ARM_M}
"""How far off the face a place before it is."""
NEAR_M = 0.04
"""How far from each other hands are that are close."""

ZIGZAG_M = 0.03
"""How far to either side a zigzag goes."""
SHIFT_M = 0.12 * ARM_M
"""How far on a repetition goes that goes on elsewhere."""

STEP_S = 0.27
"""How long a movement takes."""
TURN_S = 1.5 * STEP_S
"""How long one turn of a circle takes."""
BACK = 0.7
"""The part of a movement's time in which a hand returns to repeat it."""
BETWEEN_S = 0.15
"""The time between the parts of a sign."""
HELD_S = 0.1
"""How long a posture is held at the start and at the end."""


def slowness(manner: Manner) -> float:
    """Return how many times as long a movement takes for its manner."""
    factor = 1 / manner.speed
    for applies, times in ((manner.fast, 0.45), (manner.slow, 2.2), (manner.tense, 2.3)):
        factor *= times if applies else 1
    return factor
