"""How coordinates turn bones: angular velocities by finite differences."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig
from azee_solver import kinematics

Array = NDArray[np.float64]

_STEP_RAD = 1e-5


def angular_velocity(rig: Rig, q: Array, coordinate: int, node: int) -> Array:
    """World angular velocity of a node per unit speed of a coordinate at a posture (V,), (3,)."""
    both = np.stack([q, q])
    both[0, coordinate] -= _STEP_RAD
    both[1, coordinate] += _STEP_RAD
    R = kinematics.frames(rig.chain, both).rotations[:, node]
    spin = (R[1] @ R[0].T - R[0] @ R[1].T) / (4 * _STEP_RAD)
    return np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
