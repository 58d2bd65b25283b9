"""The body that a glTF file shows: one mesh on one set of joints, in the space of the scene.

What counts is where joints are, never how their axes lie: a rig has its own. All skinned meshes
are joined, and what is fixed to a joint without a skin. They are taken as they were bound (the
inverse bind matrices), not as the nodes stand, which is often the first frame of an animation.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.importing.accessors import read_array
from azee_rig.importing.container import GltfFile
from azee_rig.importing.fault import BodyError, unreadable
from azee_rig.importing.nodes import FARTHEST, Nodes, read_nodes
from azee_rig.importing.paint import painted
from azee_rig.importing.skeleton_tree import nearest_of
from azee_rig.importing.surface_parts import Primitive, read_primitives, stacked, target_names
from azee_rig.mesh import Part

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FLAT, NOTHING = 1e-6, 1e-12
"""A space is flat where one scale is so much smaller than another, or all are next to nothing."""
SAME_M = 1e-3
"""Joints of the nodes and of the binding are the same posture if no further apart, relative to
the figure's size."""


@dataclass(frozen=True, eq=False)
class Target:
    """A morph target: mesh and number in the file, its name, and what it moves at weight 1."""

    mesh: int
    number: int
    name: str
    rows: Ints
    deltas: Floats


@dataclass(frozen=True, eq=False)
class SceneBody:
    """A body as its makers left it, in the space and the unit of the scene.

    joints: unique names, parents before children; parents (J,); places (J, 3); bound (J, 4, 4):
    where they were bound; nodes: their numbers in the file. vertices (N, 3); triangles (F, 3);
    parts: materials; colours (N, 3) linear. influences (N, K) joints, weights (N, K) summing to 1.
    targets: morph targets.
    posed: whether the nodes stand in another posture than the one that was bound.
    notes: what was left out or put right.
    """

    joints: tuple[str, ...]
    parents: Ints
    places: Floats
    bound: Floats
    nodes: tuple[int, ...]
    vertices: Floats
    triangles: Ints
    parts: tuple[Part, ...]
    colours: Floats
    influences: Ints
    weights: Floats
    targets: tuple[Target, ...]
    posed: bool
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Skin:
    """Joints of one skin as nodes, and where each was bound in the mesh's space, (n, 4, 4)."""

    joints: tuple[int, ...]
    bound: Floats


@dataclass(eq=False)
class _Collected:
    """Pieces on their way into one mesh."""

    bind: dict[int, Floats] = field(default_factory=dict)
    primitives: list[Primitive] = field(default_factory=list)
    influences: list[Ints] = field(default_factory=list)
    weights: list[Floats] = field(default_factory=list)
    moved: list[Floats] = field(default_factory=list)
    targets: list[tuple[int, Sequence[str], Floats]] = field(default_factory=list)
    """Per primitive: its mesh, the names of the mesh's targets, and the turn of its vectors."""
    loose: int = 0

    def add(
        self,
        primitive: Primitive,
        to_scene: Floats,
        joints: Ints,
        weights: Floats,
        mesh: int,
        names: Sequence[str],
    ) -> None:
        self.primitives.append(primitive)
        self.moved.append(primitive.vertices @ to_scene[:3, :3].T + to_scene[:3, 3])
        self.influences.append(joints)
        self.weights.append(weights)
        self.targets.append((mesh, names, to_scene[:3, :3]))


def read_scene(file: GltfFile) -> SceneBody:
    """Read the body of a file.

    Raises: BodyError: the file is damaged, or has no skinned mesh.
    """
    nodes = read_nodes(file)
    skins = [_skin(file, nodes, row, i) for i, row in enumerate(file.all("skins"))]
    if not skins:
        raise BodyError(
            "body-incomplete",
            "it has no skin: nothing says which joints move the mesh",
            "a signing body needs a skeleton, and a mesh that is bound to it",
            help_="bind the mesh to a skeleton (in Blender: Parent › Armature Deform) and save it "
            "as .glb again",
        )
    rows = [
        (i, row["mesh"], row.get("skin"))
        for i, row in enumerate(file.all("nodes"))
        if row.get("mesh") is not None
    ]
    found = _Collected()
    for _, mesh, skin in rows:
        if skin is not None:
            file.one("skins", skin)
            _add_skinned(found, file, nodes, skins[skin], file.one("meshes", mesh), mesh)
    if not sum(len(p.triangles) for p in found.primitives):
        raise BodyError("body-incomplete", "it has a skin, but no mesh of triangles bound to it")
    for node, mesh, skin in rows:
        if skin is None:
            _add_fixed(found, file, nodes, node, file.one("meshes", mesh), mesh)
    return _joined(found, file, nodes)


def _skin(file: GltfFile, nodes: Nodes, row: Mapping[str, Any], number: int) -> _Skin:
    joints = row.get("joints")
    if not isinstance(joints, list) or not joints:
        raise unreadable(f"skin {number} has no joints")
    for joint in joints:
        file.one("nodes", joint)
    if row.get("inverseBindMatrices") is None:
        # By the format these are identities: vertices are in each joint's own space.
        return _Skin(tuple(joints), np.tile(np.eye(4), (len(joints), 1, 1)))
    inverse = read_array(file, row["inverseBindMatrices"], "MAT4").astype(np.float64)
    if len(inverse) < len(joints):
        raise unreadable(f"skin {number} has {len(joints)} joints and {len(inverse)} matrices")
    inverse = inverse[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1)
    try:
        bound = np.linalg.inv(inverse).astype(np.float64)
        back = np.linalg.inv(bound)
    except np.linalg.LinAlgError as error:
        raise unreadable(f"skin {number} has a matrix that cannot be inverted") from error
    if not (np.abs(bound) < FARTHEST).all() or not np.allclose(back @ bound, np.eye(4), atol=1e-3):
        raise unreadable(f"skin {number} has a matrix that cannot be inverted")
    return _Skin(tuple(joints), bound)


def _flat(transform: Floats) -> bool:
    """Whether a transform takes a space to a plane or to a point, as scales of zero do."""
    sizes = np.linalg.svd(transform[:3, :3], compute_uv=False)
    return float(sizes[2]) < max(NOTHING, FLAT * float(sizes[0]))


def _add_skinned(
    found: _Collected, file: GltfFile, nodes: Nodes, skin: _Skin, mesh: Mapping[str, Any], at: int
) -> None:
    if len(set(skin.joints)) < len(skin.joints):
        raise unreadable("a skin names a joint twice")
    known = next((k for k, joint in enumerate(skin.joints) if joint in found.bind), None)
    first = min(range(len(skin.joints)), key=lambda k: nodes.depth[skin.joints[k]])
    if known is None:
        to_scene = nodes.world[skin.joints[first]] @ np.linalg.inv(skin.bound[first])
    else:
        to_scene = found.bind[skin.joints[known]] @ np.linalg.inv(skin.bound[known])
    if _flat(to_scene):
        raise BodyError(
            "body-incomplete", "a node above its skeleton is scaled to nothing: it has no size"
        )
    for joint, bound in zip(skin.joints, skin.bound, strict=True):
        found.bind.setdefault(joint, to_scene @ bound)
    numbers = np.array(skin.joints)
    for primitive in read_primitives(file, mesh):
        if not primitive.joints.shape[1]:
            found.loose += len(primitive.vertices)
            continue
        if primitive.joints.max(initial=0) >= len(numbers):
            raise unreadable(
                f"a vertex hangs on joint {primitive.joints.max()} of a skin of {len(numbers)}"
            )
        found.add(
            primitive,
            to_scene,
            numbers[primitive.joints],
            primitive.weights,
            at,
            target_names(mesh),
        )


def _add_fixed(
    found: _Collected, file: GltfFile, nodes: Nodes, node: int, mesh: Mapping[str, Any], at: int
) -> None:
    """Add a mesh without a skin that is fixed to a joint, such as an eyeball or glasses."""
    joint = next((n for n in (node, *nodes.above(node)) if n in found.bind), None)
    for primitive in read_primitives(file, mesh):
        count = len(primitive.vertices)
        if joint is None or _flat(nodes.world[node]) or _flat(nodes.world[joint]):
            found.loose += count
            continue
        to_scene = found.bind[joint] @ np.linalg.inv(nodes.world[joint]) @ nodes.world[node]
        of = np.full((count, 1), joint)
        found.add(primitive, to_scene, of, np.ones((count, 1)), at, target_names(mesh))


def _joined(found: _Collected, file: GltfFile, nodes: Nodes) -> SceneBody:
    """Bring all pieces together, on all joints of all skins and the nodes between and below."""
    joints = _joint_nodes(found, nodes)
    index = {node: j for j, node in enumerate(joints)}
    notes = []
    if found.loose:
        notes.append(f"{found.loose} vertices hang on no joint and are left out")
    starts = np.cumsum([0, *(len(p.vertices) for p in found.primitives)])
    width = max(w.shape[1] for w in found.weights)
    influences = stacked(found.influences, width)
    weights = stacked(found.weights, width)
    weights[~np.isin(influences, joints)] = 0.0
    lookup = np.zeros(len(nodes.names), np.int64)
    lookup[list(index)] = list(index.values())
    bound = _bound(found, nodes, joints)
    places = bound[:, :3, 3]
    vertices = np.vstack(found.moved)
    influences = lookup[influences]
    free = weights.sum(axis=1) <= 1e-6
    if free.any():
        notes.append(f"{int(free.sum())} vertices have no weight: each follows the nearest joint")
        held = sorted({index[j] for j in found.bind})
        influences[free, 0] = np.array(held)[nearest_of(vertices[free], places[held])[0]]
        weights[free, 0] = 1.0
    held_at = np.array([places[index[j]] for j in found.bind])
    stand = np.array([nodes.world[j][:3, 3] for j in found.bind])
    size = float(np.ptp(vertices, axis=0).max())
    parts, colours, lost = painted(file, found.primitives)
    notes += lost
    return SceneBody(
        joints=_names(joints, nodes),
        parents=np.array([index.get(nodes.parents[node], -1) for node in joints]),
        places=places,
        bound=bound,
        nodes=joints,
        vertices=vertices,
        triangles=np.vstack(
            [p.triangles + s for p, s in zip(found.primitives, starts, strict=False)]
        ),
        parts=parts,
        colours=colours,
        influences=influences,
        weights=weights / weights.sum(axis=1, keepdims=True),
        targets=tuple(_targets(found, starts)),
        posed=bool(np.abs(held_at - stand).max() > SAME_M * size),
        notes=tuple(notes),
    )


def _joint_nodes(found: _Collected, nodes: Nodes) -> tuple[int, ...]:
    """Nodes of all skins, those between them, and those below, which mark ends of bones."""
    held = set(found.bind)
    under: set[int] = set()
    for node in nodes.order:
        if nodes.parents[node] in held or nodes.parents[node] in under:
            under.add(node)
    tops = [n for n in found.bind if n not in under]
    common = set(nodes.above(tops[0])) | {tops[0]}
    for top in tops[1:]:
        common &= set(nodes.above(top)) | {top}
    root = max(common, key=lambda n: nodes.depth[n], default=None)
    if root is None:
        raise unreadable("its joints hang on no common root")
    below = {root}
    for node in nodes.order:
        if nodes.parents[node] in below:
            below.add(node)
    over = {root}
    for node in reversed(nodes.order):
        if node in below and (node in held or node in over):
            over |= {node, nodes.parents[node]}
    return tuple(n for n in nodes.order if n in below and (n in under or n in over))


def _bound(found: _Collected, nodes: Nodes, joints: Sequence[int]) -> Floats:
    """Return where each joint was bound, (J, 4, 4) in the scene."""
    bind: dict[int, Floats] = {}
    for node in joints:
        if node in found.bind:
            bind[node] = found.bind[node]
        elif nodes.parents[node] in bind:
            bind[node] = bind[nodes.parents[node]] @ nodes.local[node]
        else:
            bind[node] = nodes.world[node]
    return np.array([bind[node] for node in joints])


def _names(joints: Sequence[int], nodes: Nodes) -> tuple[str, ...]:
    names: list[str] = []
    taken: set[str] = set()
    for node in joints:
        name = nodes.names[node] or f"joint_{node}"
        while name in taken:
            name = f"{name}_{node}"
        taken.add(name)
        names.append(name)
    return tuple(names)


def _targets(found: _Collected, starts: Ints) -> list[Target]:
    made = []
    for primitive, (mesh, names, turn), start in zip(
        found.primitives, found.targets, starts, strict=False
    ):
        for number, deltas in enumerate(primitive.targets):
            rows = np.flatnonzero(np.abs(deltas).max(axis=1) > 0.0)
            name = names[number] if number < len(names) else f"target_{mesh}_{number}"
            made.append(Target(mesh, number, name, rows + int(start), deltas[rows] @ turn.T))
    return made
