"""The anatomy of an imported body: places for every AZee bone, also for those without joints.

A bone without joints begins where the next one does, so that its turn happens there: a body with
one neck joint nods with that joint. Missing digits get places beside the palm, for the chain only;
they are not reported.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import Anatomy, unit
from azee_rig.build.chain_builder import frame
from azee_rig.chain import DIR, NRM
from azee_rig.importing.bone_map import ARM, DIGITS, PHALANGES, SIDES, TRUNK, BoneMap
from azee_rig.importing.reduced import Reduced
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
Places = dict[str, list[Floats]]

FORWARD = np.array([0.0, 0.0, 1.0])
BENT_DEG, NEAR_DEG = 12.0, 35.0
"""A thumb bent by more gives its plane by its joints, if that is near the usual plane."""
FARTHEST = 95.0
"""The tip of a last phalanx is this percentile of its skin, by distance from its joint."""
LAST_SHARE = 0.8
"""Length of a last phalanx without skin or tip, as a share of the one before."""


@dataclass(frozen=True, eq=False)
class Model:
    """The signer's hands, which give what the joints of other bodies leave open.

    knuckles: places of the digits' joints in the palm's frame, in forearm lengths, by bone.
    thumb: direction of the last phalanx and the nail's outward normal in the palm's frame, by side.
    """

    knuckles: Mapping[str, Floats]
    thumb: Mapping[str, tuple[Floats, Floats]]

    @staticmethod
    def of(signer: Rig) -> Model:
        """Measure the hands of the signer's mesh."""
        at = signer.chain.frames(signer.coordinates.bind)
        knuckles, thumb = {}, {}
        for side in SIDES:
            palm = signer.bones[f"palm_{side}"].node
            R, origin = at.rotations[palm], at.positions[palm]
            for digit in DIGITS:
                for k in PHALANGES:
                    bone = f"{digit}_{side}_{k}"
                    place = at.positions[signer.bones[bone].origin_node] - origin
                    knuckles[bone] = R.T @ place / signer.landmarks.forearm_m
            last = at.rotations[signer.bones[f"thumb_{side}_3"].node]
            thumb[side] = R.T @ last[:, DIR], -(R.T @ last[:, NRM])
        return Model(knuckles, thumb)


def body_anatomy(
    reduced: Reduced,
    bones: BoneMap,
    tips: Mapping[str, Floats],
    eyes: Mapping[str, Floats],
    vertices: Floats,
    model: Model,
) -> Anatomy:
    """Return the anatomy of an upright body.

    Args: tips: ends of digits, if joints mark them. eyes: middle of each eye by side.
    """
    joints: Places = {
        bone: [reduced.place(j) for j in chain] for bone, chain in bones.bones.items()
    }
    _fill([*TRUNK], joints)
    ends: dict[str, Floats] = {}
    nails: dict[str, Floats] = {}
    for side in SIDES:
        _fill([f"{bone}_{side}" for bone in ARM], joints)
        _straighten(joints, side)
        palm = _palm(reduced, bones, joints, vertices, side)
        for digit in DIGITS:
            names = [f"{digit}_{side}_{k}" for k in PHALANGES]
            if not any(name in joints for name in names):
                _invent(joints, names, palm, side, model)
            _fill(names, joints)
            name = f"{digit}_{side}"
            ends[name] = (
                tips[name] if name in tips else _tip(reduced, bones, joints, vertices, name)
            )
        nails[side] = _nail(joints, ends, palm, side, model)
        joints[f"eye_{side}"] = [eyes[side]]
    skull = vertices[reduced.held([bones.bones["head"][0]])]
    top = joints["head"][0] + (0.0, 0.2, 0.0)
    return Anatomy(
        joints=joints,
        tips=ends,
        head_top=skull[skull[:, 1].argmax()] if len(skull) else top,
        gaze=dict.fromkeys(SIDES, FORWARD),
        thumb_nail=nails,
    )


def _fill(chain: list[str], joints: Places) -> None:
    """Let bones without joints begin where the next one does."""
    for bone, following in zip(chain[-2::-1], chain[:0:-1], strict=True):
        if bone not in joints:
            joints[bone] = [joints[following][0]]


def _straighten(joints: Places, side: str) -> None:
    """Move joints inside a limb onto the line between its ends: see `read_anatomy`."""
    for bone, following in (("arm", "f_arm"), ("f_arm", "palm")):
        near, far = joints[f"{bone}_{side}"][0], joints[f"{following}_{side}"][0]
        way = far - near
        joints[f"{bone}_{side}"] = [
            near + way * ((p - near) @ way) / (way @ way) for p in joints[f"{bone}_{side}"]
        ]


def _palm(reduced: Reduced, bones: BoneMap, joints: Places, vertices: Floats, side: str) -> Floats:
    """Return the frame of the palm, columns x (ulnar side), dir, nrm, from knuckles or skin."""
    wrist, elbow = joints[f"palm_{side}"][0], joints[f"f_arm_{side}"][0]
    sign = 1.0 if side == "L" else -1.0
    there = [f"{d}_{side}_1" for d in DIGITS[1:] if f"{d}_{side}_1" in bones.bones]
    if len(there) >= 2:
        knuckles = [joints[bone][0] for bone in there]
        along = np.mean(knuckles, axis=0) - wrist
        return frame(along, np.cross(sign * (knuckles[-1] - knuckles[0]), along))
    flesh = vertices[reduced.held(bones.bones[f"palm_{side}"])]
    along = wrist - elbow
    if len(flesh) >= 8:
        along = flesh.mean(axis=0) - wrist
        _, _, axes = np.linalg.svd(flesh - flesh.mean(axis=0), full_matrices=False)
        normal = axes[2]
    else:
        normal = np.array([-sign, 0.0, 0.0])
    # The palm of a hanging hand faces inward, that of an arm held out faces down.
    d = unit(along)
    facing = np.array([-sign * abs(d[1]), -abs(d[0]) - 0.1, 0.0])
    return frame(along, normal if normal @ facing >= 0.0 else -normal)


def _invent(joints: Places, names: list[str], palm: Floats, side: str, model: Model) -> None:
    wrist, elbow = joints[f"palm_{side}"][0], joints[f"f_arm_{side}"][0]
    size = float(np.linalg.norm(wrist - elbow))
    for name in names:
        joints[name] = [wrist + palm @ (size * model.knuckles[name])]


def _tip(reduced: Reduced, bones: BoneMap, joints: Places, vertices: Floats, digit: str) -> Floats:
    """Return the end of a digit: the middle of the skin that is farthest from its last joint."""
    chain = [joints[f"{digit}_{k}"][0] for k in PHALANGES]
    last = chain[-1]
    joint = bones.bones.get(f"{digit}_3")
    flesh = vertices[reduced.held(joint)] if joint else vertices[:0]
    if len(flesh):
        far = np.linalg.norm(flesh - last, axis=1)
        return np.asarray(flesh[far >= np.percentile(far, FARTHEST)].mean(axis=0))
    before = next((p for p in chain[-2::-1] if np.linalg.norm(last - p) > 1e-6), None)
    if before is None:
        before = joints[f"palm_{digit[-1]}"][0]
    return np.asarray(last + LAST_SHARE * (last - before))


def _nail(
    joints: Places, ends: Mapping[str, Floats], palm: Floats, side: str, model: Model
) -> Floats:
    """Return the outward normal of the thumbnail: the signer's, turned along, or by the joints."""
    chain = [*(joints[f"thumb_{side}_{k}"][0] for k in PHALANGES), ends[f"thumb_{side}"]]
    last = unit(chain[3] - chain[2])
    usual, nail = model.thumb[side]
    nail = palm @ _turned(nail, usual, palm.T @ last)
    before = chain[2] - chain[1]
    if np.linalg.norm(before) > 1e-6:
        axis = np.cross(unit(before), last)
        bend = float(np.linalg.norm(axis))
        if bend > np.sin(np.radians(BENT_DEG)):
            pad = np.cross(axis / bend, last)
            if -pad @ nail > np.cos(np.radians(NEAR_DEG)):
                return np.asarray(-pad)
    return np.asarray(nail)


def _turned(v: Floats, start: Floats, end: Floats) -> Floats:
    """Return v, rotated by the smallest rotation that takes unit vector `start` to `end`."""
    axis, c = np.cross(start, end), float(start @ end)
    if c < -0.999999:
        return v
    return np.asarray(v * c + np.cross(axis, v) + axis * (axis @ v) / (1.0 + c))
