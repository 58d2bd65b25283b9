"""Face units as morph targets: where each moves the surface, and how it turns the normals."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.mesh import BodyMesh

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]

LEAST_MOVE_M = 1e-6
LEAST_TURN = 2e-3
"""Changes of position (metres) and normal (of length 1) that are left out as invisible."""


@dataclass(frozen=True, eq=False)
class MorphTarget:
    """What one face unit adds at weight 1.

    moves: (n, 3) metres, to the vertices `moved` (n,), increasing. turns: (m, 3), to the unit
    normals of the vertices `turned` (m,).
    """

    moved: Rows
    moves: Floats
    turned: Rows
    turns: Floats


def morph_targets(mesh: BodyMesh) -> Iterator[MorphTarget]:
    """Yield a target for every face unit of a mesh, in its order.

    A normal is the mean of the normals around it, weighted by area, as in `vertex_normals`; only
    triangles that the unit moves are computed again.
    """
    T, count = mesh.triangles, len(mesh.vertices)
    faces = _cross(mesh.vertices, T)
    sums = _summed(faces, T, count)
    normals = _unit(sums)
    for name in mesh.units:
        rows, deltas = mesh.unit(name)
        vertices = mesh.vertices.copy()
        vertices[rows] += deltas
        moved = _marked(rows, count)
        touched = T[moved[T[:, 0]] | moved[T[:, 1]] | moved[T[:, 2]]]
        change = _cross(vertices, touched) - _cross(mesh.vertices, touched)
        around = np.flatnonzero(_marked(touched.ravel(), count))
        turns = _unit(sums[around] + _summed(change, touched, count)[around]) - normals[around]
        order = np.argsort(rows)
        far = _largest(deltas[order]) > LEAST_MOVE_M
        seen = _largest(turns) > LEAST_TURN
        yield MorphTarget(rows[order][far], deltas[order][far], around[seen], turns[seen])


def _summed(faces: Floats, triangles: NDArray[np.int64], count: int) -> Floats:
    """Return for each of `count` vertices the sum over the triangles that it is a corner of."""
    corners = triangles.T.ravel()
    return np.stack(
        [np.bincount(corners, np.tile(faces[:, k], 3), count) for k in range(3)], axis=1
    )


def _marked(rows: NDArray[np.int64], count: int) -> NDArray[np.bool_]:
    marks = np.zeros(count, np.bool_)
    marks[rows] = True
    return marks


def _largest(vectors: Floats) -> Floats:
    """Return the largest component of each vector, by amount."""
    x, y, z = np.abs(vectors).T
    return np.asarray(np.maximum(np.maximum(x, y), z))


def _cross(vertices: Floats, triangles: NDArray[np.int64]) -> Floats:
    """Return normals of triangles, as long as twice their areas."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a)


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.where(length > 0, length, 1))
