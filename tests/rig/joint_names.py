"""How makers of bodies call joints: a family of names each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Family:
    """How a maker calls the joints.

    back: of the spine, upwards. neck: likewise. arms: clavicle, upper arm, forearm and hand with
    {S} for the side. legs: thigh, calf, foot. digit: with {S}, {D} and {k}, or a list of three.
    digits: words for the five digits. eye: with {S}. sides: words for left and right.
    """

    root: str
    back: Sequence[str]
    neck: Sequence[str]
    head: str
    arms: Sequence[str]
    legs: Sequence[str]
    digit: Sequence[str]
    digits: Sequence[str] = ("Thumb", "Index", "Middle", "Ring", "Pinky")
    eye: str = ""
    sides: Sequence[str] = ("Left", "Right")
    declared: Mapping[str, str] = field(default_factory=dict)


def _mixamo(prefix: str = "", **other: Any) -> Family:
    return Family(
        **{
            "root": f"{prefix}Hips",
            "back": [f"{prefix}Spine", f"{prefix}Spine1", f"{prefix}Spine2"],
            "neck": [f"{prefix}Neck"],
            "head": f"{prefix}Head",
            "arms": [f"{prefix}{{S}}{j}" for j in ("Shoulder", "Arm", "ForeArm", "Hand")],
            "legs": [f"{prefix}{{S}}{j}" for j in ("UpLeg", "Leg", "Foot")],
            "digit": [f"{prefix}{{S}}Hand{{D}}{k}" for k in (1, 2, 3)],
            **other,
        }
    )


_VROID = Family(
    root="J_Bip_C_Hips",
    back=["J_Bip_C_Spine", "J_Bip_C_Chest", "J_Bip_C_UpperChest"],
    neck=["J_Bip_C_Neck"],
    head="J_Bip_C_Head",
    arms=[f"J_Bip_{{S}}_{j}" for j in ("Shoulder", "UpperArm", "LowerArm", "Hand")],
    legs=[f"J_Bip_{{S}}_{j}" for j in ("UpperLeg", "LowerLeg", "Foot")],
    digit=[f"J_Bip_{{S}}_{{D}}{k}" for k in (1, 2, 3)],
    digits=("Thumb", "Index", "Middle", "Ring", "Little"),
    eye="J_Adj_{S}_FaceEye",
    sides=("L", "R"),
)
FAMILIES: Mapping[str, Family] = {
    "mixamo": _mixamo("mixamorig:", eye="mixamorig:{S}Eye"),
    "ready-player-me": _mixamo(eye="{S}Eye"),
    "vroid": _VROID,
    "makehuman": Family(
        root="root",
        back=["spine05", "spine04", "spine03", "spine02", "spine01"],
        neck=["neck01", "neck02", "neck03"],
        head="head",
        arms=[f"{j}.{{S}}" for j in ("clavicle", "upperarm01", "lowerarm01", "wrist")],
        legs=[f"{j}.{{S}}" for j in ("upperleg01", "lowerleg01", "foot")],
        digit=[f"finger{{D}}-{k}.{{S}}" for k in (1, 2, 3)],
        digits=("1", "2", "3", "4", "5"),
        eye="eye.{S}",
        sides=("L", "R"),
    ),
    "motive": Family(
        root="Hip",
        back=["Ab", "Chest"],
        neck=["Neck"],
        head="Head",
        arms=["{S}Shoulder", "{S}UArm", "{S}FArm", "{S}Hand"],
        legs=["{S}Thigh", "{S}Shin", "{S}Foot"],
        digit=[f"{{S}}{{D}}{k}" for k in (1, 2, 3)],
        sides=("L", "R"),
    ),
    "xsens": Family(
        root="Pelvis",
        back=["L5", "L3", "T12", "T8"],
        neck=["Neck"],
        head="Head",
        arms=["{S}Shoulder", "{S}UpperArm", "{S}Forearm", "{S}Hand"],
        legs=["{S}UpperLeg", "{S}LowerLeg", "{S}Foot"],
        digit=["{S}{D}MC|{S}{D}PP", "{S}{D}PP|{S}{D}MP", "{S}{D}DP"],
        digits=("First", "Second", "Third", "Fourth", "Fifth"),
    ),
    "perception-neuron": _mixamo(
        neck=["Neck", "Neck1"], digits=("Thumb", "Index", "Middle", "Ring", "Pinky")
    ),
    "rokoko": _mixamo(
        back=["Spine1", "Spine2", "Spine3", "Spine4"],
        legs=["{S}Thigh", "{S}Shin", "{S}Foot"],
        digit=[
            "{S}Finger{D}Metacarpal|{S}Finger{D}Proximal",
            "{S}Finger{D}Proximal|{S}Finger{D}Medial",
            "{S}Finger{D}Distal",
        ],
        digits=("1", "2", "3", "4", "5"),
    ),
    "smpl-x": Family(
        root="pelvis",
        back=["spine1", "spine2", "spine3"],
        neck=["neck"],
        head="head",
        arms=["{S}_collar", "{S}_shoulder", "{S}_elbow", "{S}_wrist"],
        legs=["{S}_hip", "{S}_knee", "{S}_ankle"],
        digit=[f"{{S}}_{{D}}{k}" for k in (1, 2, 3)],
        digits=("thumb", "index", "middle", "ring", "pinky"),
        eye="{S}_eye_smplhf",
        sides=("left", "right"),
    ),
    "named-after-somebody": Family(
        root="Anna_pelvis",
        back=["Anna_spine01", "Anna_spine02", "Anna_spine03"],
        neck=["Anna_neck"],
        head="Anna_head",
        arms=[f"Anna_{j}_{{S}}" for j in ("clavicle", "upperarm01", "lowerarm01", "hand")],
        legs=[f"Anna_{j}_{{S}}" for j in ("thigh", "calf", "foot")],
        digit=[f"Anna_{{D}}{k}_{{S}}" for k in (1, 2, 3)],
        digits=("thumb", "index", "middle", "ring", "pinky"),
        eye="Anna_eye_{S}",
        sides=("L", "R"),
    ),
}
