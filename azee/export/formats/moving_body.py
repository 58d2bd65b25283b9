"""What files of motion take of a rig."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from azee_rig.mesh import BodyMesh
from azee_rig.skeleton import Pose, Skeleton

Array = NDArray[np.float64]


class MovingBody(Protocol):
    """A skeleton that coordinates pose, and the mesh that it moves; every `Rig` is one."""

    @property
    def name(self) -> str:
        """What files call the body."""

    @property
    def skeleton(self) -> Skeleton:
        """Its joints."""

    @property
    def mesh(self) -> BodyMesh:
        """Its surface."""

    def pose(self, q: Array) -> Pose:
        """Local rotations of the joints for coordinates q (…, V)."""

    def joint_positions(self, pose: Pose) -> Array:
        """World positions (…, J, 3) of the joints, metres."""
