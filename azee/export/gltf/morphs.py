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
    around_of = _Around(T, count)
    corners = mesh.vertices[T]
    faces = _crossed(corners)
    sums = _summed(faces, T, count)
    normals = _unit(sums)
    shift, place = np.zeros((count, 3)), np.empty(count, np.intp)
    for name in mesh.units:
        rows, deltas = mesh.unit(name)
        shift[rows] = deltas
        touched = around_of(rows)
        triangles = T[touched]
        change = _crossed(corners[touched] + shift[triangles]) - faces[touched]
        shift[rows] = 0.0
        around = np.flatnonzero(_marked(triangles.ravel(), count))
        place[around] = np.arange(len(around))
        turned = sums[around] + _summed(change, place[triangles], len(around))
        turns = _unit(turned) - normals[around]
        order = np.argsort(rows)
        far = _largest(deltas[order]) > LEAST_MOVE_M
        seen = _largest(turns) > LEAST_TURN
        yield MorphTarget(rows[order][far], deltas[order][far], around[seen], turns[seen])


class _Around:
    """The triangles around vertices."""

    def __init__(self, triangles: NDArray[np.int64], count: int) -> None:
        corners = triangles.ravel()
        self._triangles = len(triangles)
        self._of = np.argsort(corners, kind="stable") // 3
        self._starts = np.concatenate([[0], np.cumsum(np.bincount(corners, minlength=count))])

    def __call__(self, rows: NDArray[np.int64]) -> Rows:
        """Return those that have a corner among some vertices, increasing."""
        first, sizes = self._starts[rows], self._starts[rows + 1] - self._starts[rows]
        behind = np.cumsum(sizes) - sizes
        places = np.repeat(first - behind, sizes) + np.arange(int(sizes.sum()))
        return np.flatnonzero(_marked(self._of[places], self._triangles))


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


def _crossed(corners: Floats) -> Floats:
    """Return normals of triangles, as long as twice their areas, of their corners (F, 3, 3)."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    (ux, uy, uz), (vx, vy, vz) = u.T, v.T
    return np.stack([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], axis=1)


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.where(length > 0, length, 1))
