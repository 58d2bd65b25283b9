"""A body's visible surface, and rays cast against it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh
from numpy.typing import NDArray

from azee_rig.mesh import BodyMesh
from azee_rig.nearest import barycentric, closest_on_triangles
from azee_rig.skeleton import Skeleton

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

SLIVER = 1e-12
"""Square of the sine of a corner below which a triangle has no area."""


@dataclass(frozen=True, eq=False)
class Surface:
    """A dressed mesh in its own posture, with the joints that its weights speak of."""

    mesh: BodyMesh
    skeleton: Skeleton

    @cached_property
    def met(self) -> NDArray[np.intp]:
        """Triangles that a ray can meet: all with an area."""
        corners = self.mesh.vertices[self.mesh.triangles]
        along, across = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        squares = (along**2).sum(axis=1) * (across**2).sum(axis=1)
        return np.flatnonzero(squares - (along * across).sum(axis=1) ** 2 > SLIVER * squares)

    @cached_property
    def tree(self) -> trimesh.Trimesh:
        """The triangles of `met` as trimesh sees them."""
        return trimesh.Trimesh(self.mesh.vertices, self.mesh.triangles[self.met], process=False)

    def on_parts(self, *names: str) -> Mask:
        """Triangles of some parts, (F,)."""
        mask = np.zeros(len(self.mesh.triangles), dtype=bool)
        for part in self.mesh.parts:
            if part.name in names:
                mask[part.start : part.stop] = True
        return mask

    def moved_by(self, joints: Sequence[str], at_least: float) -> Mask:
        """Triangles that some joints together carry by at least a share, (F,)."""
        return np.asarray(self.share(joints)[self.mesh.triangles].mean(axis=1) >= at_least)

    def share(self, joints: Sequence[str]) -> Floats:
        """Weight of some joints together on each vertex, (N,)."""
        columns = [self.skeleton.names.index(j) for j in joints]
        return np.asarray(self.mesh.dense_weights[:, columns].sum(axis=1))

    def cast(self, start: Floats, toward: Floats, allowed: Mask, hit: str) -> tuple[Floats, Floats]:
        """Return where a ray first or last meets allowed triangles, and the normal there.

        The normal is interpolated from the vertices. Raises ValueError when nothing is met.
        """
        direction = toward / np.linalg.norm(toward)
        places, _, found_in = self.tree.ray.intersects_location(
            [start], [direction], multiple_hits=True
        )
        triangles = self.met[found_in]
        distance = (places.reshape(-1, 3) - start) @ direction
        usable = [i for i in np.argsort(distance) if allowed[triangles[i]]]
        if not usable:
            raise ValueError("the ray meets nothing that it may meet")
        found = usable[0] if hit == "first" else usable[-1]
        corners = self.mesh.triangles[triangles[found]]
        shares = barycentric(self.mesh.vertices[corners][None], places[found][None])[0]
        normal = shares @ self.mesh.normals[corners]
        return places[found], np.asarray(normal / np.linalg.norm(normal))

    def passed(
        self, start: Floats, toward: Floats, allowed: Mask, reach: float
    ) -> tuple[Floats, Floats] | None:
        """Return the point of allowed triangles that a ray passes nearest to, and the normal there.

        None if it passes by all of them at more than `reach`, metres.
        """
        direction = toward / np.linalg.norm(toward)
        rows = np.flatnonzero(allowed)
        if not len(rows):
            return None
        corners = self.mesh.vertices[self.mesh.triangles[rows]]
        middles = corners.mean(axis=1) - start
        along = np.maximum(middles @ direction, 0.0)
        away = np.linalg.norm(middles - along[:, None] * direction, axis=1)
        aim = start + along[away.argmin()] * direction
        on = closest_on_triangles(corners, aim)
        gaps = np.linalg.norm(on - aim, axis=1)
        best = int(gaps.argmin())
        if gaps[best] > reach:
            return None
        shares = barycentric(corners[best][None], on[best][None])[0]
        normal = shares @ self.mesh.normals[self.mesh.triangles[rows[best]]]
        length = float(np.linalg.norm(normal))
        if not length > 0.0:
            return None
        return on[best], np.asarray(normal / length)
