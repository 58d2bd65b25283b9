"""Pieces of a dressed body, and their union as one mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.makehuman import Body
from azee_rig.mesh import BodyMesh, Part, vertex_normals
from azee_rig.nearest import barycentric, nearest

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

INFLUENCES = 8
LEAST_WEIGHT = 1.0 / 1024.0
LEAST_DELTA_M = 1e-5


@dataclass(frozen=True, eq=False)
class Piece:
    """Triangles of one material with everything that their vertices carry.

    vertices (n, 3); triangles (f, 3); weights (n, J); deltas (U, n, 3); colours (n, 3) linear,
    multiplied with the material's colour.
    """

    name: str
    vertices: Floats
    triangles: Ints
    weights: Floats
    deltas: Floats
    colours: Floats
    colour: tuple[float, float, float] = (1.0, 1.0, 1.0)
    roughness: float = 0.7

    def only(self, keep: NDArray[np.bool_]) -> Piece:
        """Return the piece with some of its triangles, (f,), and their vertices only."""
        triangles = self.triangles[keep]
        used = np.unique(triangles)
        renumbered = np.full(len(self.vertices), -1)
        renumbered[used] = np.arange(len(used))
        return replace(
            self,
            vertices=self.vertices[used],
            triangles=renumbered[triangles],
            weights=self.weights[used],
            deltas=self.deltas[:, used],
            colours=self.colours[used],
        )

    def clipped(self, keep: Floats) -> Piece:
        """Return the part of the piece where a function of its vertices, (n,), is positive.

        Triangles that the zero line crosses are cut along it, so that an edge is smooth on any
        mesh. The values of new vertices are interpolated.
        """
        inside = keep > 0.0
        corner = inside[self.triangles]
        count = corner.sum(axis=1)
        made: dict[tuple[int, int], int] = {}
        ends: list[tuple[int, int]] = []

        def crossing(a: int, b: int) -> int:
            edge = (min(a, b), max(a, b))
            if edge not in made:
                made[edge] = len(self.vertices) + len(ends)
                ends.append(edge)
            return made[edge]

        triangles = [self.triangles[count == 3]]
        for t in np.flatnonzero((count == 1) | (count == 2)):
            # Rotate the triangle until its odd corner is first.
            first = int(np.flatnonzero(corner[t] == (count[t] == 1))[0])
            a, b, c = (int(v) for v in np.roll(self.triangles[t], -first))
            ab, ac = crossing(a, b), crossing(a, c)
            new = [[a, ab, ac]] if count[t] == 1 else [[ab, b, c], [ab, c, ac]]
            triangles.append(np.array(new))
        rows = np.array(ends, dtype=np.int64).reshape(-1, 2)
        f = keep[rows]
        share = f[:, 0] / np.where(f[:, 0] == f[:, 1], 1.0, f[:, 0] - f[:, 1])
        shares = np.stack([1.0 - share, share], axis=1)
        return self.extended(rows, shares).retriangulated(np.concatenate(triangles))

    def extended(self, rows: Ints, shares: Floats) -> Piece:
        """Return the piece with more vertices, blends of old ones: rows, shares (m, k)."""
        new = self.blend(rows, shares, np.einsum("mk,mkc->mc", shares, self.vertices[rows]))
        return replace(
            self,
            vertices=np.concatenate([self.vertices, new.vertices]),
            weights=np.concatenate([self.weights, new.weights]),
            deltas=np.concatenate([self.deltas, new.deltas], axis=1),
            colours=np.concatenate([self.colours, new.colours]),
        )

    def retriangulated(self, triangles: Ints) -> Piece:
        """Return the piece with other triangles, and no vertices beyond theirs."""
        return replace(self, triangles=triangles).only(np.ones(len(triangles), dtype=bool))

    def subdivided(self) -> Piece:
        """Return the piece with each triangle cut in four at the middles of its edges."""
        edges = np.sort(self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        unique, which = np.unique(edges, axis=0, return_inverse=True)
        ab, bc, ca = (which.reshape(-1, 3) + len(self.vertices)).T
        a, b, c = self.triangles.T
        new = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        finer = self.extended(unique, np.full((len(unique), 2), 0.5))
        return replace(finer, triangles=np.concatenate([np.stack(t, axis=1) for t in new]))

    def smoothed(self, steps: int, share: Floats | float = 0.5) -> Piece:
        """Return the piece with vertices moved towards their neighbours' mean; its rim stays."""
        pull = np.where(self.on_rim, 0.0, share)[:, None]
        vertices = self.vertices
        for _ in range(steps):
            vertices = vertices + pull * (self._around(vertices) - vertices)
        return replace(self, vertices=vertices)

    def relaxed(self, steps: int, share: float = 0.5) -> Piece:
        """Return the piece with skin weights moved towards their neighbours' mean."""
        weights = self.weights
        for _ in range(steps):
            weights = weights + share * (self._around(weights) - weights)
        return replace(self, weights=weights)

    @cached_property
    def on_rim(self) -> NDArray[np.bool_]:
        """Return which vertices are on an edge with only one triangle, (n,)."""
        unique, times = np.unique(np.sort(self._edges, axis=1), axis=0, return_counts=True)
        found = np.zeros(len(self.vertices), dtype=bool)
        found[unique[times == 1]] = True
        return found

    @property
    def _edges(self) -> Ints:
        return np.concatenate([self.triangles[:, [i, (i + 1) % 3]] for i in range(3)])

    def _around(self, values: Floats) -> Floats:
        """Return the mean of each vertex's neighbours, (n, k)."""
        both = np.concatenate([self._edges, self._edges[:, ::-1]])
        count = np.maximum(np.bincount(both[:, 0], minlength=len(values)), 1)
        columns = [
            np.bincount(both[:, 0], column[both[:, 1]], len(values)) / count for column in values.T
        ]
        return np.stack(columns, axis=1)

    def folded(self, depth_m: float) -> Piece:
        """Return the piece with its rims turned in, so that cloth has a thickness."""
        rows = self.rims[1]
        normals = vertex_normals(self.vertices, self.triangles)[rows]
        rim = self.blend(rows[:, None], np.ones((len(rows), 1)), self.vertices[rows])
        return self.turned_in(replace(rim, vertices=rim.vertices - depth_m * normals))

    def turned_in(self, inner: Piece) -> Piece:
        """Return the piece with a strip from its rims to loose vertices, one per vertex of `rims`.

        The strip has vertices of its own at the rims, for the edge between is sharp.
        """
        edges, rows = self.rims
        outer = self.blend(rows[:, None], np.ones((len(rows), 1)), self.vertices[rows])
        a, b = np.searchsorted(rows, edges.T) + len(self.vertices)
        c, d = a + len(rows), b + len(rows)
        strip = np.concatenate([np.stack([b, a, c], axis=1), np.stack([b, c, d], axis=1)])
        parts = self, outer, inner
        return replace(
            self,
            vertices=np.concatenate([part.vertices for part in parts]),
            triangles=np.concatenate([self.triangles, strip]),
            weights=np.concatenate([part.weights for part in parts]),
            deltas=np.concatenate([part.deltas for part in parts], axis=1),
            colours=np.concatenate([part.colours for part in parts]),
        )

    @property
    def rims(self) -> tuple[Ints, Ints]:
        """Edges with only one triangle, (e, 2), and their vertices in ascending order, (r,)."""
        edges = self._edges
        _, which, times = np.unique(
            np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True
        )
        rim = edges[times[which.ravel()] == 1]
        return rim, np.unique(rim)

    def under(self, points: Floats, depth_m: float) -> Piece:
        """Return loose vertices below the places of this piece's surface nearest to points (n, 3).

        A negative depth is a height above.
        """
        found = nearest(self.vertices, self.triangles, points)
        rows = self.triangles[found.triangles]
        shares = barycentric(self.vertices[rows], found.points)
        normals = np.einsum(
            "mk,mkc->mc", shares, vertex_normals(self.vertices, self.triangles)[rows]
        )
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return self.blend(rows, shares, found.points - depth_m * normals)

    def raised(self, height: Floats | float) -> Piece:
        """Return the piece moved along its normals, by one height in metres or one each."""
        normals = vertex_normals(self.vertices, self.triangles)
        return replace(self, vertices=self.vertices + np.reshape(height, (-1, 1)) * normals)

    def blend(self, rows: Ints, shares: Floats, vertices: Floats) -> Piece:
        """Return loose vertices that move with this piece, without triangles.

        Each takes weights, deltas and colour from some vertices of the piece: rows and shares are
        (m, k), shares sum to 1.
        """
        return replace(
            self,
            vertices=vertices,
            triangles=np.empty((0, 3), dtype=np.int64),
            weights=np.einsum("mk,mkj->mj", shares, self.weights[rows]),
            deltas=np.einsum("mk,umkc->umc", shares, self.deltas[:, rows]),
            colours=np.einsum("mk,mkc->mc", shares, self.colours[rows]),
        )


def triangulated(faces: Ints) -> Ints:
    """Return triangles of faces (F, 4) whose last column is −1 for triangles."""
    quads = faces[faces[:, 3] >= 0]
    return np.concatenate([faces[:, :3], quads[:, [0, 2, 3]]])


def whole_body(body: Body, weights: Floats, units: Sequence[str]) -> Piece:
    """Return all groups of a body as one piece, from which others are cut.

    weights: (N, J) of the new joints.
    """
    deltas = np.zeros((len(units), len(body.vertices), 3))
    for u, unit in enumerate(units):
        rows, moved = body.shapes[unit]
        deltas[u, rows] = moved
    return Piece(
        "body",
        body.vertices,
        triangulated(body.faces),
        weights,
        deltas,
        np.ones((len(body.vertices), 3)),
    )


def assemble(pieces: Sequence[Piece], units: Sequence[str]) -> BodyMesh:
    """Return one mesh of all pieces, with at most eight influences per vertex."""
    counts = np.cumsum([0, *(len(p.vertices) for p in pieces)])
    stops = np.cumsum([0, *(len(p.triangles) for p in pieces)])
    joints, weights = _capped(np.concatenate([p.weights for p in pieces]))
    deltas = np.concatenate([p.deltas for p in pieces], axis=1)
    rows = [np.flatnonzero(np.abs(d).max(axis=1) > LEAST_DELTA_M) for d in deltas]
    return BodyMesh(
        vertices=np.concatenate([p.vertices for p in pieces]),
        triangles=np.concatenate(
            [p.triangles + start for p, start in zip(pieces, counts, strict=False)]
        ),
        parts=tuple(
            Part(p.name, int(a), int(b), (*p.colour, 1.0), p.roughness)
            for p, a, b in zip(pieces, stops, stops[1:], strict=False)
        ),
        colours=np.concatenate([p.colours for p in pieces]),
        joints=joints,
        weights=weights,
        units=tuple(units),
        unit_start=np.cumsum([0, *(len(r) for r in rows)]),
        unit_rows=np.concatenate(rows),
        unit_deltas=np.concatenate([d[r] for d, r in zip(deltas, rows, strict=True)]),
        joint_count=pieces[0].weights.shape[1],
    )


def _capped(weights: Floats) -> tuple[Ints, Floats]:
    """Return the heaviest influences (N, 8): joints, and weights that sum to 1."""
    order = np.argsort(-weights, axis=1, kind="stable")[:, :INFLUENCES]
    kept = np.take_along_axis(weights, order, axis=1)
    kept = np.where(kept >= LEAST_WEIGHT, kept, 0.0)
    return np.where(kept > 0.0, order, 0), kept / kept.sum(axis=1, keepdims=True)
