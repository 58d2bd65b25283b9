"""Where a body is and how fast it moves, frame by frame: what the measures of likeness read."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.clip.resample import at_rate
from azee.motion.tasks.limbs import limb_of_coordinate
from azee.quality.signing_dynamics import SHOULDERS_M
from azee_rig.chain import Frames
from azee_rig.rig import Rig

Array = NDArray[np.float64]

FPS = 120.0
"""Clips are measured at one rate, so that the same movement has the same figures at any rate."""
CHEST = "back_2"
SIDES = ("L", "R")
NOSE = "NO"


@dataclass(frozen=True, slots=True)
class Extreme:
    """The largest value of a measure, what has it, and when, on the score's time line."""

    value: float
    of: str
    at_s: float


@dataclass(frozen=True, eq=False)
class Kinematics:
    """A clip at evenly spaced frames on the time line of its score.

    times_s: (T,) seconds. q: (T, V) radians. unit_weights: (T, M) of the face units `units`.
    """

    rig: Rig
    fps: float
    times_s: Array
    q: Array
    units: tuple[str, ...]
    unit_weights: Array

    @staticmethod
    def of(clip: Clip, rig: Rig, zero_s: float = 0.0, fps: float = FPS) -> Kinematics:
        """Sample a clip's spline at a rate; frames that it has already stay as they are.

        Args: zero_s: when the score's time line starts in the clip.
        """
        even = at_rate(clip, fps, rig.coordinates)
        return Kinematics(
            rig, fps, even.times - zero_s, even.coordinates, even.units, even.unit_weights
        )

    @cached_property
    def frames(self) -> Frames:
        """World frames of all nodes, (T, B, …)."""
        return self.rig.chain.frames(self.q)

    @cached_property
    def neutral(self) -> Frames:
        """World frames of all nodes in the neutral posture, (B, …)."""
        return self.rig.chain.frames(self.rig.coordinates.idle)

    @cached_property
    def scale(self) -> float:
        """What makes this body's shoulders as far apart as those of recordings of people."""
        left, right = (
            self.neutral.positions[self.rig.bones[f"arm_{s}"].origin_node] for s in SIDES
        )
        return float(SHOULDERS_M / np.linalg.norm(left - right))

    def joint(self, bone: str) -> Array:
        """Return where the proximal joint of a bone is, (T, 3) metres in the world."""
        return np.asarray(self.frames.positions[:, self.rig.bones[bone].origin_node])

    def wrist(self, side: str) -> Array:
        """Return where a wrist is, (T, 3) metres of a body with shoulders `SHOULDERS_M` apart."""
        return self.joint(f"palm_{side}") * self.scale

    def rotation(self, bone: str) -> Array:
        """Return how a bone is turned away from the neutral posture, (T, 3, 3) in the world.

        R(t) · R(neutral)ᵀ: the identity as long as the bone is where the neutral posture has it.
        """
        node = self.rig.bones[bone].node
        away = self.frames.rotations[:, node] @ self.neutral.rotations[node].T
        return np.asarray(away)

    @cached_property
    def frontal(self) -> Array:
        """Shoulders, wrists, nose from the front: what `signing_dynamics` reads, (T, 5, 2)."""
        nose = self.rig.sites.get(NOSE)
        head = self.joint("head") if nose is None else nose.point(self.frames)
        joints = [self.joint(f"{bone}_{side}") for bone in ("arm", "palm") for side in SIDES]
        return np.stack([*joints, head], axis=1)[..., :2]

    @cached_property
    def speed_deg_s(self) -> Array:
        """How fast every coordinate moves between two frames, (T − 1, V) degrees a second."""
        return np.degrees(np.abs(np.diff(self.q, axis=0))) * self.fps

    @property
    def between_s(self) -> Array:
        """Times half-way between frames, (T − 1,): those of `speed_deg_s`."""
        return np.asarray((self.times_s[1:] + self.times_s[:-1]) / 2.0)

    def columns(self, *limbs: str) -> NDArray[np.int64]:
        """Return the coordinates of some limbs; `arm` and `fingers` are those of both sides."""
        each = [limb_of_coordinate(name) for name in self.rig.coordinates.names]
        chosen = [v for v, limb in enumerate(each) if limb in limbs or part_of_limb(limb) in limbs]
        return np.array(chosen, dtype=np.int64)


def part_of_limb(limb: str) -> str:
    """Part of the body that a limb is counted with: `arm`, `fingers`, or its own name."""
    if limb.startswith("arm_"):
        return "arm"
    return limb if limb in ("trunk", "head", "eyes") else "fingers"


def angle_deg(rotations: Array) -> Array:
    """Angles of rotations (…, 3, 3), degrees 0 to 180: arccos((trace − 1) / 2)."""
    cosine = (np.trace(rotations, axis1=-2, axis2=-1) - 1.0) / 2.0
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
