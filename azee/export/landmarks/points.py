"""Where the points that MediaPipe names are on a body, in the world.

Joints are AZee's bones, tips and the face are on the skin. No text moves the legs: hips, knees and
feet stand below the trunk, by the proportions of the signer where a body has no such joints.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.landmarks.face import face_points
from azee.export.landmarks.layout import BODY, FACE, FINGERS, HAND, SIDES
from azee_rig.rig import Rig

Floats = NDArray[np.float64]

OF_FACE = {
    "NOSE": 1,
    "LEFT_EYE_INNER": 362,
    "LEFT_EYE_OUTER": 263,
    "RIGHT_EYE_INNER": 133,
    "RIGHT_EYE_OUTER": 33,
    "MOUTH_LEFT": 291,
    "MOUTH_RIGHT": 61,
}
"""Points of the body that are landmarks of the face."""
JOINTS = {
    "SHOULDER": "arm_{}",
    "ELBOW": "f_arm_{}",
    "WRIST": "palm_{}",
    "PINKY": "little_{}_1",
    "INDEX": "index_{}_1",
    "THUMB": "thumb_{}_2",
}
"""Points of the body that are joints: where an AZee bone begins."""
LEGS = {
    "HIP": (0.077, 0.660, 0.004),
    "KNEE": (0.109, 0.362, 0.028),
    "ANKLE": (0.138, 0.053, 0.017),
    "HEEL": (0.153, 0.026, -0.028),
    "FOOT_INDEX": (0.124, 0.010, 0.167),
}
"""Points of the left leg relative to the height of the shoulders: left, up, forward."""
LEG_JOINTS = {
    "HIP": ("upperleg01.{S}", "thigh_{s}"),
    "KNEE": ("lowerleg01.{S}", "calf_{s}"),
    "ANKLE": ("foot.{S}", "foot_{s}"),
}
"""Joints of legs, as the bodies that ship call them."""


def world_points(clip: Clip, rig: Rig) -> tuple[Floats, NDArray[np.bool_]]:
    """Return the points of body, face, left and right hand, (T, 543, 3) metres in the world.

    Also which of them the body has, (543,): a hand may lack a finger.
    """
    frames = rig.chain.frames(clip.coordinates)
    count = len(clip.times)
    face = np.empty((count, len(FACE), 3))
    for rows, points in face_points(clip, rig):
        face[rows] = points
    lacking = np.full((count, 3), np.nan)

    def joint(bone: str) -> Floats:
        if bone not in rig.bones:
            return lacking
        return np.asarray(frames.positions[:, rig.bones[bone].origin_node])

    def site(name: str) -> Floats:
        return rig.sites[name].point(frames) if name in rig.sites else lacking

    body: dict[str, Floats] = {name: face[:, n] for name, n in OF_FACE.items()}
    legs = leg_points(rig)
    for side, s in SIDES.items():
        body[f"{side}_EYE"] = (body[f"{side}_EYE_INNER"] + body[f"{side}_EYE_OUTER"]) / 2.0
        body[f"{side}_EAR"] = site(f"EAR_{s}")
        for name, bone in JOINTS.items():
            body[f"{side}_{name}"] = joint(bone.format(s))
        for name in LEGS:
            body[f"{side}_{name}"] = np.broadcast_to(legs[f"{side}_{name}"], (count, 3))
    hands = []
    for s in SIDES.values():
        hands.append(joint(f"palm_{s}"))
        for bone, letter, _ in FINGERS.values():
            hands += [joint(f"{bone}_{s}_{k}") for k in (1, 2, 3)]
            hands.append(site(f"{letter}_TIP_{s}"))
    points = np.concatenate(
        [np.stack([body[name] for name in BODY], axis=1), face, np.stack(hands, axis=1)], axis=1
    )
    assert points.shape[1] == len(BODY) + len(FACE) + 2 * len(HAND)
    has = np.asarray(np.isfinite(points).all(axis=(0, 2)))
    return np.where(has[:, None], points, 0.0), has


def leg_points(rig: Rig) -> dict[str, Floats]:
    """Return the points of both legs by name, (3,) metres in the world: they stand still."""
    height = float(rig.landmarks.shoulder_middle[1])
    joints = dict(zip(rig.skeleton.names, rig.skeleton.rest_positions, strict=True))
    found: dict[str, Floats] = {}
    for side, s in SIDES.items():
        mirror = np.array([1.0 if s == "L" else -1.0, 1.0, 1.0])
        for name, share in LEGS.items():
            found[f"{side}_{name}"] = height * mirror * share
        for name, called in LEG_JOINTS.items():
            for pattern in called:
                if (joint := pattern.format(S=s, s=s.lower())) in joints:
                    found[f"{side}_{name}"] = joints[joint]
        ankle = found[f"{side}_ANKLE"]
        for name in ("HEEL", "FOOT_INDEX"):
            away = height * mirror * (np.array(LEGS[name]) - LEGS["ANKLE"])
            found[f"{side}_{name}"] = ankle + away
    return found
