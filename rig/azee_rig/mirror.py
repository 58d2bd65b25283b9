"""The mirror image of a posture, in a mirror between left and right.

Coordinates are anatomical, so those of the two sides swap without a change of sign. Turns and leans
of the middle of the body, and the gaze, change their sign.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from azee_rig.coordinates import Coordinates

Floats = NDArray[np.float64]

_SIDE = re.compile(r"(?<=_)[LR](?=_|\.|$)", re.ASCII)
_UNIT_SIDE = re.compile(r"Left|Right|(?<=-)(?:left|right)(?=-)", re.ASCII)
_OTHER = {"L": "R", "R": "L", "Left": "Right", "Right": "Left", "left": "right", "right": "left"}
SIDEWAYS = ("axial", "lateral")
"""Movements of an unpaired part that change their sign; `yaw`, of the eyes, is another."""


def mirrored(coordinates: Coordinates, q: Floats) -> Floats:
    """Return the mirror images of postures q (…, V), radians, in a new array.

    Applied twice it changes nothing.
    """
    out = np.empty_like(q)
    for i, name in enumerate(coordinates.names):
        part, _, movement = name.partition(".")
        other = other_side(part)
        turns = movement == "yaw" or (other == part and movement in SIDEWAYS)
        values = q[..., i]
        out[..., coordinates.index[f"{other}.{movement}"]] = -values if turns else values
    return out


def other_side(name: str) -> str:
    """Return the bone, coordinate or site of the other side; one without a side stays itself."""
    return _swapped(_SIDE, name)


def mirrored_units(units: Sequence[str]) -> tuple[str, ...]:
    """Return names of the face units on the other side: `eyeBlinkLeft` for `eyeBlinkRight`.

    A unit without a side stays itself. `eyeLookIn…` stays inward, since it is anatomical too.
    """
    return tuple(_swapped(_UNIT_SIDE, unit) for unit in units)


def _swapped(side: re.Pattern[str], name: str) -> str:
    return side.sub(lambda found: _OTHER[found[0]], name)
