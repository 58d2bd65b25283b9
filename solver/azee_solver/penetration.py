"""How deep a posed body's arms, hands and fingers lie inside its trunk, its head or each other.

Measured on the skin itself, not on the capsules that the solver keeps apart: the judge of them.
Arms end at the knuckles; every digit counts by itself. Against its own hand only the phalanges
beyond the first are tested, for the first are webbed to it and to each other.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import DIR, Frames
from azee_solver.anatomy import Anatomy, anatomy
from azee_solver.constraint import Place
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import SitePoint
from azee_solver.winding import distances, winding_numbers

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

LOOSE_PARTS = frozenset({"hair", "brows", "lashes", "eyes", "teeth", "tongue", "shoes"})
"""Parts of a mesh that do not bound the body."""
ARMPIT = 0.6
"""So much of the upper arm, from the shoulder, always lies against the trunk and is not counted."""
DIGITS = ("thumb", "index", "middle", "ring", "little")
CONTACT_M, PALM_CONTACT_M = 0.02, 0.055
"""So far about a meant contact flesh yields, which skin that follows bones does not show; and
about one on a palm, which is hollow: its edges stand out around what lies in it."""
OWN_WEIGHT = 0.9
"""A vertex belongs to a limb if so much of its skin weight does."""
DIRECTIONS = np.array([d for d in product((-1, 0, 1), repeat=3) if d > (0, 0, 0)], dtype=float).T
"""Axes and diagonals of a cube, (3, 13): what is inside a part lies between its ends along all."""


@dataclass(frozen=True, slots=True)
class Penetration:
    """A limb inside another part of the body: how deep, and where in the world, metres."""

    limb: str
    body: str
    depth_m: float
    point: tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Contact:
    """Touching that is meant about a point (3,) in the world: there nothing is counted."""

    point: Array
    radius_m: float


def meant_contact(evaluator: Evaluator, frames: Frames, place: Place) -> Contact:
    """Return the contact that a placement of a site on a site makes."""
    sites = [place.site, *([place.point.site] if isinstance(place.point, SitePoint) else [])]
    palm = any(evaluator.binding.site(site).bone.startswith("palm") for site in sites)
    point = evaluator.site(place.site, frames)
    return Contact(point, PALM_CONTACT_M if palm else CONTACT_M)


@dataclass(frozen=True, slots=True, eq=False)
class TestedLimb:
    """Vertices that are tested, (n,), and those of them that are against the own hand, (m,)."""

    side: str
    all: NDArray[np.int64]
    beyond_web: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Regions:
    """Limbs that are tested, and triangles (F, 3) that bound the parts, of those that have any.

    corners: the vertices of these triangles, (m,).
    """

    limbs: Mapping[str, TestedLimb]
    surfaces: Mapping[str, NDArray[np.int64]]
    corners: Mapping[str, NDArray[np.int64]]


def mesh_penetration(
    rig: Rig, q: Array, contacts: Sequence[Contact] = (), parts: Collection[str] | None = None
) -> tuple[Penetration, ...]:
    """Return where arms and digits enter trunk, head, the other arm or each other, deepest first.

    Args: q: (V,) coordinates of one posture. contacts: where touching is meant.
        parts: those that matter, such as `thumb_R`; all by default.
    """
    regions = skin_regions(rig)
    vertices = rig.skin(rig.pose(q))
    surfaces = {
        name: vertices[triangles]
        for name, triangles in regions.surfaces.items()
        if parts is None or name in parts
    }
    along = vertices @ DIRECTIONS
    slabs = {n: (along[c].min(axis=0), along[c].max(axis=0)) for n, c in regions.corners.items()}
    found = []
    for name, limb in regions.limbs.items():
        if parts is not None and name not in parts:
            continue
        for body, surface in surfaces.items():
            if body == name or (name.startswith("arm_") and body.endswith(f"_{limb.side}")):
                continue
            tested = limb.beyond_web if body.endswith(f"_{limb.side}") else limb.all
            low, high = slabs[body]
            between = np.all((along[tested] > low) & (along[tested] < high), axis=1)
            points = vertices[tested[between]]
            for contact in contacts:
                points = points[np.linalg.norm(points - contact.point, axis=1) > contact.radius_m]
            inside = points[winding_numbers(points, surface) > 0.5]
            if len(inside):
                depth = distances(inside, surface)
                k = int(depth.argmax())
                x, y, z = (float(v) for v in inside[k])
                found.append(Penetration(name, body, float(depth[k]), (x, y, z)))
    return tuple(sorted(found, key=lambda p: -p.depth_m))


@lru_cache(maxsize=4)
def skin_regions(rig: Rig) -> Regions:
    """Return what is tested on the skin of a body, and the surfaces that bound its parts."""
    mesh = rig.mesh
    structure = anatomy(rig.chain, rig.coordinates)
    carriers = _carriers(rig)
    region = _joint_regions(rig, structure, carriers)
    names = dict.fromkeys(str(name) for name in region)
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
        if (bounding & whole).any():
            surfaces[name] = mesh.triangles[bounding & whole]
    limbs = {}
    for name in names:
        if name in ("trunk", "head"):
            continue
        side = name[-1]
        own = on_surface & (share[name] > OWN_WEIGHT)
        if name.startswith("arm_"):
            own &= _along_upper_arm(rig, side) > ARMPIT
            limbs[name] = TestedLimb(side, np.flatnonzero(own), np.empty(0, dtype=np.int64))
            continue
        second = rig.bones.get(f"{name}_2", rig.bones[f"{name}_1"]).node
        far = np.array([n >= 0 and structure.is_above(second, n) for n in carriers])
        beyond = np.sum(mesh.weights * far[mesh.joints], axis=1) > OWN_WEIGHT
        limbs[name] = TestedLimb(side, np.flatnonzero(own), np.flatnonzero(own & beyond))
    return Regions(limbs, surfaces, {name: np.unique(t) for name, t in surfaces.items()})


def _carriers(rig: Rig) -> list[int]:
    """Node that each joint of the skeleton moves with, −1 for none, (J,)."""
    nodes = []
    for j in range(len(rig.skeleton.names)):
        source = int(rig.drive.helper_of[j])
        nodes.append(int(rig.drive.node[source if source >= 0 else j]))
    return nodes


def _joint_regions(rig: Rig, structure: Anatomy, carriers: list[int]) -> NDArray[np.str_]:
    """Region that each joint of the skeleton moves with, (J,)."""
    limbs = {"head": rig.bones["neck"].origin_node}
    limbs |= {f"arm_{side}": rig.bones[f"arm_{side}"].node for side in "LR"}
    digits = {f"{d}_{side}": rig.bones.get(f"{d}_{side}_1") for side in "LR" for d in DIGITS}
    limbs |= {name: bone.node for name, bone in digits.items() if bone is not None}
    out = []
    for node in carriers:
        above = [name for name, n in limbs.items() if node >= 0 and structure.is_above(n, node)]
        out.append(above[-1] if above else "trunk")
    return np.array(out)


def _along_upper_arm(rig: Rig, side: str) -> Array:
    """How far along the upper arm vertices lie in the mesh's own posture: 0 shoulder, 1 elbow."""
    frames = rig.chain.frames(rig.coordinates.bind)
    shoulder = rig.bones[f"arm_{side}"].node
    elbow = rig.bones[f"f_arm_{side}"].origin_node
    axis = frames.rotations[shoulder, :, DIR]
    length = float(axis @ (frames.positions[elbow] - frames.positions[shoulder]))
    return np.asarray((rig.mesh.vertices - frames.positions[shoulder]) @ axis / length)
