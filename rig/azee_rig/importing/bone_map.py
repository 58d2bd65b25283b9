"""The bones-map of a body: which of its joints AZee's bones are.

It is what a user may correct: `azee rig import` writes its proposal as JSON, and takes one.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from azee_rig.importing.fault import BodyError

SIDES = ("L", "R")
DIGITS = ("thumb", "index", "middle", "ring", "little")
PHALANGES = (1, 2, 3)
TRUNK = ("back_1", "back_2", "neck", "head")
ARM = ("clav", "arm", "f_arm", "palm")
LEGS = ("thigh", "calf", "foot")
"""Joints of a leg: AZee has no bones there, but a body stands on them."""
BONES = (
    *TRUNK,
    *(f"{bone}_{s}" for s in SIDES for bone in ARM),
    *(f"{digit}_{s}_{k}" for s in SIDES for digit in DIGITS for k in PHALANGES),
    *(f"eye_{s}" for s in SIDES),
)
"""AZee's 44 bones: those that a bones-map may name."""
NEEDED = ("head", *(f"{bone}_{s}" for s in SIDES for bone in ARM[1:]))
"""Without these no body signs."""


@dataclass(frozen=True, eq=False)
class BoneMap:
    """Joints, by name, of each AZee bone.

    bones: proximal first; a bone without joints is not there. twists: joints that share a limb's
    turn without carrying what lies beyond, by bone. tips: joints that mark where a digit ends, by
    digit, such as `index_L`. root: the pelvis. kept: further joints that stay in the skeleton.
    family: how the map was found.
    """

    bones: Mapping[str, tuple[str, ...]]
    root: str
    twists: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    tips: Mapping[str, str] = field(default_factory=dict)
    kept: tuple[str, ...] = ()
    family: str = "given"

    @property
    def lacking(self) -> tuple[str, ...]:
        """Bones without which no body signs, and which it has not."""
        return tuple(bone for bone in NEEDED if bone not in self.bones)

    def digits(self, side: str) -> tuple[str, ...]:
        """Digits of a hand that have joints of their own."""
        return tuple(d for d in DIGITS if any(f"{d}_{side}_{k}" in self.bones for k in PHALANGES))

    def as_json(self) -> dict[str, Any]:
        """Return it as a user may edit it; bones without joints have an empty list."""
        return {
            "about": "Joints of the body for each of AZee's bones, from the trunk outwards. "
            "Correct it and give it to `azee rig import` with --map.",
            "family": self.family,
            "root": self.root,
            "bones": {bone: list(self.bones.get(bone, ())) for bone in BONES},
            "twists": {bone: list(joints) for bone, joints in self.twists.items()},
            "tips": dict(self.tips),
            "kept": list(self.kept),
        }


def read_bone_map(path: Path) -> BoneMap:
    """Read a map that a user wrote or corrected. Raises: BodyError: it is none."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return BoneMap(
            {bone: tuple(chain) for bone, chain in content["bones"].items() if chain},
            content.get("root") or "",
            {bone: tuple(chain) for bone, chain in content.get("twists", {}).items()},
            dict(content.get("tips", {})),
            tuple(content.get("kept", ())),
            "given",
        )
    except OSError as error:
        raise BodyError("body-map", f"cannot read the bones-map `{path}`") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise BodyError(
            "body-map",
            f"`{path}` is not a bones-map",
            help_="`azee rig import BODY.glb --propose MAP.json` writes one to start from",
        ) from error


def check_bone_map(found: BoneMap, joints: Sequence[str]) -> None:
    """Hold a user's map against a body. Raises: BodyError: it names what is not there."""
    unknown = [bone for bone in found.bones if bone not in BONES]
    if unknown:
        raise BodyError("body-map", f"AZee has no bone {', '.join(f'`{b}`' for b in unknown)}")
    used = [
        *(j for chain in found.bones.values() for j in chain),
        *(j for chain in found.twists.values() for j in chain),
    ]
    named = [*used, *found.tips.values(), *found.kept, *([found.root] if found.root else [])]
    missing = sorted({j for j in named if j not in joints}, key=str)
    if missing:
        shown = ", ".join(f"`{j}`" for j in missing[:6])
        raise BodyError("body-map", f"the body has no joint {shown}")
    twice = sorted({j for j in used if used.count(j) > 1})
    if twice:
        raise BodyError("body-map", f"joint `{twice[0]}` stands for two bones")
