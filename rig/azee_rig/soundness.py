"""Holds the parts of a rig together: every index that a compiled loop follows is checked here.

Compiled loops check nothing: an index out of range reads foreign memory. A body is checked once,
when it is loaded. Every function raises ValueError.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Chain
from azee_rig.mesh import BodyMesh
from azee_rig.rig import Rig

ORTHONORMAL = 1e-6
"""How far R Rᵀ of a frame may be off the identity."""
BODY_BONES = (
    *("back_1", "back_2", "neck", "head"),
    *(f"{bone}_{side}" for side in "LR" for bone in ("clav", "arm", "f_arm", "palm", "eye")),
)
"""AZee's bones but for the digits', which a body may lack."""
OFF_SKIN_M = 0.03
"""Sites whose middle distance from the nearest vertex is larger belong to another body."""
SAMPLED = 8
"""Every so many-th site is looked at."""


def check_rig(rig: Rig) -> None:
    """Hold a rig's description together, without its mesh."""
    check_chain(rig.chain, len(rig.coordinates))
    _check_skeleton(rig)
    _check_drive(rig)
    nodes, capsules = len(rig.chain.names), rig.capsules
    lacking = [bone for bone in BODY_BONES if bone not in rig.bones]
    if lacking:
        raise ValueError(f"`bones` has no `{lacking[0]}`")
    for bone in rig.bones:
        digit = bone.rpartition("_")[0]
        if bone not in BODY_BONES and not all(f"{digit}_{k}" in rig.bones for k in (1, 2, 3)):
            raise ValueError(f"`bones` has `{bone}`, but not all of `{digit}_1` … `{digit}_3`")
    for bone, at in rig.bones.items():
        _within([at.node, at.origin_node], 0, nodes, f"bones.{bone}", "node")
    for site in rig.sites.values():
        _within([site.node, *site.nodes], -1, nodes, f"sites.{site.name}", "node")
        if site.bone not in rig.bones:
            raise ValueError(f"`sites.{site.name}` names a bone `{site.bone}`, which is not there")
        if not site.normal.any() and not site.shares:
            raise ValueError(f"`sites.{site.name}` has a normal of no length")
    _within(capsules.node, 0, nodes, "capsules", "node")
    if capsules.radius.min(initial=0.0) < 0.0:
        raise ValueError("`capsules` has a radius below zero")
    for key, pairs in (("pairs", capsules.pairs), ("finger_pairs", capsules.finger_pairs)):
        _within(pairs, 0, len(capsules.names), key, "capsule")
    _check_names(rig)


def check_chain(chain: Chain, coordinates: int) -> None:
    """Hold a chain together. coordinates: how many there are."""
    count = len(chain.names)
    if not count:
        raise ValueError("`nodes` is empty")
    _check_parents(chain.parents, "nodes")
    _within(chain.dof_axis, 0, 3, "nodes.turns", "axis")
    _within(chain.dof_coordinate, 0, coordinates, "nodes.turns", "coordinate")
    off = chain.zero @ np.swapaxes(chain.zero, 1, 2) - np.eye(3)
    if np.abs(off).max() > ORTHONORMAL or np.linalg.det(chain.zero).min() < 0.0:
        raise ValueError("`nodes.zero` has a frame that is no rotation")


def _check_skeleton(rig: Rig) -> None:
    if not rig.skeleton.names:
        raise ValueError("`skeleton` has no joints")
    _check_parents(rig.skeleton.parents, "skeleton.parents")


def _check_parents(parents: NDArray[np.int64], place: str) -> None:
    """Hold parents to stand before their children, below one root, the first."""
    wrong = np.flatnonzero((parents < -1) | (parents >= np.arange(len(parents))))
    if len(wrong):
        at = int(wrong[0])
        raise ValueError(f"`{place}`: {parents[at]} is no parent for number {at}")
    if (parents[1:] < 0).any() or parents[0] >= 0:
        raise ValueError(f"`{place}` has more than one root, or none")


def _check_drive(rig: Rig) -> None:
    drive, joints = rig.drive, len(rig.skeleton.names)
    if len(drive.node) != joints:
        raise ValueError(f"`drive` has {len(drive.node)} rows for {joints} joints")
    _within(drive.node, -1, len(rig.chain.names), "drive", "node")
    _within(drive.twist_coordinate, -1, len(rig.coordinates), "drive", "coordinate")
    _within(drive.helper_of, -1, joints, "drive", "joint")
    helpers = drive.helper_of >= 0
    parents = rig.skeleton.parents
    if helpers[parents[1:]].any() or helpers[0] or helpers[drive.helper_of[helpers]].any():
        raise ValueError("`drive` has a helper that carries another joint")
    if (parents[helpers] != parents[drive.helper_of[helpers]]).any():
        raise ValueError("`drive` has a helper that hangs on another joint than what it helps")


def _check_names(rig: Rig) -> None:
    """Hold morphs and lids to coordinates and units that are there."""
    tables: list[tuple[str, Iterable[str], Any, str]] = [
        *(
            (f"skeletal_morphs.{m}", moves, rig.coordinates.index, "coordinate")
            for m, moves in rig.skeletal_morphs.items()
        ),
        *((f"face_morphs.{m}", w, rig.units, "face unit") for m, w in rig.face_morphs.items()),
        ("lids", rig.lids, rig.units, "face unit"),
        ("lids", [name for name, _ in rig.lids.values()], rig.coordinates.index, "coordinate"),
    ]
    for place, used, known, what in tables:
        for name in used:
            if name not in known:
                raise ValueError(f"`{place}` names a {what} `{name}`, which is not there")


def check_mesh(rig: Rig, mesh: BodyMesh) -> None:
    """Hold a mesh against the rig that it is to dress: joints and face units must agree."""
    joints = len(rig.skeleton.names)
    if mesh.joint_count != joints:
        raise ValueError(f"its mesh hangs on {mesh.joint_count} joints, its skeleton has {joints}")
    if mesh.units != rig.units:
        raise ValueError("its mesh has other face units than its description")


def check_same_body(rig: Rig, mesh: BodyMesh) -> None:
    """Hold the sites of a description against a mesh whose digest it does not know."""
    if not rig.sites or not len(mesh.vertices):
        return
    frames = rig.chain.frames(rig.coordinates.bind)
    points = [site.point(frames) for site in [*rig.sites.values()][::SAMPLED]]
    away = [float(np.linalg.norm(mesh.vertices - point, axis=1).min()) for point in points]
    if np.median(away) > OFF_SKIN_M:
        raise ValueError("its mesh is another body's: the sites do not lie on its skin")


def _within(
    indices: Iterable[int] | NDArray[np.int64], low: int, high: int, place: str, what: str
) -> None:
    array = np.asarray(indices, dtype=np.int64)
    wrong = array[(array < low) | (array >= high)]
    if len(wrong):
        raise ValueError(f"`{place}` names {what} {wrong[0]}; there are {high}")
