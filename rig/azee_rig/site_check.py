"""Measures how far a rig's sites are from its skin: as modelled, and over every joint."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from azee_rig.mirror import other_side
from azee_rig.nearest import nearest
from azee_rig.patches import SkinPatches
from azee_rig.rig import Rig

Floats = NDArray[np.float64]

AT_BIND_M, OVER_RANGE_M, MIRROR_M = 0.002, 0.006, 0.002
"""Bounds: distance from the skin at bind and over the range of a joint, and between the sides."""
OUTWARD = 0.3
"""Least cosine between a site's normal and that of the skin."""
SURE_M = 0.0025
"""If a site leaves its patch of skin by less, the nearest skin is not searched."""


@dataclass(frozen=True, slots=True)
class AtBind:
    """A site in the mesh's own posture.

    distance_m: from the skin. outward: cosine between its normal and the skin's. own, near: share
    of the skin's weight there that its bone has, and with it the bones that it meets at a joint.
    mirror_m: from the mirror image of the other side's site, or across the middle.
    """

    site: str
    distance_m: float
    outward: float
    own: float
    near: float
    mirror_m: float

    @property
    def faults(self) -> tuple[str, ...]:
        """What is wrong with it, for people."""
        found = []
        if self.distance_m > AT_BIND_M:
            found.append(f"{1000 * self.distance_m:.1f} mm off the skin")
        if self.outward < OUTWARD:
            found.append("its normal does not look outward")
        if self.near < 0.5:
            found.append("the skin there belongs to other bones")
        if self.mirror_m > MIRROR_M:
            found.append(f"{1000 * self.mirror_m:.1f} mm from the mirror image of the other side")
        return tuple(found)


@dataclass(frozen=True, slots=True)
class OverRange:
    """A site in the posture of one joint in which it is farthest from the skin.

    distance_m: positive outside of the skin. at_rad: coordinates of the joint there, by name.
    """

    site: str
    distance_m: float
    at_rad: Mapping[str, float]

    @property
    def is_near(self) -> bool:
        """Whether its distance from the skin is within the bound."""
        return abs(self.distance_m) <= OVER_RANGE_M


def at_bind(rig: Rig) -> tuple[AtBind, ...]:
    """Measure all sites in the mesh's own posture."""
    sites = list(rig.sites.values())
    frames = rig.chain.frames(rig.coordinates.bind)
    points = np.array([site.point(frames) for site in sites])
    normals = np.array([site.outward(frames) for site in sites])
    patches = SkinPatches.under(points, rig.mesh)
    outward = np.sum(patches.normals * normals, axis=1)
    weights = patches.weights()
    place = dict(zip(rig.sites, points, strict=True))
    found = []
    for i, site in enumerate(sites):
        other = place.get(other_side(site.name), points[i])
        apart = float(np.linalg.norm(points[i] * (-1.0, 1.0, 1.0) - other))
        own = _joints(rig, site.bone) if site.node >= 0 else _still(rig)
        near = own.union(*(_joints(rig, bone) for bone in _meeting(rig, site.bone)))
        found.append(
            AtBind(
                site.name,
                float(patches.distances[i]),
                float(outward[i]),
                float(weights[i, sorted(own)].sum()),
                float(weights[i, sorted(near)].sum()),
                apart,
            )
        )
    return tuple(found)


def over_range(rig: Rig) -> tuple[OverRange, ...]:
    """Measure all sites over the range of each joint, all other joints at idle; farthest first.

    A joint's coordinates go to their limits in every combination, and to their middles, on both
    sides at once.
    """
    sites, postures, moved = list(rig.sites.values()), [], []
    for joint, q in _joint_postures(rig):
        postures.append(q)
        moved.append(joint)
    frames = rig.chain.frames(np.array(postures))
    points = np.stack([site.point(frames) for site in sites], axis=1)
    bind = rig.chain.frames(rig.coordinates.bind)
    patches = SkinPatches.under(np.array([site.point(bind) for site in sites]), rig.mesh)
    skins, turns = patches.posed(rig, np.array(postures))
    away = points - skins
    distances = np.linalg.norm(away, axis=2)
    signed = np.copysign(distances, np.sum(away * turns[..., 2], axis=2))
    for p, q in enumerate(postures):
        unsure = np.flatnonzero(distances[p] > SURE_M)
        if len(unsure):
            near = nearest(rig.skin(rig.pose(q)), rig.mesh.triangles, points[p, unsure])
            signed[p, unsure] = np.copysign(near.distances, signed[p, unsure])
    worst = np.abs(signed).argmax(axis=0)
    found = [
        OverRange(
            site.name,
            float(signed[worst[i], i]),
            {
                name: float(postures[worst[i]][rig.coordinates.index[name]])
                for name in moved[worst[i]]
            },
        )
        for i, site in enumerate(sites)
    ]
    return tuple(sorted(found, key=lambda site: -abs(site.distance_m)))


def _joint_postures(rig: Rig) -> Iterator[tuple[Sequence[str], Floats]]:
    c = rig.coordinates
    joints: dict[str, list[str]] = {}
    for name in c.names:
        if "_L" not in name:
            joints.setdefault(name.partition(".")[0], []).append(name)
    for names in joints.values():
        middle = (0.5,) * len(names)
        single = [(*middle[:k], end, *middle[k + 1 :]) for k in range(len(names)) for end in (0, 1)]
        for parts in sorted({*product((0.0, 1.0), repeat=len(names)), *single, middle}):
            q = np.array(c.idle)
            for name, part in zip(names, parts, strict=True):
                for side in {name, other_side(name)}:
                    i = c.index[side]
                    q[i] = c.lower[i] + part * (c.upper[i] - c.lower[i])
            yield names, q


def _meeting(rig: Rig, bone: str) -> Iterator[str]:
    """Bones before and after a bone."""
    parents = {name: _bone_before(rig, name) for name in rig.bones}
    if before := parents[bone]:
        yield before
    yield from (name for name, parent in parents.items() if parent == bone)


def _bone_before(rig: Rig, bone: str) -> str | None:
    parent = int(rig.chain.parents[rig.bones[bone].origin_node])
    return next((name for name, nodes in rig.bones.items() if nodes.node == parent), None)


def _still(rig: Rig) -> set[int]:
    """Return the joints of the skeleton that no bone moves, such as those of legs."""
    return {int(j) for j in np.flatnonzero(rig.drive.node < 0)}


def _joints(rig: Rig, bone: str) -> set[int]:
    """Joints of a bone, with the helpers that carry the skin between it and its neighbours."""
    nodes = rig.bones[bone]
    own = (rig.drive.node >= nodes.origin_node) & (rig.drive.node <= nodes.node)
    helper = rig.drive.helper_of >= 0
    parents = rig.skeleton.parents
    own |= helper & (own[rig.drive.helper_of] | own[parents])
    return set(np.flatnonzero(own).tolist())
