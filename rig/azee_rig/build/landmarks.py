"""Measures of a body, and the named places of its signing space."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES
from azee_rig.build.chain_builder import BuiltChain
from azee_rig.coordinates import Coordinates
from azee_rig.rig import Capsules, Landmarks

Floats = NDArray[np.float64]

SIGNING_SPACE = {
    "Mssp": (0.0, -0.95, 1.25),
    "Rssp": (-0.95, -0.95, 1.15),
    "Lssp": (0.95, -0.95, 1.15),
    "addressee": (0.0, 0.6, 8.0),
}
"""In upper-arm lengths from the middle of the shoulder line: left, up, forward."""
HALF_REACH = 0.6
"""Trunk capsules at most this far above or below Mssp count, in upper-arm lengths."""
SIGNERS_FRONT = 0.6
"""In upper-arm lengths, about the `trunk_front` of slim bodies: signer 0.54, child 0.59."""


def landmarks_of(
    built: BuiltChain, coordinates: Coordinates, reference_arm_m: float | None = None
) -> Landmarks:
    """Measure a body at idle. reference_arm_m: the reference signer's arm; its own if None."""
    at = built.chain.frames(coordinates.idle).positions
    shoulder, elbow, wrist = (
        np.array([at[built.bones[f"{b}_{s}"].origin_node] for s in SIDES])
        for b in ("arm", "f_arm", "palm")
    )
    upper, fore = (
        float(np.linalg.norm(b - a, axis=1).mean()) for a, b in ((shoulder, elbow), (elbow, wrist))
    )
    reference = upper + fore if reference_arm_m is None else reference_arm_m
    return Landmarks(shoulder.mean(axis=0), upper, fore, upper + fore, reference)


def signing_space(marks: Landmarks, front_m: float | None = None) -> dict[str, Floats]:
    """Return the named places in the world, metres.

    Args: front_m: distance of the trunk's front from the shoulder line at the height of Mssp, see
        `trunk_front`. If it is larger than the signer's, the places move forward.
    """
    further = 0.0
    if front_m is not None:
        further = max(0.0, front_m - SIGNERS_FRONT * marks.upper_arm_m)
    return {
        name: marks.shoulder_middle
        + marks.upper_arm_m * np.array(place)
        + np.array([0.0, 0.0, further])
        for name, place in SIGNING_SPACE.items()
    }


def trunk_front(built: BuiltChain, coordinates: Coordinates, capsules: Capsules) -> float:
    """Return how far the trunk extends before the shoulder line at hand height, metres, at idle."""
    at = built.chain.frames(coordinates.idle)
    marks = landmarks_of(built, coordinates)
    height = marks.shoulder_middle[1] + marks.upper_arm_m * SIGNING_SPACE["Mssp"][1]
    fronts = []
    for name, node, a, radius in zip(
        capsules.names, capsules.node, capsules.a, capsules.radius, strict=True
    ):
        if name.startswith("trunk"):
            place = at.positions[node] + at.rotations[node] @ a
            if abs(place[1] - height) < HALF_REACH * marks.upper_arm_m:
                fronts.append(float(place[2] + radius - marks.shoulder_middle[2]))
    return max(fronts, default=0.0)
