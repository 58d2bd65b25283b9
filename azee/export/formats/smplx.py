"""A clip as pose parameters of SMPL-X (Pavlakos et al. 2019): parameters only, never the model.

Axis-angle rotations of its 55 joints relative to the joint above, from its T-pose, as files of
AMASS hold them. Shape and expression belong to the model and are zero; so are legs, jaw and eyes,
which our movements do not turn or turn by skin.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.clip.resample import at_rate, rate
from azee.export.formats.vrm.turns import human_motion
from azee.export.npz import write_npz
from azee_rig.rig import Rig
from azee_rig.rotation import rotation_vectors, to_matrices

Floats = NDArray[np.float64]

_BODY = (
    *("pelvis", "left_hip", "right_hip", "spine1", "left_knee", "right_knee", "spine2"),
    *("left_ankle", "right_ankle", "spine3", "left_foot", "right_foot", "neck"),
    *("left_collar", "right_collar", "head", "left_shoulder", "right_shoulder"),
    *("left_elbow", "right_elbow", "left_wrist", "right_wrist"),
)
_FACE = ("jaw", "left_eye", "right_eye")
_FINGERS = ("index", "middle", "pinky", "ring", "thumb")
_HANDS = tuple(f"{side}_{f}{k}" for side in ("left", "right") for f in _FINGERS for k in (1, 2, 3))
JOINTS = (*_BODY, *_FACE, *_HANDS)
"""The 55 joints of SMPL-X in its order."""
SHAPES = 16
"""Shape parameters, all zero."""
FPS = 30.0
"""Frames a second of a clip whose own are not even."""


def _humans() -> dict[str, str]:
    found = {"spine1": "spine", "spine3": "chest", "neck": "neck", "head": "head"}
    parts = {"collar": "Shoulder", "shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand"}
    names = {"pinky": "Little"}
    for side in ("left", "right"):
        found |= {f"{side}_{joint}": f"{side}{bone}" for joint, bone in parts.items()}
        for finger in _FINGERS:
            bone = names.get(finger, finger.title())
            first = "Metacarpal" if finger == "thumb" else "Proximal"
            second = "Proximal" if finger == "thumb" else "Intermediate"
            for k, part in enumerate((first, second, "Distal"), 1):
                found[f"{side}_{finger}{k}"] = f"{side}{bone}{part}"
    return found


HUMAN = _humans()
"""Bones of a VRM humanoid by SMPL-X' joints; the others stay as in the T-pose."""


def write_smplx(clip: Clip, rig: Rig, path: str | Path) -> None:
    """Write the parameters, even in time. docs/formats.md lists the arrays.

    Raises: OSError: the file cannot be written.
    """
    fps = (rate(clip) or FPS) if len(clip.times) > 1 else FPS
    even = clip if rate(clip) else at_rate(clip, fps, rig.coordinates)
    motion = human_motion(even, rig)
    poses = np.zeros((len(even.times), len(JOINTS), 3))
    for n, joint in enumerate(JOINTS):
        turns = motion.rotations.get(HUMAN.get(joint, ""))
        if turns is not None:
            poses[:, n] = rotation_vectors(to_matrices(turns))
    flat = poses.reshape(len(poses), -1)
    body, face = 3 * len(_BODY), 3 * (len(_BODY) + len(_FACE))
    write_npz(
        {
            "surface_model_type": np.array("smplx"),
            "gender": np.array("neutral"),
            "mocap_frame_rate": np.array(fps),
            "betas": np.zeros(SHAPES),
            "trans": np.zeros((len(flat), 3)),
            "poses": flat,
            "root_orient": flat[:, :3],
            "pose_body": flat[:, 3:body],
            "pose_jaw": flat[:, body : body + 3],
            "pose_eye": flat[:, body + 3 : face],
            "pose_hand": flat[:, face:],
        },
        path,
    )
