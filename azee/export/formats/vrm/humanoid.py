"""AZee's bones as those of a VRM humanoid, and VRM's T-pose on our chain.

VRM counts rotations from a T-pose: upright, arms along ±X, palms down. Each node of the chain has a
frame there, and a bone's rotation in a posture is F(t) · F(T)ᵀ, in axes of the world. Trunk, head
and thumbs stand in the T-pose as in the body's own posture.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig

Floats = NDArray[np.float64]

SIDES = {"left": "L", "right": "R"}
LEGS = ("UpperLeg", "LowerLeg", "Foot")
"""Bones of legs, which VRM asks for; they stand still."""
_DIGITS = {
    "Thumb": ("thumb", ("Metacarpal", "Proximal", "Distal")),
    "Index": ("index", ("Proximal", "Intermediate", "Distal")),
    "Middle": ("middle", ("Proximal", "Intermediate", "Distal")),
    "Ring": ("ring", ("Proximal", "Intermediate", "Distal")),
    "Little": ("little", ("Proximal", "Intermediate", "Distal")),
}
TRUNK = {"spine": "back_1", "chest": "back_2", "neck": "neck", "head": "head"}


@dataclass(frozen=True, slots=True)
class HumanBone:
    """A bone of VRM: the bone above it, none for the hips, and AZee's bone, none for the legs."""

    parent: str | None
    azee: str | None


def _bones() -> dict[str, HumanBone]:
    found = {"hips": HumanBone(None, None)}
    above = "hips"
    for name, bone in TRUNK.items():
        found[name] = HumanBone(above, bone)
        above = name
    for word, side in SIDES.items():
        above = "hips"
        for name in LEGS:
            found[f"{word}{name}"] = HumanBone(above, None)
            above = f"{word}{name}"
        above = "chest"
        arm = {"Shoulder": "clav", "UpperArm": "arm", "LowerArm": "f_arm", "Hand": "palm"}
        for name, bone in arm.items():
            found[f"{word}{name}"] = HumanBone(above, f"{bone}_{side}")
            above = f"{word}{name}"
        for finger, (digit, parts) in _DIGITS.items():
            above = f"{word}Hand"
            for k, part in enumerate(parts, 1):
                name = f"{word}{finger}{part}"
                found[name] = HumanBone(above, f"{digit}_{side}_{k}")
                above = name
    return found


HUMAN_BONES: Mapping[str, HumanBone] = _bones()
"""Bones of a VRM humanoid by its names, each after the one above it."""


def bones_of(rig: Rig) -> dict[str, HumanBone]:
    """Return the bones that a body has; digits may be lacking."""
    return {n: b for n, b in HUMAN_BONES.items() if b.azee is None or b.azee in rig.bones}


def t_pose(rig: Rig) -> Floats:
    """Return the frames (B, 3, 3) of the nodes of the chain in VRM's T-pose, in the world."""
    own = rig.chain.frames(rig.coordinates.bind).rotations
    frames = np.array(own)
    for side, sign in (("L", 1.0), ("R", -1.0)):
        out, down, ahead = np.array([[sign, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]])
        hand = _frame(out, down)
        # Elbows bend forwards: the hinge, x of the forearm, is upright, so nrm looks ahead.
        straight = {"arm": _frame(out, ahead), "f_arm": _frame(out, down), "palm": hand}
        palm = rig.bones[f"palm_{side}"].node
        for bone, frame in straight.items():
            frames[rig.bones[f"{bone}_{side}"].node] = frame
        for digit in ("thumb", "index", "middle", "ring", "little"):
            for k in (1, 2, 3):
                nodes = rig.bones.get(f"{digit}_{side}_{k}")
                if nodes is None:
                    continue
                thumb = digit == "thumb"
                frames[nodes.node] = hand @ own[palm].T @ own[nodes.node] if thumb else hand
    return frames


def _frame(along: Floats, normal: Floats) -> Floats:
    """Columns x, dir, nrm of a frame."""
    return np.stack([np.cross(along, normal), along, normal], axis=1)


def t_places(rig: Rig, frames: Floats) -> Floats:
    """Return the origins (B, 3) of the chain's nodes in the T-pose, metres in the world."""
    places = np.array(rig.chain.offsets)
    for node, parent in enumerate(rig.chain.parents):
        if parent >= 0:
            places[node] = places[parent] + frames[parent] @ rig.chain.offsets[node]
    return places
