"""The skin of one part of the body, on which a site may slide."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Frames
from azee_rig.nearest import nearest

if TYPE_CHECKING:
    from azee_rig.rig import BoneNodes, Rig

Array = NDArray[np.float64]

REACH_M = 0.02
"""Skin farther outside a part's capsules than this is not its own: sleeves and hems stand off."""


UPRIGHT = ("back_1", "back_2", "neck", "head")
"""Bones that carry each other, in order, and whose skins hardly move against each other."""


@dataclass(frozen=True, slots=True, eq=False)
class PartSkin:
    """The skin of a bone, fixed in its frame as in the mesh's own posture.

    vertices: (N, 3) in the frame of `node`, metres. triangles: (F, 3).
    """

    node: int
    vertices: Array
    triangles: NDArray[np.int64]

    def laid_on(self, free: Array, start: Array, end: Array, t: Array, frames: Frames) -> Array:
        """Return a path (…, 3) laid on the skin, from start to end, which may be a little off it.

        Each point goes to the nearest one of the skin. What start and end are away from theirs is
        added evenly along the way.

        Args: start, end: (…, 3), broadcast against the path. t: from 0 to 1, likewise (…,).
        """
        origin, axes = frames.positions[..., self.node, :], frames.rotations[..., self.node, :, :]
        if free.ndim > origin.ndim:
            origin, axes = origin[..., None, :], axes[..., None, :, :]
        first, last, between = (
            self._nearest(points, origin, axes) for points in np.broadcast_arrays(start, end, free)
        )
        u = np.asarray(t)[..., None]
        return np.asarray(between + (1.0 - u) * (start - first) + u * (end - last))

    def _nearest(self, points: Array, origin: Array, axes: Array) -> Array:
        local = np.einsum("...ji,...j->...i", axes, points - origin)
        found = np.full(local.shape, np.nan)
        known = np.isfinite(local).all(axis=-1)
        distinct, back = np.unique(local[known], axis=0, return_inverse=True)
        found[known] = nearest(self.vertices, self.triangles, distinct).points[back.reshape(-1)]
        return np.asarray(origin + np.einsum("...ij,...j->...i", axes, found))


@lru_cache(maxsize=32)
def skin_of(rig: Rig, bone: BoneNodes) -> PartSkin:
    """Return the skin of a bone: triangles around its capsules, nearer to them than to those aside.

    Aside are bones that neither carry it nor are carried by it, such as other fingers.
    """
    q = np.asarray(rig.coordinates.bind)
    frames, capsules = rig.chain.frames(q), rig.capsules
    vertices = rig.skin(rig.pose(q))
    R, o = frames.rotations[capsules.node], frames.positions[capsules.node]
    a, b = (o + np.einsum("kij,kj->ki", R, ends) for ends in (capsules.a, capsules.b))
    own = (bone.origin_node <= capsules.node) & (capsules.node <= bone.node)
    own &= np.array([_in_line(rig.chain.parents, bone.node, int(n)) for n in capsules.node])
    aside = np.array([not _in_line(rig.chain.parents, bone.node, int(n)) for n in capsules.node])
    outside = np.stack(
        [
            _to_segment(vertices, p, q_) - radius
            for p, q_, radius in zip(a, b, capsules.radius, strict=True)
        ]
    )
    nearest_own = outside[own].min(axis=0, initial=np.inf)
    mine = (nearest_own < REACH_M) & (nearest_own <= outside[aside].min(axis=0, initial=np.inf))
    triangles = rig.mesh.triangles[mine[rig.mesh.triangles].all(axis=1)]
    used, rows = np.unique(triangles, return_inverse=True)
    local = (vertices[used] - frames.positions[bone.node]) @ frames.rotations[bone.node]
    return PartSkin(bone.node, local, rows.reshape(-1, 3))


@lru_cache(maxsize=256)
def skin_between(rig: Rig, one: str, other: str, fraction: float) -> tuple[int, Array] | None:
    """Return the point of the skin of trunk, neck and head nearest to one between two sites.

    It rides on the bone whose skin it is: the two that carry the sites, or one of those between.

    Returns: a node and the place in its frame, (3,) metres; None if a site is on another part.
    """
    sites = rig.sites[one], rig.sites[other]
    line = [name for name in UPRIGHT if name in rig.bones]
    if any(site.bone not in line for site in sites):
        return None
    frames = rig.chain.frames(np.asarray(rig.coordinates.bind))
    start, end = (site.point(frames) for site in sites)
    middle = start + fraction * (end - start)
    low, high = sorted(line.index(site.bone) for site in sites)
    found: list[tuple[float, int, Array]] = []
    for name in line[low : high + 1]:
        skin = skin_of(rig, rig.bones[name])
        if len(skin.triangles):
            R, o = frames.rotations[skin.node], frames.positions[skin.node]
            on = nearest(skin.vertices, skin.triangles, ((middle - o) @ R)[None])
            found.append((float(on.distances[0]), skin.node, on.points[0]))
    if not found:
        return None
    _, node, local = min(found, key=lambda entry: entry[0])
    return node, local


def _in_line(parents: NDArray[np.int64], one: int, other: int) -> bool:
    """Whether one node is the other or above or below it."""
    low, high = max(one, other), min(one, other)
    while low > high:
        low = int(parents[low])
    return low == high


def _to_segment(points: Array, a: Array, b: Array) -> Array:
    """Return the distance of points (n, 3) to a segment, (n,)."""
    along = b - a
    square = float(along @ along)
    share = np.clip((points - a) @ along / square, 0.0, 1.0) if square else np.zeros(len(points))
    return np.asarray(np.linalg.norm(points - a - share[:, None] * along, axis=1))
