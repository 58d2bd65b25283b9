"""Face units as morph targets: where each moves the surface, and how it turns the normals."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.mesh import BodyMesh, turned_normals

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]

LEAST_MOVE_M = 1e-6
LEAST_TURN = 2e-3
"""Changes of position (metres) and normal (of length 1) that are left out as invisible."""


@dataclass(frozen=True, eq=False)
class MorphTarget:
    """The change of the surface by one face unit at weight 1.

    moves: (n, 3) metres, to the vertices `moved` (n,), increasing. turns: (m, 3), to the unit
        normals of the vertices `turned` (m,).
    """

    moved: Rows
    moves: Floats
    turned: Rows
    turns: Floats


def morph_targets(mesh: BodyMesh) -> Iterator[MorphTarget]:
    """Yield a target for every face unit of a mesh, in its order."""
    for name, (around, normals) in zip(mesh.units, turned_normals(mesh), strict=True):
        rows, deltas = mesh.unit(name)
        order = np.argsort(rows)
        turns = normals - mesh.normals[around]
        far = _largest(deltas[order]) > LEAST_MOVE_M
        seen = _largest(turns) > LEAST_TURN
        yield MorphTarget(rows[order][far], deltas[order][far], around[seen], turns[seen])


def _largest(vectors: Floats) -> Floats:
    """Return the largest component of each vector, by amount."""
    x, y, z = np.abs(vectors).T
    return np.asarray(np.maximum(np.maximum(x, y), z))
