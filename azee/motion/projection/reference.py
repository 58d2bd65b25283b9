"""The movement that is wanted, with life and accents, and the limits in which it is projected."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.limbs import is_finger, limb_of_coordinate
from azee_rig.coordinates import Coordinates

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """The movement that is wanted as far as constraints allow, at the frames of a clip.

    times: exact, on the score's time line. q: (T, V), not limited. accented: (T, V), where accents
    ask for what q has. played: (T, V), where q is a recording's, which is not changed. lower,
    upper: (V,) limits (see `limits_for`).
    """

    times: tuple[Fraction, ...]
    q: Array
    accented: NDArray[np.bool_]
    played: NDArray[np.bool_]
    lower: Array
    upper: Array


MARGIN_RAD = math.radians(1.2)
"""So far from the ends of its range no joint of the body goes for life or a balance."""


def limits_for(q: Array, coordinates: Coordinates) -> tuple[Array, Array]:
    """Return limits, (V,) each: those of the body's joints a little inside their ranges.

    Where a movement itself goes farther, they go as far.

    Args: q: (T, V) the movement without life.
    """
    bodily = [not is_finger(limb_of_coordinate(name)) for name in coordinates.names]
    margin = np.where(bodily, MARGIN_RAD, 0.0)
    least, most = q.min(axis=0, initial=np.inf), q.max(axis=0, initial=-np.inf)
    lower = np.maximum(coordinates.lower, np.minimum(coordinates.lower + margin, least))
    upper = np.minimum(coordinates.upper, np.maximum(coordinates.upper - margin, most))
    return lower, upper
