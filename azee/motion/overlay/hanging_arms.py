"""Arms that hang stay plumb when the trunk leans to their side, as weight keeps them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig
from azee_solver import kinematics

Array = NDArray[np.float64]

TRUNK = "back_2"
"""The bone that carries the shoulders."""
HANGS_RAD = 0.25
"""So far from its rest an arm hardly hangs any more: root of the sum of squares of its angles."""
SOFT_RAD = math.radians(0.5)
"""Leans below this are half as much to either side: no jerk where a lean begins."""
SIGNS = {"L": 1.0, "R": -1.0}
"""Of a lean to that side."""


def yielding_to_leans(rig: Rig, q: Array, rest: Array) -> Array:
    """Return what hanging arms yield, (T, V) radians, in a movement q (T, V).

    Without it the trunk would carry a hand into the hip that it leans towards. The other arm
    keeps its angle, away from the body. rest: (V,) the posture in which the arms hang.
    """
    out = np.zeros_like(q)
    index = rig.coordinates.index
    if TRUNK not in rig.bones:
        return out
    up = kinematics.frames(rig.chain, q).rotations[:, rig.bones[TRUNK].node, :, 1]
    upright = rig.chain.frames(rest).rotations[rig.bones[TRUNK].node, :, 1]
    lean = np.arctan2(up[:, 0], up[:, 1]) - math.atan2(upright[0], upright[1])
    for side, sign in SIGNS.items():
        arm = [
            v for name, v in index.items() if name.startswith((f"arm_{side}.", f"f_arm_{side}."))
        ]
        if f"arm_{side}.abduction" not in index:
            continue
        off = np.linalg.norm(q[:, arm] - rest[arm], axis=1)
        towards = sign * lean
        out_of_the_way = 0.5 * (towards + np.hypot(towards, SOFT_RAD) - SOFT_RAD)
        out[:, index[f"arm_{side}.abduction"]] = out_of_the_way * np.exp(-((off / HANGS_RAD) ** 2))
    return out
