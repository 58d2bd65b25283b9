"""A body that ships as a VRM 1.0 avatar.

The mesh and its binding are those of a GLB; only the nodes stand in VRM's T-pose. So the skin
bends on the avatar as it does on the body, but for joints that share a neighbour's turn: VRM has
none of these, and they follow the joint above.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.export.files import replace_file
from azee.export.formats.gltf.document import Document
from azee.export.formats.gltf.mesh import add_mesh
from azee.export.formats.gltf.skin import add_joints, add_skin
from azee.export.formats.vrm.expressions import expression
from azee.export.formats.vrm.humanoid import LEGS, SIDES, bones_of, t_pose
from azee_rig.rig import SHIPPED, Rig
from azee_rig.rotation import part_turn, to_quaternions

Floats = NDArray[np.float64]

EXTENSION = "VRMC_vrm"
META = {
    "version": "1.0",
    "authors": ["azee", "MakeHuman"],
    "licenseUrl": "https://vrm.dev/licenses/1.0/",
    "otherLicenseUrl": "https://creativecommons.org/publicdomain/zero/1.0/",
    "avatarPermission": "everyone",
    "allowExcessivelyViolentUsage": False,
    "allowExcessivelySexualUsage": False,
    "commercialUsage": "corporation",
    "allowPoliticalOrReligiousUsage": True,
    "allowAntisocialOrHateUsage": False,
    "creditNotation": "unnecessary",
    "allowRedistribution": True,
    "modification": "allowModificationRedistribution",
}
"""What VRM asks every file to say; the bodies are CC0."""
LEG_JOINTS = {
    "UpperLeg": ("upperleg01.{S}", "thigh_{s}"),
    "LowerLeg": ("lowerleg01.{S}", "calf_{s}"),
    "Foot": ("foot.{S}", "foot_{s}"),
}
"""Joints of legs, as the bodies that ship call them."""
MIXED: dict[str, dict[str, float]] = {
    "happy": {"mouthSmileLeft": 0.8, "mouthSmileRight": 0.8},
    "angry": {"browDownLeft": 1.0, "browDownRight": 1.0},
    "sad": {"mouthFrownLeft": 0.8, "mouthFrownRight": 0.8, "browInnerUp": 0.7},
    "surprised": {"browOuterUpLeft": 1.0, "browOuterUpRight": 1.0, "jawOpen": 0.3},
    "ih": {"mouthStretchLeft": 0.6, "mouthStretchRight": 0.6},
    "ee": {"mouthSmileLeft": 0.5, "mouthSmileRight": 0.5, "jawOpen": 0.1},
}
"""Presets of VRM that are several face units."""
GAZE = {"inputMaxValue": 90.0, "outputScale": 90.0}
"""Eyes turn by as much as is asked, degrees."""


class NoAvatarError(ValueError):
    """A body of which no avatar can be made. The message is for the user."""


def write_vrm(rig: Rig, path: str | Path) -> None:
    """Write a body as a VRM 1.0 avatar in the T-pose.

    Raises: NoAvatarError: it does not ship. OSError: the file cannot be written.
    """
    if rig.folder.parent != SHIPPED:
        raise NoAvatarError(
            f"`{rig.name}` does not ship: only its makers can say how an avatar of it may be used"
        )
    document = Document(generator="azee")
    nodes = add_joints(document, rig.skeleton)
    for node, turn in zip(nodes, _rest_turns(rig), strict=True):
        document.objects["nodes"][node]["rotation"] = np.roll(turn, -1).tolist()
    mesh = add_mesh(document, rig.mesh, rig.name)
    skin = add_skin(document, rig.skeleton, nodes)
    body = document.add("nodes", name=f"{rig.name}_mesh", mesh=mesh, skin=skin)
    roots = [n for n, p in zip(nodes, rig.skeleton.parents, strict=True) if p < 0]
    scene = document.add("scenes", name=rig.name, nodes=[*roots, body])
    extension = {
        "specVersion": "1.0",
        "meta": {"name": f"azee {rig.name}", **META},
        "humanoid": {
            "humanBones": {bone: {"node": nodes[j]} for bone, j in human_joints(rig).items()}
        },
        "expressions": _expressions(rig, body),
        "lookAt": {
            "type": "bone",
            "offsetFromHeadBone": _eyes_from_head(rig),
            **{
                f"rangeMap{way}": GAZE
                for way in ("HorizontalInner", "HorizontalOuter", "VerticalDown", "VerticalUp")
            },
        },
    }
    with replace_file(path) as file:
        file.writelines(
            document.glb_parts(
                scene=scene, extensionsUsed=[EXTENSION], extensions={EXTENSION: extension}
            )
        )


def human_joints(rig: Rig) -> dict[str, int]:
    """Return the joints of a body that ships by VRM's names of bones."""
    names = rig.skeleton.names
    found: dict[str, int] = {}
    for bone, human in bones_of(rig).items():
        if human.azee is not None:
            node = rig.bones[human.azee].origin_node
            found[bone] = int(np.flatnonzero(rig.drive.node == node)[0])
    found["hips"] = int(rig.skeleton.parents[found["spine"]])
    for word, side in SIDES.items():
        found[f"{word}Eye"] = int(
            np.flatnonzero(rig.drive.node == rig.bones[f"eye_{side}"].node)[0]
        )
        for leg in LEGS:
            called = [name.format(S=side, s=side.lower()) for name in LEG_JOINTS[leg]]
            found[f"{word}{leg}"] = next(names.index(name) for name in called if name in names)
    return found


def _rest_turns(rig: Rig) -> Floats:
    """Return the joints' rotations in the T-pose relative to their parents, (J, 4) wxyz."""
    frames, drive, parents = t_pose(rig), rig.drive, rig.skeleton.parents
    world = np.tile(np.eye(3), (len(parents), 1, 1))
    local = np.tile([1.0, 0.0, 0.0, 0.0], (len(parents), 1))
    for joint, node in enumerate(drive.node):
        parent = parents[joint]
        above = world[parent] if parent >= 0 else np.eye(3)
        world[joint] = frames[node] @ drive.bind[node].T if node >= 0 else above
        local[joint] = to_quaternions(above.T @ world[joint])
    for helper in np.flatnonzero(drive.helper_of >= 0):
        local[helper] = part_turn(local[drive.helper_of[helper]], float(drive.helper_share[helper]))
    return local


def _expressions(rig: Rig, body: int) -> dict[str, Any]:
    """Return presets and custom expressions: every face unit is one of them."""
    index = {unit: n for n, unit in enumerate(rig.mesh.units)}

    def shown(weights: dict[str, float]) -> dict[str, Any]:
        binds = [
            {"node": body, "index": index[unit], "weight": weight}
            for unit, weight in weights.items()
            if unit in index
        ]
        return {"morphTargetBinds": binds}

    groups: dict[str, dict[str, Any]] = {"preset": {}, "custom": {}}
    for unit in rig.mesh.units:
        kind, name = expression(unit)
        # A unit that AZee's morphs use comes last, and is the one that counts.
        used = any(unit in weights for weights in rig.face_morphs.values())
        if name not in groups[kind] or used:
            groups[kind][name] = shown({unit: 1.0})
    for name, weights in MIXED.items():
        groups["preset"][name] = shown(weights)
    return groups


def _eyes_from_head(rig: Rig) -> list[float]:
    at = rig.chain.frames(rig.coordinates.bind)
    eyes = at.positions[[rig.bones[f"eye_{side}"].node for side in SIDES.values()]].mean(axis=0)
    away = eyes - at.positions[rig.bones["head"].origin_node]
    return [round(float(x), 6) for x in away]
