"""The body's surface as one glTF mesh: a primitive per material, skinned, with morph targets."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.export.formats.gltf.document import Document, Target
from azee.export.formats.gltf.morphs import MorphTarget, morph_targets
from azee_rig.mesh import BodyMesh, Part

FULL = 65535
"""1 as a normalised unsigned 16-bit integer."""
INFLUENCES = 4
"""Joints in one pair of JOINTS_n and WEIGHTS_n."""


def add_mesh(document: Document, mesh: BodyMesh, name: str) -> int:
    """Add the mesh in its bind pose; returns its index.

    Every primitive has all morph targets, as glTF asks; what a target leaves alone costs nothing.
    Materials have two sides: hairs are flat, and clothes of imported bodies may have open ends,
    beyond which one sees their inside. The names of the targets stand in the mesh's extras, where
    viewers look.
    """
    targets = _Targets(list(morph_targets(mesh)))
    primitives = [_primitive(document, mesh, part, targets) for part in mesh.parts]
    return document.add(
        "meshes",
        name=name,
        primitives=primitives,
        weights=[0.0] * len(mesh.units) if mesh.units else None,
        extras={"targetNames": list(mesh.units)} if mesh.units else None,
    )


def _primitive(document: Document, mesh: BodyMesh, part: Part, targets: _Targets) -> dict[str, Any]:
    used, inverse = np.unique(mesh.triangles[part.start : part.stop], return_inverse=True)
    count = len(used)
    attributes = {
        "POSITION": _vertices(document, mesh.vertices[used].astype(np.float32), bounds=True),
        "NORMAL": _vertices(document, _unit32(mesh.normals[used])),
        "COLOR_0": _vertices(document, _colours(mesh.colours[used]), normalized=True),
        **_influences(document, mesh.joints[used], mesh.weights[used]),
    }
    primitive: dict[str, Any] = {
        "attributes": attributes,
        "indices": document.accessor(
            inverse.ravel().astype(np.uint16 if count < FULL else np.uint32), target=Target.INDICES
        ),
        "material": document.add(
            "materials",
            name=part.name,
            doubleSided=True,
            pbrMetallicRoughness={
                "baseColorFactor": list(part.colour),
                "metallicFactor": 0.0,
                "roughnessFactor": part.roughness,
            },
        ),
    }
    if mesh.units:
        place = np.full(len(mesh.vertices), -1, np.intp)
        place[used] = np.arange(count)
        primitive["targets"] = targets.of(document, place, count)
    return primitive


def _vertices(
    document: Document, array: NDArray[Any], bounds: bool = False, normalized: bool = False
) -> int:
    return document.accessor(array, target=Target.VERTICES, bounds=bounds, normalized=normalized)


def _unit32(normals: NDArray[np.float64]) -> NDArray[np.float32]:
    """Give a vertex without a normal one that points forward, since glTF requires length 1."""
    bare = np.linalg.norm(normals, axis=1, keepdims=True) < 0.5
    return np.where(bare, (0, 0, 1), normals).astype(np.float32)


def _colours(colours: NDArray[np.float64]) -> NDArray[np.uint16]:
    """Return linear RGB as opaque RGBA with 16 bits; 8 are too coarse in the dark when linear."""
    opaque = np.hstack([colours, np.ones((len(colours), 1))])
    return np.round(opaque * FULL).astype(np.uint16)


def _influences(
    document: Document, joints: NDArray[np.int64], weights: NDArray[np.float64]
) -> dict[str, int]:
    """Return joints and weights in sets of four; a further set only if a vertex needs it.

    Weights are rounded to parts of 65535 and the remainder goes to the heaviest, so that they sum
    to 1 exactly. An influence without weight names joint 0, as glTF requires.
    """
    parts = np.round(weights * FULL).astype(np.int64)
    parts[:, 0] += FULL - parts.sum(axis=1)
    sets = max(1, -(-int((parts > 0).sum(axis=1).max()) // INFLUENCES))
    order = np.argsort(-parts, axis=1, kind="stable")
    padding = ((0, 0), (0, max(0, sets * INFLUENCES - parts.shape[1])))
    parts = np.pad(np.take_along_axis(parts, order, axis=1), padding)
    joints = np.where(parts > 0, np.pad(np.take_along_axis(joints, order, axis=1), padding), 0)
    attributes = {}
    for i in range(sets):
        columns = slice(i * INFLUENCES, (i + 1) * INFLUENCES)
        kind = np.uint8 if joints.max() < 256 else np.uint16
        attributes[f"JOINTS_{i}"] = _vertices(document, joints[:, columns].astype(kind))
        attributes[f"WEIGHTS_{i}"] = _vertices(
            document, parts[:, columns].astype(np.uint16), normalized=True
        )
    return attributes


class _Targets:
    """Morph targets of a whole mesh, to be divided among its primitives."""

    def __init__(self, targets: list[MorphTarget]) -> None:
        self._moves = _Changes([(t.moved, t.moves) for t in targets])
        self._turns = _Changes([(t.turned, t.turns) for t in targets])

    def of(self, document: Document, place: NDArray[np.intp], count: int) -> list[dict[str, int]]:
        """Add those of a primitive, sparse; `place` is each vertex' row in it, or −1."""
        zeros = np.zeros((0, 3), np.float32)
        nothing = document.sparse_accessor(count, place[:0], zeros, bounds=True)

        def add(changes: _Changes, bounds: bool) -> list[int]:
            return [
                document.sparse_accessor(count, rows, values, bounds=bounds)
                if len(rows)
                else nothing
                for rows, values in changes.inside(place)
            ]

        return [
            {"POSITION": moves, "NORMAL": turns}
            for moves, turns in zip(add(self._moves, True), add(self._turns, False), strict=True)
        ]


class _Changes:
    """Changes of vertices by many targets, one after the other in one array."""

    def __init__(self, changes: list[tuple[NDArray[np.intp], NDArray[np.float64]]]) -> None:
        self._starts = np.cumsum([0, *(len(rows) for rows, _ in changes)])
        self._rows = np.concatenate([rows for rows, _ in changes] or [np.empty(0, np.intp)])
        self._values = np.vstack([values for _, values in changes] or [np.empty((0, 3))]).astype(
            np.float32
        )

    def inside(
        self, place: NDArray[np.intp]
    ) -> Iterator[tuple[NDArray[np.intp], NDArray[np.float32]]]:
        """Yield rows (n,) and values (n, 3) of every target that belong to a primitive."""
        at = place[self._rows]
        kept = np.flatnonzero(at >= 0)
        rows, values = at[kept], self._values[kept]
        for start, stop in pairwise(np.searchsorted(kept, self._starts).tolist()):
            yield rows[start:stop], values[start:stop]
