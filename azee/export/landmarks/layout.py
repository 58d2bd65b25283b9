"""Names and lines of the landmarks of MediaPipe Holistic, in its order.

The names are those of MediaPipe's enumerations, which readers of `.pose` files look for. Left and
right are the signer's own.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

Lines = tuple[tuple[int, int], ...]

SIDES = {"LEFT": "L", "RIGHT": "R"}
FINGERS = {
    "THUMB": ("thumb", "T", ("CMC", "MCP", "IP", "TIP")),
    "INDEX_FINGER": ("index", "I", ("MCP", "PIP", "DIP", "TIP")),
    "MIDDLE_FINGER": ("middle", "M", ("MCP", "PIP", "DIP", "TIP")),
    "RING_FINGER": ("ring", "R", ("MCP", "PIP", "DIP", "TIP")),
    "PINKY": ("little", "L", ("MCP", "PIP", "DIP", "TIP")),
}
"""By MediaPipe's name: AZee's bone, the letter of the site at the tip, and the points."""

_EYES = tuple(f"{side}_EYE{part}" for side in SIDES for part in ("_INNER", "", "_OUTER"))
_PAIRS = (
    *("SHOULDER", "ELBOW", "WRIST", "PINKY", "INDEX", "THUMB"),
    *("HIP", "KNEE", "ANKLE", "HEEL", "FOOT_INDEX"),
)
BODY = (
    *("NOSE", *_EYES, "LEFT_EAR", "RIGHT_EAR", "MOUTH_LEFT", "MOUTH_RIGHT"),
    *(f"{side}_{part}" for part in _PAIRS for side in SIDES),
)
"""The 33 points of the body."""
HAND = ("WRIST", *(f"{finger}_{part}" for finger, (_, _, ps) in FINGERS.items() for part in ps))
"""The 21 points of a hand."""
FACE = tuple(str(n) for n in range(468))
"""The 468 points of the face, which have numbers only."""

_RINGS = (
    (
        *(10, 338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288, 397, 365, 379, 378, 400, 377),
        *(152, 148, 176, 149, 150, 136, 172, 58, 132, 93, 234, 127, 162, 21, 54, 103, 67, 109, 10),
    ),
    (61, 146, 91, 181, 84, 17, 314, 405, 321, 375, 291, 409, 270, 269, 267, 0, 37, 39, 40, 185, 61),
    (78, 95, 88, 178, 87, 14, 317, 402, 318, 324, 308, 415, 310, 311, 312, 13, 82, 81, 80, 191, 78),
    (33, 7, 163, 144, 145, 153, 154, 155, 133, 173, 157, 158, 159, 160, 161, 246, 33),
    (263, 249, 390, 373, 374, 380, 381, 382, 362, 398, 384, 385, 386, 387, 388, 466, 263),
    (46, 53, 52, 65, 55),
    (70, 63, 105, 66, 107),
    (276, 283, 282, 295, 285),
    (300, 293, 334, 296, 336),
)
"""Outlines of the face: oval, lips outside and inside, eyes, brows."""


def _lines(names: tuple[str, ...], pairs: str) -> Lines:
    return tuple(
        (names.index(a), names.index(b)) for a, b in (pair.split("-") for pair in pairs.split())
    )


def _of_hand() -> Lines:
    roots = [1 + 4 * n for n in range(len(FINGERS))]
    along = [(first + k, first + k + 1) for first in roots for k in range(3)]
    return ((0, roots[0]), (0, roots[1]), *pairwise(roots[1:]), (0, roots[-1]), *along)


_ARM = "{0}_SHOULDER-{0}_ELBOW {0}_ELBOW-{0}_WRIST {0}_WRIST-{0}_PINKY {0}_WRIST-{0}_INDEX "
_HAND = "{0}_PINKY-{0}_INDEX {0}_WRIST-{0}_THUMB {0}_SHOULDER-{0}_HIP {0}_HIP-{0}_KNEE "
_LEG = "{0}_KNEE-{0}_ANKLE {0}_ANKLE-{0}_HEEL {0}_HEEL-{0}_FOOT_INDEX {0}_ANKLE-{0}_FOOT_INDEX "
_EYE = "NOSE-{0}_EYE_INNER {0}_EYE_INNER-{0}_EYE {0}_EYE-{0}_EYE_OUTER {0}_EYE_OUTER-{0}_EAR "


@dataclass(frozen=True, slots=True)
class Component:
    """A group of points: its name in files, its points, and the lines that viewers draw."""

    name: str
    points: tuple[str, ...]
    lines: Lines
    colour: tuple[int, int, int]


_BODY_LINES = _lines(
    BODY,
    "MOUTH_LEFT-MOUTH_RIGHT LEFT_SHOULDER-RIGHT_SHOULDER LEFT_HIP-RIGHT_HIP "
    + "".join((_EYE + _ARM + _HAND + _LEG).format(side) for side in SIDES),
)
COMPONENTS = (
    Component("POSE_LANDMARKS", BODY, _BODY_LINES, (255, 0, 0)),
    Component("FACE_LANDMARKS", FACE, tuple(p for r in _RINGS for p in pairwise(r)), (128, 0, 0)),
    Component("LEFT_HAND_LANDMARKS", HAND, _of_hand(), (0, 128, 0)),
    Component("RIGHT_HAND_LANDMARKS", HAND, _of_hand(), (0, 0, 255)),
    Component("POSE_WORLD_LANDMARKS", BODY, _BODY_LINES, (255, 0, 0)),
)
"""The components of a `.pose` file of MediaPipe Holistic, in its order."""
COUNT = sum(len(component.points) for component in COMPONENTS)
"""Points of all components: 576."""
