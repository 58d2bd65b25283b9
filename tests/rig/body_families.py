"""Small skinned bodies as GLB files, under the joint names of many makers.

All are the body that ships as `game`, its mesh thinned out, in another posture, another unit and
other axes, on the joints that a family has. What the importer must find is known: `Body.bones`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from glb_file import GlbFile
from joint_names import Family
from numpy.typing import NDArray

from azee.export.formats.gltf.document import Document
from azee_rig.load import load_rig
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

DIGITS = {"thumb": "thumb", "index": "index", "middle": "middle", "ring": "ring", "little": "pinky"}
SIDES = {"L": "l", "R": "r"}
CELL_M, FINE_M = 0.03, 0.009
"""Vertices within such a cell are one: on the body, and on hands and head."""
EYE_PART = "eyes"
VRM_WORDS = {
    "palm": "Hand",
    "arm": "UpperArm",
    "f_arm": "LowerArm",
    "clav": "Shoulder",
}


@dataclass(frozen=True, eq=False)
class Body:
    """A body on its way into a file: joints with parents and places, vertices with weights (N, J).

    bones: what each joint is, by AZee bone. units: rows and deltas of morph targets, by name.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    places: Floats
    vertices: Floats
    triangles: Ints
    weights: Floats
    bones: Mapping[str, tuple[str, ...]]
    parts: Sequence[tuple[str, int, int]]
    units: Mapping[str, tuple[Ints, Floats]]

    def file(self, *, unit: float = 1.0, up: str = "y", units: Mapping[str, str] = {}) -> GlbFile:
        """Write it. units: names of the file's morph targets, with the unit that each is."""
        turn = np.eye(3) if up == "y" else np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
        turn = turn / unit
        document = Document("families")
        places, vertices = self.places @ turn.T, self.vertices @ turn.T
        children: list[list[int]] = [[] for _ in self.names]
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                children[parent].append(joint)
        for joint, name in enumerate(self.names):
            parent = self.parents[joint]
            offset = places[joint] - (places[parent] if parent >= 0 else 0.0)
            document.add(
                "nodes", name=name, translation=offset.tolist(), children=children[joint] or None
            )
        inverse = np.tile(np.eye(4, dtype=np.float32), (len(places), 1, 1))
        inverse[:, 3, :3] = -places
        skin = document.add(
            "skins",
            joints=list(range(len(places))),
            inverseBindMatrices=document.accessor(inverse.reshape(-1, 16)),
        )
        order = np.argsort(-self.weights, axis=1, kind="stable")[:, :4]
        weights = np.take_along_axis(self.weights, order, axis=1)
        attributes = {
            "POSITION": document.accessor(vertices.astype(np.float32), bounds=True),
            "JOINTS_0": document.accessor(order.astype(np.uint16)),
            "WEIGHTS_0": document.accessor(
                (weights / weights.sum(axis=1, keepdims=True)).astype(np.float32)
            ),
        }
        targets = []
        for target in units.values():
            rows, deltas = self.units[target]
            moved = np.zeros((len(vertices), 3), np.float32)
            moved[rows] = deltas @ turn.T
            targets.append({"POSITION": document.accessor(moved, bounds=True)})
        primitives = [
            {
                "attributes": attributes,
                "indices": document.accessor(self.triangles[start:stop].ravel().astype(np.uint32)),
                "material": document.add("materials", name=name),
                **({"targets": targets} if targets else {}),
            }
            for name, start, stop in self.parts
            if stop > start
        ]
        extras = {"targetNames": list(units)} if units else None
        mesh = document.add("meshes", primitives=primitives, extras=extras)
        node = document.add("nodes", name="Body", mesh=mesh, skin=skin)
        top = {"scene": 0, "scenes": [{"nodes": [self.parents.index(-1), node]}]}
        data = document.to_glb(**top)
        return GlbFile.of(data)


@cache
def _thinned() -> tuple[Rig, Ints, Ints, Sequence[tuple[str, int, int]]]:
    """Return the body, the vertices that are kept, and triangles on these, part after part."""
    rig = load_rig("game")
    mesh = rig.mesh
    joints = rig.skeleton.names
    fine = [j for j, name in enumerate(joints) if _is_fine(name)]
    is_fine = mesh.dense_weights[:, fine].sum(axis=1) > 0.5
    cell = np.where(is_fine, FINE_M, CELL_M)
    of_part = np.zeros(len(mesh.vertices))
    for number, part in enumerate(mesh.parts):
        of_part[mesh.triangles[part.start : part.stop]] = number
    key = np.column_stack([np.round(mesh.vertices / cell[:, None]), is_fine, of_part])
    _, first, cluster = np.unique(key, axis=0, return_index=True, return_inverse=True)
    triangles = cluster.ravel()[mesh.triangles]
    sound = (
        (triangles[:, 0] != triangles[:, 1])
        & (triangles[:, 1] != triangles[:, 2])
        & (triangles[:, 2] != triangles[:, 0])
    )
    rows: list[Ints] = []
    parts: list[tuple[str, int, int]] = []
    for part in mesh.parts:
        kept = triangles[part.start : part.stop][sound[part.start : part.stop]]
        start = sum(len(row) for row in rows)
        parts.append((part.name, start, start + len(kept)))
        rows.append(kept)
    return rig, first, np.vstack(rows), parts


def _is_fine(joint: str) -> bool:
    return joint in ("head", "eye_L", "eye_R") or joint.startswith(
        ("hand", "thumb", "index", "middle", "ring", "pinky")
    )


def make_body(
    family: Family,
    *,
    fingers: bool = True,
    eyes: bool = True,
    pose: str = "t",
    prefix: str = "",
) -> Body:
    """Make the body of a family. pose: `t` or `a`. prefix: before every joint's name."""
    rig, kept, triangles, parts = _thinned()
    q = np.array(rig.coordinates.bind)
    if pose == "a":
        arms = [i for i, n in enumerate(rig.coordinates.names) if n.startswith("arm_")]
        q[arms] = 0.5 * (q[arms] + rig.coordinates.idle[arms])
    posture = rig.pose(q)
    at = dict(zip(rig.skeleton.names, rig.joint_positions(posture), strict=True))
    vertices = rig.skin(posture)[kept]
    names: list[str] = []
    parents: list[int] = []
    places: list[Floats] = []
    own: dict[str, list[tuple[str, Floats]]] = {}
    bones: dict[str, tuple[str, ...]] = {}

    def chain(source: Sequence[str], called: Sequence[str], parent: str, end: str = "") -> str:
        """Put joints along some of the body's, evenly; return the last one's name."""
        line = np.array([at[s] for s in source] + ([at[end]] if end else []))
        steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        goals = (
            along if len(source) == len(called) else np.linspace(0.0, along[-1], len(called) + 1)
        )
        for name, goal in zip(called, goals, strict=False):
            place = np.array([np.interp(goal, along, line[:, k]) for k in range(3)])
            names.append(prefix + name)
            parents.append(names.index(parent) if parent else -1)
            places.append(place)
            parent = prefix + name
        made = [(prefix + name, places[names.index(prefix + name)]) for name in called]
        for joint in source:
            own[joint] = made
        return parent

    root = chain(["pelvis"], [family.root], "")
    chest = chain(["spine_01", "spine_02", "spine_03"], family.back, root, "neck_01")
    neck = chain(["neck_01"], family.neck, chest, "head")
    head = chain(["head"], [family.head], neck)
    bones["neck"], bones["head"] = tuple(prefix + n for n in family.neck), (head,)
    for s, word in zip("LR", family.sides, strict=True):
        side = SIDES[s]
        up = chest
        for bone, joint, name in zip(
            ("clav", "arm", "f_arm", "palm"),
            ("clavicle", "upperarm", "lowerarm", "hand"),
            family.arms,
            strict=True,
        ):
            up = chain([f"{joint}_{side}"], [name.format(S=word)], up)
            bones[f"{bone}_{s}"] = (up,)
        hand = up
        for (digit, joint), called in zip(DIGITS.items(), family.digits, strict=True):
            last = hand
            for k in (1, 2, 3):
                source = f"{joint}_{k:02}_{side}"
                if not fingers:
                    own[source] = own[f"hand_{side}"]
                    continue
                form = family.digit[k - 1].split("|")[0 if digit == "thumb" else -1]
                last = chain([source], [form.format(S=word, D=called)], last)
                bones[f"{digit}_{s}_{k}"] = (last,)
        up = root
        for joint, name in zip(("thigh", "calf", "foot"), family.legs, strict=True):
            up = chain([f"{joint}_{side}"], [name.format(S=word)], up)
        if eyes and family.eye:
            bones[f"eye_{s}"] = (chain([f"eye_{s}"], [family.eye.format(S=word)], head),)
        else:
            own[f"eye_{s}"] = own["head"]
    weights = np.zeros((len(vertices), len(names)))
    dense = rig.mesh.dense_weights[kept]
    for j, joint in enumerate(rig.skeleton.names):
        made = own[joint]
        away = [np.linalg.norm(vertices - place, axis=1) for _, place in made]
        nearest = np.argmin(away, axis=0)
        for i, (name, _) in enumerate(made):
            weights[:, names.index(name)] += np.where(nearest == i, dense[:, j], 0.0)
    number = np.full(len(rig.mesh.vertices), -1)
    number[kept] = np.arange(len(kept))
    units = {}
    for unit in rig.units:
        rows, deltas = rig.mesh.unit(unit)
        there = number[rows] >= 0
        units[unit] = (number[rows][there], deltas[there])
    return Body(
        tuple(names),
        tuple(parents),
        np.array(places),
        vertices,
        triangles,
        weights,
        bones,
        parts,
        units,
    )


def with_sleeves(body: Body, widest: float) -> Body:
    """Widen a body's forearms towards the wrists like bell sleeves, so many times at the end."""
    vertices = body.vertices.copy()
    for side in "LR":
        joint, hand = (body.names.index(body.bones[f"{b}_{side}"][0]) for b in ("f_arm", "palm"))
        elbow, forearm = body.places[joint], body.places[hand] - body.places[joint]
        own = body.weights[:, joint] > 0.5 * body.weights.sum(axis=1)
        along = (vertices[own] - elbow) @ forearm / (forearm @ forearm)
        foot = elbow + along[:, None] * forearm
        factor = 1.0 + (widest - 1.0) * np.clip(along, 0.0, 1.0) ** 2
        vertices[own] = foot + factor[:, None] * (vertices[own] - foot)
    return replace(body, vertices=vertices)


def declare(file: GlbFile, body: Body, version: int) -> GlbFile:
    """Declare a body's bones as a VRM of version 0 or 1 does, and take the names away."""
    number = {node.get("name"): i for i, node in enumerate(file.nodes)}
    words = {"hips": body.names[0], "spine": body.names[1], "chest": body.names[2]}
    words |= {"upperChest": body.names[3], "neck": body.bones["neck"][0]}
    words["head"] = body.bones["head"][0]
    thumbs = ("Proximal", "Intermediate", "Distal")
    for s, side in (("L", "left"), ("R", "right")):
        words |= {f"{side}{word}": body.bones[f"{b}_{s}"][0] for b, word in VRM_WORDS.items()}
        if f"eye_{s}" in body.bones:
            words[f"{side}Eye"] = body.bones[f"eye_{s}"][0]
        for digit in DIGITS:
            if f"{digit}_{s}_1" in body.bones:
                parts = thumbs
                if digit == "thumb" and version == 1:
                    parts = ("Metacarpal", "Proximal", "Distal")
                for k, part in enumerate(parts, 1):
                    words[f"{side}{digit.title()}{part}"] = body.bones[f"{digit}_{s}_{k}"][0]
    if version == 1:
        bones: Any = {word: {"node": number[name]} for word, name in words.items()}
        extension: dict[str, Any] = {
            "VRMC_vrm": {"specVersion": "1.0", "humanoid": {"humanBones": bones}}
        }
    else:
        bones = [{"bone": word, "node": number[name]} for word, name in words.items()]
        extension = {"VRM": {"specVersion": "0.0", "humanoid": {"humanBones": bones}}}
    file.document["extensions"] = extension
    file.document["extensionsUsed"] = [*extension]
    return file
