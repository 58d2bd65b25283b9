"""A body of six joints and a few triangles, which takes any rotations at all."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip, Label
from azee_rig.mesh import BodyMesh, Part
from azee_rig.skeleton import Pose, Skeleton

OFFSETS = [[0, 1, 0.02], [0, 0.3, 0], [0.2, 0, 0], [0.3, 0, 0.1], [0.3, 0, 0], [0, 0.2, 0]]
MOVES = [[0, 0, 0.02], [0, 0.01, 0], [0, 0, 0.03], [0.01, 0, 0], [0, 0, 1.0]]


class SmallRig:
    """As much of a rig as writers of files read. Its coordinates are the quaternions themselves."""

    name = "small"
    skeleton = Skeleton(
        ("root", "spine.01", "arm.L", "hand-1.L", "hand_1.L", "head"),
        np.array([-1, 0, 1, 2, 2, 1]),
        np.array(OFFSETS),
    )

    def pose(self, q: NDArray[np.float64]) -> Pose:
        """Rows of 3 + 4 J numbers: the root's way, then a quaternion per joint."""
        rotations = q[..., 3:].reshape(*q.shape[:-1], -1, 4)
        return Pose(q[..., :3], rotations / np.linalg.norm(rotations, axis=-1, keepdims=True))

    def joint_positions(self, pose: Pose) -> NDArray[np.float64]:
        from azee_rig.skin import joint_frames

        return joint_frames(self.skeleton, pose)[0]

    @property
    def mesh(self) -> BodyMesh:
        """Two strips of triangles along arm and head, one of which the face units move."""
        steps = np.linspace(0, 1, 6)
        arm = np.stack([0.2 + 0.6 * steps, np.full(6, 1.3), 0.05 * (-1.0) ** np.arange(6)], axis=1)
        head = np.stack([0.05 * (-1.0) ** np.arange(6), 1.5 + 0.3 * steps, np.full(6, 0.1)], axis=1)
        strip = np.array([[i, i + 1, i + 2] if i % 2 else [i + 1, i, i + 2] for i in range(4)])
        influences = np.zeros((12, 6))
        influences[:6, :5] = [0.1, 0.1, 0.5, 0.2, 0.1]
        influences[6:, :2] = [0.7, 0.3]
        joints = np.tile([0, 1, 2, 3, 4, 5], (12, 1))
        joints[6:, 0] = 5
        joints[6:, 5] = 0
        return BodyMesh(
            vertices=np.vstack([arm, head]),
            triangles=np.vstack([strip, strip + 6]),
            parts=(
                Part("sleeve", 0, 4, (0.1, 0.2, 0.3, 1.0), 0.9),
                Part("skin", 4, 8, (1.0, 1.0, 1.0, 1.0), 0.6),
            ),
            colours=np.linspace(0, 1, 36).reshape(12, 3),
            joints=joints,
            weights=influences,
            units=("smile", "blink", "idle unit"),
            unit_start=np.array([0, 2, 5, 5]),
            unit_rows=np.array([8, 7, 10, 9, 11]),
            unit_deltas=np.array(MOVES),
            joint_count=6,
        )


SMALL = SmallRig()


def tumbling() -> Clip:
    """Twenty frames of the small rig: joints anywhere, one locked, one still, one at rest."""
    random = np.random.default_rng(5)
    frames = 20
    rotations = np.cumsum(random.normal(scale=0.08, size=(frames, 6, 4)), axis=0)
    rotations[..., 0] += 1
    half = np.sqrt(0.5)
    rotations[:, 1] = [half, half, 0, 0]
    rotations[:, 3] = [0.8, 0, 0.6, 0]
    rotations[:, 4] = [1, 0, 0, 0]
    way = np.linspace([0, 0, 0], [0.1, -0.2, 0.3], frames)
    return Clip(
        times=np.arange(frames) / 25,
        coordinates=np.hstack([way, rotations.reshape(frames, -1)]),
        units=("blink", "smile"),
        unit_weights=np.stack([np.linspace(0, 1, frames), np.linspace(0, -0.5, frames)], axis=1),
        labels=(
            Label(("not-but",), 0.0, 0.76),
            Label(("not-but", "X"), 0.0, 0.4),
            Label(("not-but", "Y & <Z>"), 0.4, 0.76),
        ),
    )
