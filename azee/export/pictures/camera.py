"""Cameras that look at a body, and the places of points in their pictures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class Camera:
    """An eye in the world that looks at a target: (3,) metres each; height of view in radians."""

    eye: Floats
    target: Floats
    height_rad: float

    @property
    def axes(self) -> Floats:
        """Rows right, up and backward of the view, (3, 3)."""
        back = self.eye - self.target
        back = back / np.linalg.norm(back)
        right = np.cross([0.0, 1.0, 0.0], back)
        if np.linalg.norm(right) < 1e-6:
            right = np.array([1.0, 0.0, 0.0])
        right = right / np.linalg.norm(right)
        return np.stack([right, np.cross(back, right), back])


VIEWS: Mapping[str, tuple[str, tuple[float, float, float], float]] = {
    "front": ("body", (0.0, 0.05, 1.0), 0.62),
    "side": ("body", (-1.0, 0.05, 0.08), 0.62),
    "three-quarter": ("body", (-0.72, 0.28, 0.8), 0.62),
    "back": ("body", (0.0, 0.05, -1.0), 0.62),
    "whole": ("whole", (0.0, 0.05, 1.0), 0.92),
    "face": ("face", (0.0, 0.03, 1.0), 0.165),
    "face three-quarter": ("face", (-0.7, 0.05, 0.8), 0.165),
    "face side": ("face", (-1.0, 0.0, 0.0), 0.165),
    "head left": ("face", (1.0, 0.0, 0.0), 0.165),
    "right hand": ("palm_R", (0.0, 0.1, 1.0), 0.14),
    "left hand": ("palm_L", (0.0, 0.1, 1.0), 0.14),
}
"""The target of a named camera, its direction, and half the height of its view in metres."""

_LENS_RAD = np.radians(20.0)


def camera(rig: Rig, q: Floats, view: str) -> Camera:
    """Return a named camera for a body in posture q (V,); only those of the hands move with q.

    `right hand palm`, `back`, `thumb`, `little` and `tips` look onto that side of the palm, in any
    posture.
    Raises: KeyError: no such view.
    """
    frames = rig.chain.frames(q)
    for hand, bone in (("right hand", "palm_R"), ("left hand", "palm_L")):
        if view.startswith(f"{hand} "):
            node = rig.bones[bone].node
            R = frames.rotations[node]
            thumb = R[:, 0] * (1.0 if bone.endswith("R") else -1.0)
            towards = {
                "palm": R[:, 2],
                "back": -R[:, 2],
                "thumb": thumb,
                "little": -thumb,
                "tips": R[:, 1],
            }[view.removeprefix(f"{hand} ")]
            middle = frames.positions[node] + 0.075 * R[:, 1]
            return from_direction(middle, towards, 0.13)
    what, towards_eye, half_height = VIEWS[view]
    if what == "body":
        target = rig.landmarks.shoulder_middle + np.array([0.0, -0.17, 0.05])
        half_height *= rig.landmarks.arm_m / 0.48
    elif what == "whole":
        target = np.array([0.0, 0.83, 0.02]) * rig.landmarks.shoulder_middle[1] / 1.31
    elif what == "face":
        eyes = [frames.positions[rig.bones[f"eye_{s}"].node] for s in "LR"]
        target = (eyes[0] + eyes[1]) / 2.0 + np.array([0.0, -0.02, -0.03])
    else:
        node = rig.bones[what].node
        target = frames.positions[node] + 0.075 * frames.rotations[node][:, 1]
    return from_direction(target, np.array(towards_eye), half_height)


def from_direction(target: Floats, towards_eye: Floats, half_height: float) -> Camera:
    """Return the camera that shows so many metres above and below a target, from one side."""
    direction = towards_eye / np.linalg.norm(towards_eye)
    return Camera(target + direction * half_height / np.tan(_LENS_RAD / 2.0), target, _LENS_RAD)


def projected(vertices: Floats, camera: Camera, width: int, height: int) -> tuple[Floats, Floats]:
    """Screen places (N, 3) of points (N, 3), and the reciprocals of their distances (N, 1).

    Pixels from the upper left; the third is a depth that is affine on the screen.
    """
    local = (vertices - camera.eye) @ camera.axes.T
    distance = -local[:, 2]
    in_front = distance > 0.01
    inverse = 1.0 / np.where(in_front, distance, 1.0)
    scale = height / 2.0 / np.tan(camera.height_rad / 2.0)
    screen = np.stack(
        [
            width / 2.0 + scale * local[:, 0] * inverse,
            height / 2.0 - scale * local[:, 1] * inverse,
            np.where(in_front, -inverse, 1e30),
        ],
        axis=1,
    )
    return np.ascontiguousarray(screen), np.ascontiguousarray(inverse[:, None])
