"""Measures how well posed skin keeps its shape: sections of a limb, and volume around a joint.

Both are measured on a posed mesh, so they judge all ways of skinning alike.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from azee_rig.rig import Rig

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

REACH_M = 0.09
"""Only points nearer to a limb's axis than this belong to its section."""


def part_triangles(rig: Rig, part: str) -> Ints:
    """Return triangles (f, 3) of one part of a body's mesh."""
    (run,) = (p for p in rig.mesh.parts if p.name == part)
    return rig.mesh.triangles[run.start : run.stop]


def section_area(vertices: Floats, triangles: Ints, origin: Floats, normal: Floats) -> float:
    """Return the area in m² of a section of a closed tube: the sum of ½ (a × b) · n over edges.

    Args: origin: (3,) place on the tube's axis; normal: (3,) unit normal of the plane.
    Returns: nan if the section is not closed.
    """
    near = (np.linalg.norm(vertices - origin, axis=1) < REACH_M)[triangles].all(axis=1)
    corners = triangles[near]
    tube = trimesh.Trimesh(vertices, corners, process=False)
    mesh_plane: Any = trimesh.intersections.mesh_plane
    edges, cut = mesh_plane(tube, normal, origin, return_faces=True)
    if len(edges) == 0:
        return float("nan")
    a, b, c = (vertices[corners[cut, i]] for i in range(3))
    along = np.cross(normal, np.cross(b - a, c - a))
    runs = np.einsum("ij,ij->i", edges[:, 1] - edges[:, 0], along) >= 0.0
    start, end = np.where(runs[:, None, None], edges, edges[:, ::-1]).swapaxes(0, 1) - origin
    if np.linalg.norm((end - start).sum(axis=0)) > 1e-6:
        return float("nan")
    return abs(float((np.cross(start, end) @ normal).sum() / 2.0))


def limb_sections(
    rig: Rig, vertices: Floats, q: Floats, part: str, side: str, at: Floats
) -> Floats:
    """Return cross-sections (n,) of a forearm, m², at metres (n,) past the wrist."""
    frames = rig.chain.frames(q)
    wrist = frames.positions[rig.bones[f"palm_{side}"].origin_node]
    axis = frames.rotations[rig.bones[f"f_arm_{side}"].node][:, 1]
    triangles = part_triangles(rig, part)
    return np.array([section_area(vertices, triangles, wrist + x * axis, axis) for x in at])


def elbow_sleeve(rig: Rig, part: str, side: str, reach_m: float) -> Ints:
    """Return triangles of a sleeve between planes perpendicular to both limbs at bind, (f, 3).

    reach_m: distance of each plane from the elbow.
    """
    frames = rig.chain.frames(rig.coordinates.bind)
    upper, lower = (frames.rotations[rig.bones[f"{b}_{side}"].node][:, 1] for b in ("arm", "f_arm"))
    elbow = frames.positions[rig.bones[f"f_arm_{side}"].origin_node]
    triangles = part_triangles(rig, part)
    middle = rig.mesh.vertices[triangles].mean(axis=1) - elbow
    within = (middle @ lower < reach_m) & (middle @ upper > -reach_m)
    return np.asarray(triangles[within & (np.linalg.norm(middle, axis=1) < reach_m + REACH_M)])


def enclosed_volume(vertices: Floats, triangles: Ints) -> float:
    """Return the volume in m³ inside a tube, each open rim closed by a fan around its middle.

    By the divergence theorem, Σ a · (b × c) / 6: volume that is covered twice counts twice.
    """
    edges = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    _, which, times = np.unique(
        np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    rim = edges[times[which.ravel()] == 1]
    rows, numbered = np.unique(rim, return_inverse=True)
    ring = np.arange(len(rows))
    ends = numbered.reshape(-1, 2)
    for _ in range(len(rows)):
        joined = ring.copy()
        np.minimum.at(joined, ends[:, 0], ring[ends[:, 1]])
        np.minimum.at(joined, ends[:, 1], ring[ends[:, 0]])
        if np.array_equal(joined, ring):
            break
        ring = joined
    _, ring = np.unique(ring, return_inverse=True)
    size = np.bincount(ring)
    middle = np.stack([np.bincount(ring, x) / size for x in vertices[rows].T], axis=1)
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    total = (a * np.cross(b, c)).sum()
    caps = np.cross(vertices[rim[:, 0]], middle[ring[ends[:, 0]]])
    return float(total + (caps * vertices[rim[:, 1]]).sum()) / 6.0
