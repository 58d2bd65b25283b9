"""How deep a posed body's arms and hands lie inside its trunk, its head or each other.

Measured on the skin itself, not on the capsules that the solver keeps apart: the judge of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import DIR
from azee_solver.anatomy import Anatomy, anatomy
from azee_solver.winding import distances, winding_numbers

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

LOOSE_PARTS = frozenset({"hair", "brows", "lashes", "eyes", "teeth", "tongue", "shoes"})
"""Parts of a mesh that do not bound the body."""
ARMPIT = 0.6
"""So much of the upper arm, from the shoulder, always lies against the trunk and is not counted."""
OWN_WEIGHT = 0.9
"""A vertex belongs to a limb if so much of its skin weight does."""


@dataclass(frozen=True, slots=True)
class Penetration:
    """A limb inside another part of the body: how deep, and where in the world, metres."""

    limb: str
    body: str
    depth_m: float
    point: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class _Regions:
    """Vertices of the limbs that are tested, (N,), and triangles that bound the parts, (F, 3)."""

    limbs: Mapping[str, Flags]
    surfaces: Mapping[str, NDArray[np.int64]]


def mesh_penetration(rig: Rig, q: Array) -> tuple[Penetration, ...]:
    """Return where arms and hands enter trunk, head or the other arm, deepest first.

    Args: q: (V,) coordinates of one posture.
    """
    regions = _regions(rig)
    vertices = rig.skin(rig.pose(q))
    found = []
    for limb, own in regions.limbs.items():
        for body, triangles in regions.surfaces.items():
            if body == limb:
                continue
            corners = vertices[triangles]
            points = vertices[own]
            low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
            points = points[np.all((points > low) & (points < high), axis=1)]
            inside = points[winding_numbers(points, corners) > 0.5]
            if len(inside):
                depth = distances(inside, corners)
                k = int(depth.argmax())
                x, y, z = (float(v) for v in inside[k])
                found.append(Penetration(limb, body, float(depth[k]), (x, y, z)))
    return tuple(sorted(found, key=lambda p: -p.depth_m))


@lru_cache(maxsize=4)
def _regions(rig: Rig) -> _Regions:
    mesh = rig.mesh
    region = _joint_regions(rig, anatomy(rig.chain, rig.coordinates))
    names = ("trunk", "head", "arm_L", "arm_R")
    share = {name: np.sum(mesh.weights * (region == name)[mesh.joints], axis=1) for name in names}
    bounding = np.zeros(len(mesh.triangles), dtype=np.bool_)
    for part in mesh.parts:
        if part.name not in LOOSE_PARTS:
            bounding[part.start : part.stop] = True
    on_surface = np.zeros(len(mesh.vertices), dtype=np.bool_)
    on_surface[mesh.triangles[bounding]] = True
    surfaces = {}
    for name in names:
        whole = (share[name][mesh.triangles] > 0.5).all(axis=1)
        surfaces[name] = mesh.triangles[bounding & whole]
    limbs = {
        f"arm_{side}": on_surface
        & (share[f"arm_{side}"] > OWN_WEIGHT)
        & (_along_upper_arm(rig, side) > ARMPIT)
        for side in "LR"
    }
    return _Regions(limbs, surfaces)


def _joint_regions(rig: Rig, structure: Anatomy) -> NDArray[np.str_]:
    """Region that each joint of the skeleton moves with, (J,)."""
    limbs = {f"arm_{side}": rig.bones[f"arm_{side}"].node for side in "LR"}
    head = rig.bones["neck"].origin_node
    out = []
    for j in range(len(rig.skeleton.names)):
        source = int(rig.drive.helper_of[j])
        node = int(rig.drive.node[source if source >= 0 else j])
        name = "trunk"
        if node >= 0:
            if structure.is_above(head, node):
                name = "head"
            name = next((s for s, n in limbs.items() if structure.is_above(n, node)), name)
        out.append(name)
    return np.array(out)


def _along_upper_arm(rig: Rig, side: str) -> Array:
    """How far along the upper arm vertices lie in the mesh's own posture: 0 shoulder, 1 elbow."""
    frames = rig.chain.frames(rig.coordinates.bind)
    shoulder = rig.bones[f"arm_{side}"].node
    elbow = rig.bones[f"f_arm_{side}"].origin_node
    axis = frames.rotations[shoulder, :, DIR]
    length = float(axis @ (frames.positions[elbow] - frames.positions[shoulder]))
    return np.asarray((rig.mesh.vertices - frames.positions[shoulder]) @ axis / length)
