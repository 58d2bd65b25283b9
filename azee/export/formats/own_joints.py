"""A clip as an animation of the joints and morph targets of the file that a body was taken from.

A rig stands upright, in metres, with the world's axes at every joint; its maker's file has a space,
a unit and axes of its own. The similarity that takes one to the other is fitted to the places of
the joints (Umeyama 1991, equations 40 to 42). With its turn Q, a joint of the file has the rotation
Qᵀ R Q B in the scene, where R is that of the rig and B is how the joint was bound.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.files import replace_file
from azee.export.formats.gltf.animation import add_tracks
from azee.export.formats.gltf.document import Document, Target
from azee.export.formats.moving_body import postures
from azee_rig.importing.container import GltfFile, read_gltf
from azee_rig.importing.nodes import Nodes, read_nodes
from azee_rig.importing.scene import SceneBody, read_scene
from azee_rig.importing.surface_parts import target_names
from azee_rig.rig import Rig
from azee_rig.rotation import to_quaternions
from azee_rig.skin import joint_frames

Floats = NDArray[np.float64]

FITS_M = 0.005
"""Joints of a body's own file are no farther than this from the rig's."""
LEAST_JOINTS = 8
"""Fewer joints of the same name are an accident."""
RESERVED = re.compile(r"[\[\].:/]")
STILL_SHARE = 1e-5
"""Ways of joints that are left out, as a share of the length of the whole body."""


class NotItsFileError(ValueError):
    """A file that the body was not taken from. The message is for the user."""


def write_own_animation(
    clip: Clip, rig: Rig, body: str | Path, path: str | Path
) -> tuple[str, ...]:
    """Write a GLB with the nodes of a body's own file and an animation of them, without a mesh.

    Nodes keep number, name and rest transform. Each mesh with morph targets that move is stood in
    for by a mesh of one point with the same targets, for glTF has weights only where there is one.

    Returns: what its user should know.
    Raises: BodyError: the body's file cannot be read. NotItsFileError. OSError.
    """
    file = read_gltf(Path(body))
    scene, nodes = read_scene(file), read_nodes(file)
    document = Document(generator="azee")
    rows = _turns(clip, rig, scene, nodes)
    standing = _stand_ins(document, file, clip)
    for number, row in enumerate(file.all("nodes")):
        kept = ("name", "translation", "rotation", "scale", "matrix", "children")
        held = {key: row[key] for key in kept if key in row}
        if any(node == number for node, _ in rows) and "matrix" in held:
            held |= _parts(nodes.local[number])  # glTF animates no matrix
            del held["matrix"]
        if number in standing:
            held["mesh"] = standing[number][0]
        document.add("nodes", **held)
    for number, (_, weights) in standing.items():
        rows[number, "weights"] = weights
    add_tracks(document, clip, rows)
    roots = [n for n, parent in enumerate(nodes.parents) if parent < 0]
    with replace_file(path) as to:
        to.writelines(document.glb_parts(scene=document.add("scenes", nodes=roots)))
    return tuple(_notes(rig, scene, nodes))


def _notes(rig: Rig, scene: SceneBody, nodes: Nodes) -> list[str]:
    made = [name for name in rig.skeleton.names if name not in scene.joints]
    notes = []
    if made:
        notes.append(f"its file has no joints for {', '.join(made)}: they are left out")
    if any(RESERVED.search(nodes.names[n]) for n in scene.nodes):
        notes.append(
            "names of joints have characters that three.js leaves out when it loads them "
            "([ ] . : /): load both files with it"
        )
    return notes


def _turns(clip: Clip, rig: Rig, scene: SceneBody, nodes: Nodes) -> dict[tuple[int, str], Floats]:
    """Return rotations (T, 4) wxyz and ways (T, 3) of the nodes that move."""
    number = {name: j for j, name in enumerate(rig.skeleton.names)}
    shared = {n: number[name] for n, name in zip(scene.nodes, scene.joints, strict=True)
              if name in number}  # fmt: skip
    if len(shared) < LEAST_JOINTS:
        raise NotItsFileError(f"`{rig.name}` was not taken from it: its joints have other names")
    own = np.array([scene.bound[scene.nodes.index(n), :3, 3] for n in shared])
    rest = rig.skeleton.rest_positions[list(shared.values())]
    scale, Q, shift = similarity(own, rest)
    off = np.linalg.norm(scale * own @ Q.T + shift - rest, axis=1)
    if off.max() > FITS_M:
        raise NotItsFileError(
            f"`{rig.name}` was not taken from it: joints are up to {1e3 * off.max():.0f} mm away"
        )
    count = len(clip.times)
    places, turned = np.empty((count, len(number), 3)), np.empty((count, len(number), 3, 3))
    for frames, pose in postures(clip, rig):
        places[frames], turned[frames] = joint_frames(rig.skeleton, pose)
    world: dict[int, Floats] = {}
    found: dict[tuple[int, str], Floats] = {}
    for node in nodes.order:
        parent = nodes.parents[node]
        above = world[parent] if parent >= 0 else np.tile(np.eye(4), (count, 1, 1))
        if node not in shared:
            world[node] = above @ nodes.local[node]
            continue
        joint, now = shared[node], np.tile(np.eye(4), (count, 1, 1))
        bound = scene.bound[scene.nodes.index(node)]
        now[:, :3, :3] = Q.T @ turned[:, joint] @ Q @ bound[:3, :3]
        now[:, :3, 3] = (places[:, joint] - shift) @ Q / scale
        world[node] = now
        local = np.linalg.inv(above) @ now
        parts = nodes.local[node]
        sizes = np.linalg.norm(local[:, :3, :3], axis=1)
        turns = local[:, :3, :3] / sizes[:, None]
        if np.abs(turns - parts[:3, :3] / np.linalg.norm(parts[:3, :3], axis=0)).max() > 1e-6:
            found[node, "rotation"] = to_quaternions(turns)
        length = float(np.ptp(own, axis=0).max())
        if np.abs(local[:, :3, 3] - parts[:3, 3]).max() > STILL_SHARE * length:
            found[node, "translation"] = local[:, :3, 3]
    return found


def similarity(points: Floats, wanted: Floats) -> tuple[float, Floats, Floats]:
    """Return scale, turn (3, 3) and shift (3,) with scale · turn · p + shift nearest to others."""
    middle, goal = points.mean(axis=0), wanted.mean(axis=0)
    centred = points - middle
    u, s, vt = np.linalg.svd((wanted - goal).T @ centred)
    sense = np.array([1.0, 1.0, np.sign(np.linalg.det(u @ vt))])
    Q = np.asarray(u * sense @ vt)
    scale = float((s * sense).sum() / (centred**2).sum())
    return scale, Q, goal - scale * Q @ middle


def _parts(local: Floats) -> dict[str, Any]:
    """Return a transform as translation, rotation and scale, as glTF has them."""
    sizes = np.linalg.norm(local[:3, :3], axis=0)
    turn = to_quaternions(local[:3, :3] / sizes)
    return {
        "translation": local[:3, 3].tolist(),
        "rotation": np.roll(turn, -1).tolist(),
        "scale": sizes.tolist(),
    }


def _stand_ins(document: Document, file: GltfFile, clip: Clip) -> dict[int, tuple[int, Floats]]:
    """Return by node a mesh of one point with its targets, and their weights (T, n)."""
    column = {unit: u for u, unit in enumerate(clip.units)}
    meshes: dict[int, int] = {}
    found: dict[int, tuple[int, Floats]] = {}
    point = -1
    for number, row in enumerate(file.all("nodes")):
        if row.get("mesh") is None:
            continue
        mesh = file.one("meshes", row["mesh"])
        names = _target_names(mesh, row["mesh"])
        if not any(name in column for name in names):
            continue
        if point < 0:
            zeros = np.zeros((3, 3), np.float32)
            point = document.accessor(zeros, target=Target.VERTICES, bounds=True)
        if row["mesh"] not in meshes:
            meshes[row["mesh"]] = _stand_in(document, mesh, names, point)
        weights = np.zeros((len(clip.times), len(names)))
        for n, name in enumerate(names):
            if name in column:
                weights[:, n] = clip.unit_weights[:, column[name]]
        found[number] = meshes[row["mesh"]], weights
    return found


def _target_names(mesh: Mapping[str, Any], number: int) -> list[str]:
    """Return the names that the import gave to the targets of a mesh."""
    count = max(len(row.get("targets", ())) for row in mesh["primitives"])
    told = target_names(mesh)[:count]
    return [*told, *(f"target_{number}_{n}" for n in range(len(told), count))]


def _stand_in(document: Document, mesh: Mapping[str, Any], names: Sequence[str], point: int) -> int:
    primitive = {"attributes": {"POSITION": point}, "targets": [{"POSITION": point}] * len(names)}
    return document.add(
        "meshes",
        name=mesh.get("name"),
        primitives=[primitive] * len(mesh["primitives"]),
        weights=[0.0] * len(names),
        extras={"targetNames": list(names)},
    )
