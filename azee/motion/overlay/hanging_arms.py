"""Arms that hang yield where a leaning or turning trunk carries them into the hip."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig
from azee_solver import kinematics

Array = NDArray[np.float64]

HANGS_RAD = 0.25
"""So far from its rest an arm hardly hangs any more: root of the sum of squares of its angles."""
SOFT_RAD = math.radians(0.5)
"""What is to be yielded grows from nothing within this: no jerk where a lean begins."""
INWARD = {"L": -1.0, "R": 1.0}
"""Sense of x, which points to the left."""


def yielding_to_leans(rig: Rig, q: Array, rest: Array) -> Array:
    """Return what hanging arms yield, (T, V) radians, in a movement q (T, V).

    Where the trunk leans to one side or turns, it carries a hand towards the hip. The upper arm
    then goes outwards until the hand is no nearer to the middle than at rest. An arm that is
    carried outwards keeps its angle. rest: (V,) the posture in which the arms hang.
    """
    out = np.zeros_like(q)
    index = rig.coordinates.index
    moved = kinematics.frames(rig.chain, q).positions
    at_rest = rig.chain.frames(rest).positions
    for side, inward in INWARD.items():
        if f"palm_{side}" not in rig.bones or f"arm_{side}.abduction" not in index:
            continue
        shoulder, hand = rig.bones[f"arm_{side}"].node, rig.bones[f"palm_{side}"].node
        carried_m = inward * (moved[:, hand, 0] - at_rest[hand, 0])
        angle = carried_m / np.linalg.norm(at_rest[hand] - at_rest[shoulder])
        outwards = 0.5 * (angle + np.hypot(angle, SOFT_RAD) - SOFT_RAD)
        bones = (f"arm_{side}.", f"f_arm_{side}.")
        arm = [v for name, v in index.items() if name.startswith(bones)]
        off = np.linalg.norm(q[:, arm] - rest[arm], axis=1)
        out[:, index[f"arm_{side}.abduction"]] = outwards * np.exp(-((off / HANGS_RAD) ** 2))
    return out
