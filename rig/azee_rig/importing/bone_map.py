"""The bones-map of a body: which of its joints AZee's bones are.

It is what a user may correct: `azee rig import` writes its proposal as JSON, and takes one.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from azee_rig.fields import mapping, names, text
from azee_rig.importing.fault import BodyError
from azee_rig.importing.skeleton_tree import Tree

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
TURNING = tuple(f"{bone}_{s}" for s in SIDES for bone in ("arm", "f_arm"))
"""Bones whose turn further joints may share."""
DIGIT_NAMES = tuple(f"{digit}_{s}" for s in SIDES for digit in DIGITS)
LIMBS = (
    TRUNK,
    *(("back_1", "back_2", *(f"{bone}_{s}" for bone in ARM)) for s in SIDES),
    *((f"palm_{s}", *(f"{d}_{s}_{k}" for k in PHALANGES)) for s in SIDES for d in DIGITS),
    *(("head", f"eye_{s}") for s in SIDES),
)
"""Bones of which each hangs on the one before, where both are there."""


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
        bones = mapping(mapping(content, "the whole file")["bones"], "bones")
        root = content.get("root") or ""
        return BoneMap(
            {
                bone: chain
                for bone, joints in bones.items()
                if (chain := _chain("bones", bone, joints))
            },
            text(root, "root"),
            {
                bone: _chain("twists", bone, joints)
                for bone, joints in mapping(content.get("twists", {}), "twists").items()
            },
            {
                digit: text(joint, f"tips.{digit}")
                for digit, joint in mapping(content.get("tips", {}), "tips").items()
            },
            names(content.get("kept", []), "kept"),
            "given",
        )
    except OSError as error:
        raise BodyError("body-map", f"cannot read the bones-map `{path}`") from error
    except KeyError as error:
        raise _no_map(path, f"{error} is missing") from error
    except json.JSONDecodeError as error:
        raise _no_map(path, f"its JSON ends or goes wrong in line {error.lineno}") from error
    except (UnicodeDecodeError, RecursionError) as error:
        raise _no_map(path, "it is no JSON, or nested too deeply") from error
    except ValueError as error:
        raise _no_map(path, str(error)) from error


def _no_map(path: Path, reason: str) -> BodyError:
    return BodyError(
        "body-map",
        f"`{path}` is not a bones-map",
        reason,
        help_="`azee rig import BODY.glb --propose MAP.json` writes one to start from",
    )


def _chain(group: str, bone: str, joints: object) -> tuple[str, ...]:
    """Names of joints; null is none, and a single name may stand without a list."""
    if joints is None:
        return ()
    return names([joints] if isinstance(joints, str) else joints, f"{group}.{bone}")


def check_bone_map(found: BoneMap, tree: Tree) -> None:
    """Hold a user's map against a body. Raises: BodyError: it names the entry that is wrong."""
    unknown = [bone for bone in found.bones if bone not in BONES]
    if unknown:
        raise _wrong(f"AZee has no bone {', '.join(f'`{b}`' for b in unknown)}")
    for group, known in (("twists", TURNING), ("tips", DIGIT_NAMES)):
        for key in getattr(found, group):
            if key not in known:
                raise _wrong(f"`{group}` has no place for `{key}`: it takes {', '.join(known)}")
    entries = [
        *((f"bones.{bone}", j) for bone, chain in found.bones.items() for j in chain),
        *((f"twists.{bone}", j) for bone, chain in found.twists.items() for j in chain),
        *((f"tips.{digit}", j) for digit, j in found.tips.items()),
    ]
    named = [*entries, *(("kept", j) for j in found.kept)]
    named += [("root", found.root)] if found.root else []
    missing = dict.fromkeys((j, entry) for entry, j in named if j not in tree.names)
    if missing:
        shown = ", ".join(f"`{j}` (`{entry}`)" for j, entry in [*missing][:6])
        raise _wrong(f"the body has no joint {shown}")
    _check_once(entries)
    _check_order(found, tree)


def _wrong(message: str, *notes: str) -> BodyError:
    return BodyError("body-map", message, *notes)


def _check_once(entries: Sequence[tuple[str, str]]) -> None:
    """Hold every joint to one bone, and a tip to none."""
    first: dict[str, str] = {}
    for entry, joint in entries:
        other = first.setdefault(joint, entry)
        if other != entry and entry.startswith("tips"):
            raise _wrong(
                f"joint `{joint}` stands for `{other}` and for `{entry}`",
                "a tip is a joint beyond the last phalanx, or is left out",
            )
        if other != entry:
            raise _wrong(f"joint `{joint}` stands for two bones, `{other}` and `{entry}`")


def _check_order(found: BoneMap, tree: Tree) -> None:
    """Hold every bone to hang below the one before it, and all below the root."""
    number = {name: j for j, name in enumerate(tree.names)}
    for limb in LIMBS:
        chain = [(f"bones.{b}", j) for b in limb for j in found.bones.get(b, ())]
        digit = limb[-1].rpartition("_")[0]
        if digit in found.tips and len(chain) > 1:
            chain.append((f"tips.{digit}", found.tips[digit]))
        for (before, upper), (entry, joint) in pairwise(chain):
            if tree.common(number[upper], number[joint]) != number[upper]:
                raise _wrong(
                    f"`{entry}` is `{joint}`, which does not hang on `{upper}` (`{before}`)",
                    "the two may be swapped: joints are listed from the trunk outwards",
                )
    root = number[found.root] if found.root else 0
    groups = [("bones", found.bones), ("twists", found.twists), ("kept", {"": found.kept})]
    for group, chains in groups:
        for key, joints in chains.items():
            for joint in joints:
                if tree.common(root, number[joint]) != root:
                    entry = f"{group}.{key}".rstrip(".")
                    raise _wrong(
                        f"`{joint}` (`{entry}`) does not hang on the root, `{tree.names[root]}`"
                    )
