"""What files of motion take of a rig."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee_rig.mesh import BodyMesh
from azee_rig.skeleton import Pose, Skeleton

Array = NDArray[np.float64]

CHUNK = 256
"""Frames that are posed together, so that a long clip needs little more room than a short one."""


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


def postures(clip: Clip, rig: MovingBody) -> Iterator[tuple[slice, Pose]]:
    """Yield the postures of a clip, a chunk of frames at a time, each with the frames it has."""
    for start in range(0, len(clip.times), CHUNK):
        frames = slice(start, min(start + CHUNK, len(clip.times)))
        yield frames, rig.pose(clip.coordinates[frames])
