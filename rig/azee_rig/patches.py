"""Patches of skin under points: their places in many postures, computed from a few vertices."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from azee_rig.mesh import BodyMesh
from azee_rig.nearest import barycentric, nearest
from azee_rig.rig import Rig
from azee_rig.skeleton import Pose
from azee_rig.skin import skin

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class SkinPatches:
    """The triangles of a mesh that are nearest to some points.

    corners: (S, 3) vertices. shares: (S, 3) of the corners at the nearest points, sums are 1.
    distances: (S,) of the points, metres. normals: (S, 3) of the triangles.
    """

    mesh: BodyMesh
    corners: Ints
    shares: Floats
    distances: Floats
    normals: Floats

    @staticmethod
    def under(points: Floats, mesh: BodyMesh) -> SkinPatches:
        """Find the triangles nearest to points (S, 3) in the mesh's own posture."""
        found = nearest(mesh.vertices, mesh.triangles, points)
        corners = mesh.triangles[found.triangles]
        places = mesh.vertices[corners]
        shares = barycentric(places, found.points)
        normals = _triangle_frames(places)[..., 2]
        return SkinPatches(mesh, corners, shares, found.distances, normals)

    def weights(self) -> Floats:
        """Skin weight of every joint at each point, (S, J)."""
        return np.asarray(
            np.einsum("sc,scj->sj", self.shares, self.mesh.dense_weights[self.corners])
        )

    def posed(self, rig: Rig, postures: Floats) -> tuple[Floats, Floats]:
        """Points (P, S, 3) in postures (P, V), and frames of the triangles there (P, S, 3, 3)."""
        rows, index = np.unique(self.corners, return_inverse=True)
        index = index.reshape(-1, 3)
        part = replace(
            self.mesh,
            vertices=self.mesh.vertices[rows],
            triangles=index,
            parts=(),
            colours=self.mesh.colours[rows],
            joints=self.mesh.joints[rows],
            weights=self.mesh.weights[rows],
            units=(),
            unit_start=np.zeros(1, dtype=np.int64),
            unit_rows=np.empty(0, dtype=np.int64),
            unit_deltas=np.empty((0, 3)),
        )
        poses = rig.pose(postures)
        vertices = np.stack(
            [
                skin(part, rig.skeleton, Pose(root, rotations))
                for root, rotations in zip(poses.root_translation, poses.rotations, strict=True)
            ]
        )
        corners = vertices[:, index]
        return np.einsum("sc,pscx->psx", self.shares, corners), _triangle_frames(corners)


def _triangle_frames(corners: Floats) -> Floats:
    """Columns along the first edge, in the plane, along the normal: (…, 3, 3) of (…, 3, 3)."""
    edge, other = corners[..., 1, :] - corners[..., 0, :], corners[..., 2, :] - corners[..., 0, :]
    normal = _unit(np.cross(edge, other))
    edge = _unit(edge)
    return np.stack([edge, np.cross(normal, edge), normal], axis=-1)


def _unit(v: Floats) -> Floats:
    return np.asarray(v / np.linalg.norm(v, axis=-1, keepdims=True))
