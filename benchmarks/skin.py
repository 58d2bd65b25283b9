"""Measures how fast skinning is and how well it keeps the shape of the skin.

`python benchmarks/skin.py [--format json]`. Speed is that of one frame of the whole body, posed,
skinned and with normals. Shape is judged by the section of the forearm at ±80° of pronation and by
the volume of the sleeve within 6 cm of an elbow bent by 145°. It compares three ways of skinning:
plain linear blending, dual quaternions on the same weights (Kavan et al. 2008), and linear blending
with helper joints, which ships.
"""

from __future__ import annotations

import json
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.plain import plain
from azee_rig.build.shape import elbow_sleeve, enclosed_volume, limb_sections
from azee_rig.load import load_rig
from azee_rig.mesh import BodyMesh, vertex_normals
from azee_rig.rig import Rig
from azee_rig.rotation import to_matrices, to_quaternions
from azee_rig.skin import joint_frames, skin

Floats = NDArray[np.float64]
Skinned = Callable[[Floats], Floats]

RUNS = 60
GOAL_MS = 5.0
WRIST = np.arange(-0.030, 0.021, 0.005)
SLEEVE = np.arange(-0.225, -0.035, 0.015)


@dataclass(frozen=True, slots=True)
class Shape:
    """Shares that are left, compared with the mesh's own posture."""

    way: str
    wrist_section: float
    sleeve_section: float
    elbow_volume: float


def linear(rig: Rig, mesh: BodyMesh) -> Skinned:
    """Return linear blending of a mesh."""
    return lambda q: skin(mesh, rig.skeleton, rig.pose(q))


def dual_quaternions(rig: Rig, mesh: BodyMesh) -> Skinned:
    """Return blending of dual quaternions: rotation and place along the shortest screw."""

    def skinned(q: Floats) -> Floats:
        positions, rotations = joint_frames(rig.skeleton, rig.pose(q))
        shift = positions - (rotations @ rig.skeleton.rest_positions[:, :, None])[..., 0]
        real = to_quaternions(rotations)
        dual = 0.5 * _product(np.pad(shift, ((0, 0), (1, 0))), real)
        own = real[mesh.joints]
        sign = np.where((own * own[:, :1]).sum(axis=2, keepdims=True) < 0.0, -1.0, 1.0)
        weights = mesh.weights[:, :, None] * sign
        turn, moved = (weights * own).sum(axis=1), (weights * dual[mesh.joints]).sum(axis=1)
        length = np.linalg.norm(turn, axis=1, keepdims=True)
        turn, moved = turn / length, moved / length
        shift = 2.0 * _product(moved, turn * (1.0, -1.0, -1.0, -1.0))[:, 1:]
        return np.asarray((to_matrices(turn) @ mesh.vertices[:, :, None])[..., 0] + shift)

    return skinned


def _product(a: Floats, b: Floats) -> Floats:
    scalar = a[:, 0] * b[:, 0] - (a[:, 1:] * b[:, 1:]).sum(axis=1)
    vector = a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:] + np.cross(a[:, 1:], b[:, 1:])
    return np.concatenate([scalar[:, None], vector], axis=1)


def shape(way: str, rig: Rig, skinned: Skinned) -> Shape:
    """Judge one way of skinning."""
    sections = {}
    for part, places in (("skin", WRIST), ("top", SLEEVE)):
        straight, *wrung = (
            limb_sections(rig, skinned(q), q, part, "R", places)
            for q in (_bent(rig, "f_arm_R.pronation", a) for a in (0.0, -80.0, 80.0))
        )
        sections[part] = min(float((w / straight).min()) for w in wrung)
    sleeve = elbow_sleeve(rig, "top", "R", 0.06)
    bent, bind = _bent(rig, "f_arm_R.flexion", 145.0), np.array(rig.coordinates.bind)
    volume = enclosed_volume(skinned(bent), sleeve) / enclosed_volume(skinned(bind), sleeve)
    return Shape(way, sections["skin"], sections["top"], volume)


def _bent(rig: Rig, coordinate: str, degrees: float) -> Floats:
    q = np.array(rig.coordinates.bind)
    q[rig.coordinates.index[coordinate]] = np.radians(degrees)
    return q


def speed(rig: Rig) -> dict[str, float]:
    """Return the medians of the milliseconds of processor time that each step of a frame takes."""
    q, face = rig.coordinates.idle, {"jawOpen": 0.3, "browInnerUp": 0.5, "mouthPucker": 0.4}
    pose = rig.pose(q)
    vertices = rig.skin(pose, face)
    steps: dict[str, Callable[[], object]] = {
        "pose": lambda: rig.pose(q),
        "skin with a face": lambda: rig.skin(pose, face),
        "normals": lambda: vertex_normals(vertices, rig.mesh.triangles),
        "whole frame": lambda: vertex_normals(rig.skin(rig.pose(q), face), rig.mesh.triangles),
    }
    return {name: _median_ms(step) for name, step in steps.items()}


def _median_ms(step: Callable[[], object]) -> float:
    step()
    runs = []
    for _ in range(RUNS):
        began = time.process_time()
        step()
        runs.append(1e3 * (time.process_time() - began))
    return statistics.median(runs)


def main(as_json: bool) -> None:
    """Print both tables."""
    rig = load_rig()
    rigid, mesh = plain(rig)
    shapes = [
        shape("linear, plain", rigid, linear(rigid, mesh)),
        shape("dual quaternions, plain", rigid, dual_quaternions(rigid, mesh)),
        shape("linear, helper joints", rig, linear(rig, rig.mesh)),
        shape("dual quaternions, helper joints", rig, dual_quaternions(rig, rig.mesh)),
    ]
    times = speed(rig)
    if as_json:
        print(json.dumps({"speed_ms": times, "shape": [asdict(s) for s in shapes]}, indent=1))
        return
    print(f"{len(rig.mesh.vertices)} vertices, {len(rig.mesh.triangles)} triangles")
    for name, ms in times.items():
        goal = f"   goal {GOAL_MS} ms" if name == "whole frame" else ""
        print(f"{name:<34}{ms:>8.2f} ms{goal}")
    print(f"{'kept':<34}{'wrist':>8}{'sleeve':>8}{'elbow':>8}")
    for s in shapes:
        print(f"{s.way:<34}{s.wrist_section:>8.3f}{s.sleeve_section:>8.3f}{s.elbow_volume:>8.3f}")


if __name__ == "__main__":
    main(sys.argv[1:] == ["--format", "json"])
