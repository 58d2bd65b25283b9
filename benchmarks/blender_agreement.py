"""Compares the bodies' GLB files with Blender: joints and skinned vertices at ten random postures.

    python -m venv BPY && BPY/bin/pip install bpy      # with the Python that bpy requires; once
    python benchmarks/blender_agreement.py BPY/bin/python [BODY …]

Exits with 1 if a joint is more than 1 mm or a vertex more than 2 mm off.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from azee.clip.clip import Clip
from azee.export.formats.glb import write_glb
from azee_rig.load import load_rig, shipped_rigs
from azee_rig.rig import Rig

JOINT_M, VERTEX_M = 0.001, 0.002
POSTURES, SEED, REACH = 10, 7, 0.6
IN_BLENDER = """
import json, sys
import bpy
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = 10
bpy.ops.import_scene.gltf(filepath=sys.argv[-2])
body = next(o for o in bpy.data.objects if o.type == "MESH" and o.vertex_groups)
armature = next(o for o in bpy.data.objects if o.type == "ARMATURE")
seen = []
for frame in range(int(sys.argv[-1])):
    bpy.context.scene.frame_set(frame)
    graph = bpy.context.evaluated_depsgraph_get()
    made = body.evaluated_get(graph)
    mesh, place = made.to_mesh(), made.matrix_world
    bones = armature.evaluated_get(graph).pose.bones
    seen.append({
        "joints": {b.name: list(armature.matrix_world @ b.head) for b in bones},
        "vertices": [list(place @ v.co) for v in mesh.vertices],
    })
    made.to_mesh_clear()
print("SEEN" + json.dumps(seen))
"""


def random_postures(rig: Rig) -> np.ndarray:
    """Return random postures (P, V) within the limits, between idle and anywhere."""
    c = rig.coordinates
    anywhere = np.random.default_rng(SEED).uniform(c.lower, c.upper, (POSTURES, len(c)))
    return np.asarray(c.idle + REACH * (anywhere - c.idle))


def largest_gaps(rig: Rig, python: str) -> tuple[float, float]:
    """Return the largest gap of any joint and of any vertex, metres."""
    q = random_postures(rig)
    clip = Clip(np.arange(POSTURES) / 10, q, (), np.zeros((POSTURES, 0)))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "body.glb"
        write_glb(clip, rig, path)
        done = subprocess.run(
            [python, "-c", IN_BLENDER, str(path), str(POSTURES)],
            capture_output=True, text=True, check=True,
        )  # fmt: skip
    line = next(row for row in done.stdout.splitlines() if row.startswith("SEEN"))
    order = np.concatenate(
        [np.unique(rig.mesh.triangles[p.start : p.stop]) for p in rig.mesh.parts]
    )
    joints, vertices = [], []
    for posture, seen in zip(q, json.loads(line[4:]), strict=True):
        pose = rig.pose(posture)
        places = rig.joint_positions(pose)
        for name, place in seen["joints"].items():
            ours = places[rig.skeleton.names.index(name)]
            joints.append(np.linalg.norm(_ours(np.array(place)) - ours))
        skin = rig.skin(pose)[order]
        vertices.append(np.linalg.norm(_ours(np.array(seen["vertices"])) - skin, axis=1).max())
    return float(max(joints)), float(max(vertices))


def _ours(points: np.ndarray) -> np.ndarray:
    """From Blender's z up to y up."""
    return np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1)


def main(python: str, bodies: tuple[str, ...]) -> int:
    """Print the largest gaps of each body."""
    bad = 0
    for name in bodies:
        joint, vertex = largest_gaps(load_rig(name), python)
        print(f"{name:8} joints {1000 * joint:.3f} mm, vertices {1000 * vertex:.3f} mm")
        bad |= joint > JOINT_M or vertex > VERTEX_M
    return int(bad)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], tuple(sys.argv[2:]) or shipped_rigs()))
