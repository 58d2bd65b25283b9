"""A movement as rotations of VRM's bones, each relative to the bone above it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.formats.vrm.humanoid import LEGS, SIDES, TRUNK, bones_of, t_places, t_pose
from azee_rig.chain import DIR
from azee_rig.rig import Rig
from azee_rig.rotation import about_axis, to_quaternions

Floats = NDArray[np.float64]

LEG_SHARES = {"UpperLeg": 1.0, "LowerLeg": 0.55, "Foot": 0.08}
"""Heights of the joints of legs, as shares of the height of the hips."""
HIP_WIDTH = 0.1
"""From the middle to the joint of a leg, as a share of the height of the hips."""


@dataclass(frozen=True, eq=False)
class HumanMotion:
    """Motion of a VRM humanoid that stands in the T-pose at rest, axes as the world's.

    offsets: by bone (3,) metres from the bone above, of the hips from the world's origin.
    rotations: by bone (T, 4) wxyz relative to the bone above. gaze: (T, 4) of the eyes relative to
    the head. eyes: (3,) middle of the eyes from the head.
    """

    offsets: Mapping[str, Floats]
    rotations: Mapping[str, Floats]
    gaze: Floats
    eyes: Floats


def human_motion(clip: Clip, rig: Rig) -> HumanMotion:
    """Return a clip as motion of a VRM humanoid.

    Half of a forearm's pronation is given to the lower arm and half to the hand, which ends as it
    was. A bone that stands for several joints of the spine points to where the next one is.
    """
    still = t_pose(rig)
    places = t_places(rig, still)
    at = rig.chain.frames(clip.coordinates)
    bones = bones_of(rig)
    hips = places[rig.bones["back_1"].origin_node]
    rest = {"hips": np.asarray(hips), **_legs(hips)}
    there = {"hips": np.broadcast_to(hips, (len(clip.times), 3))}
    turned = {"hips": np.broadcast_to(np.eye(3), (len(clip.times), 3, 3))}
    for name, bone in bones.items():
        if bone.azee is None:
            turned[name] = turned["hips"]
            continue
        nodes = rig.bones[bone.azee]
        rest[name] = places[nodes.origin_node]
        there[name] = at.positions[:, nodes.origin_node]
        turn = at.rotations[:, nodes.node]
        if name.endswith("LowerArm"):
            turn = turn @ about_axis(DIR, -_half_pronation(clip, rig, still, name))
        turned[name] = turn @ still[nodes.node].T
    for name, following in pairwise(TRUNK):
        offset = rest[following] - rest[name]
        turned[name] = _aimed(turned[name], offset, there[following] - there[name])
    rotations = {}
    for name, bone in bones.items():
        above = turned["hips"] if bone.parent is None else turned[bone.parent]
        rotations[name] = to_quaternions(np.swapaxes(above, -1, -2) @ turned[name])
    offsets = {
        name: rest[name] if bone.parent is None else rest[name] - rest[bone.parent]
        for name, bone in bones.items()
    }
    eyes = [rig.bones[f"eye_{side}"].node for side in SIDES.values()]
    middle = places[eyes].mean(axis=0) - rest["head"]
    return HumanMotion(offsets, rotations, _gaze(rig, at.rotations, still, turned["head"]), middle)


def _legs(hips: Floats) -> dict[str, Floats]:
    found = {}
    for word, side in SIDES.items():
        across = (1.0 if side == "L" else -1.0) * HIP_WIDTH * hips[1]
        for name in LEGS:
            found[f"{word}{name}"] = np.array([across, LEG_SHARES[name] * hips[1], hips[2]])
    return found


def _half_pronation(clip: Clip, rig: Rig, still: Floats, name: str) -> Floats:
    """Half of the turn of a forearm about itself since the T-pose, (T,) radians."""
    side = SIDES["left" if name.startswith("left") else "right"]
    index = rig.coordinates.index[f"f_arm_{side}.pronation"]
    chain, node = rig.chain, rig.bones[f"f_arm_{side}"].node
    dofs = range(int(chain.dof_start[node]), int(chain.dof_start[node + 1]))
    scale = next(
        float(chain.dof_scale[d])
        for d in dofs
        if chain.dof_coordinate[d] == index and chain.dof_axis[d] == DIR
    )
    M = (still[chain.parents[node]] @ chain.zero[node]).T @ still[node]
    in_t_pose = float(np.arctan2(M[0, 2], M[2, 2]))
    return np.asarray(0.5 * (scale * clip.coordinates[:, index] - in_t_pose))


def _aimed(turns: Floats, offset: Floats, wanted: Floats) -> Floats:
    """Turn rotations (T, 3, 3) on, by the least, so that an offset points to (T, 3)."""
    now = turns @ offset
    a = now / np.linalg.norm(now, axis=-1, keepdims=True)
    b = wanted / np.linalg.norm(wanted, axis=-1, keepdims=True)
    axis = np.cross(a, b)
    K = np.zeros((*a.shape, 3))
    K[..., 0, 1], K[..., 0, 2], K[..., 1, 2] = -axis[..., 2], axis[..., 1], -axis[..., 0]
    K -= np.swapaxes(K, -1, -2)
    cosine = (a * b).sum(axis=-1)[..., None, None]
    return np.asarray((np.eye(3) + K + K @ K / (1.0 + cosine)) @ turns)


def _gaze(rig: Rig, frames: Floats, still: Floats, head: Floats) -> Floats:
    """Rotation of both eyes' mean direction relative to the head, (T, 4) wxyz: yaw, then pitch."""
    eyes = [rig.bones[f"eye_{side}"].node for side in SIDES.values()]
    turns = frames[:, eyes] @ np.swapaxes(still[eyes], -1, -2)
    ahead = np.einsum("tba,tsb->tsa", head, turns[..., 2]).mean(axis=1)
    yaw = np.arctan2(ahead[:, 0], ahead[:, 2])
    pitch = -np.arctan2(ahead[:, 1], np.hypot(ahead[:, 0], ahead[:, 2]))
    return to_quaternions(about_axis(1, yaw) @ about_axis(0, pitch))
