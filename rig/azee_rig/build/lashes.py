"""Lashes: hairs on the body's own strips of lashes, and a dark line along the upper lids.

The strips are grids of quadrilaterals, five rows from the lid's inner edge to the tips. Their
shapes turn with the lids, so hairs that take weights and shapes from a strip do the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.makehuman import Body
from azee_rig.build.piece import Piece

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

COLOUR = (0.012, 0.009, 0.007)
UPPER, LOWER = "eyelashes-2", "eyelashes-1"
"""Ends of the names of the strips' groups."""
LINE = 0.62, 1.5
"""Rows of the strip between which the lid is dark, as if many roots stood there."""
CORNER = 0.9
"""Columns of a strip at either corner of the eye where no hairs grow."""
GOLDEN = 0.6180339887498949


@dataclass(frozen=True)
class Row:
    """Hairs of a lid: how many, rows of the strip where they begin and end, width in metres."""

    count: int
    root: float
    tip: float
    width_m: float


ROWS = {UPPER: Row(26, 0.8, 3.7, 0.00042), LOWER: Row(16, 0.9, 2.6, 0.0003)}


@dataclass(frozen=True, eq=False)
class _Strip:
    """A strip of lashes as a grid of a body's vertices, (R, C): roots first, from the nose."""

    whole: Piece
    grid: Ints

    def at(self, row: Floats, column: Floats) -> Piece:
        """Return loose vertices at places between those of the grid, (n,) each."""
        i = np.clip(row.astype(np.int64), 0, self.grid.shape[0] - 2)
        j = np.clip(column.astype(np.int64), 0, self.grid.shape[1] - 2)
        v, u = row - i, column - j
        rows = np.stack([self.grid[i + a, j + b] for a in (0, 1) for b in (0, 1)], axis=1)
        shares = np.stack([(1 - v) * (1 - u), (1 - v) * u, v * (1 - u), v * u], axis=1)
        places = np.einsum("mk,mkc->mc", shares, self.whole.vertices[rows])
        return self.whole.blend(rows, shares, places)


def lashes(body: Body, whole: Piece, eyes: Floats) -> Piece:
    """Return the lashes of both eyes. whole: all groups of the body; eyes: (2, 3)."""
    made = []
    for group in body.group_names:
        for end, row in ROWS.items():
            if group.endswith(end):
                strip = _Strip(whole, _grid(body.faces_of(group), body.vertices, eyes))
                made += [_hairs(strip, row)] + ([_line(strip)] if end == UPPER else [])
    starts = np.cumsum([0, *(len(piece.vertices) for piece in made)])
    vertices = np.concatenate([piece.vertices for piece in made])
    return Piece(
        name="lashes",
        vertices=vertices,
        triangles=np.concatenate(
            [piece.triangles + start for piece, start in zip(made, starts, strict=False)]
        ),
        weights=np.concatenate([piece.weights for piece in made]),
        deltas=np.concatenate([piece.deltas for piece in made], axis=1),
        colours=np.ones_like(vertices),
        colour=COLOUR,
        roughness=1.0,
    )


def _hairs(strip: _Strip, row: Row) -> Piece:
    """Return hairs as kites: root, both sides, tip."""
    count = np.arange(row.count)
    last = strip.grid.shape[1] - 1
    uneven = np.modf(count * GOLDEN)[0] - 0.5
    root = CORNER + (last - 2.0 * CORNER) * (count + 0.5 + 0.5 * uneven) / row.count
    # Tips meet in twos and threes, as lashes do.
    tip = root + 0.45 * np.sin(2.1 * count) / row.count * last
    full = np.sin(np.pi * np.clip(0.22 + 0.66 * root / last, 0.0, 1.0))
    end = row.root + (row.tip - row.root) * full * (1.0 + 0.35 * uneven)
    middle = row.root + 0.4 * (end - row.root)
    centre = strip.at(middle, root).vertices
    beside = strip.at(middle, np.minimum(root + 0.1, last)).vertices
    a_column = np.linalg.norm(beside - centre, axis=1) / 0.1
    half = row.width_m / 2.0 / a_column
    rows = np.stack([np.full(row.count, row.root), middle, middle, end], axis=1)
    columns = np.stack([root, root - half, root + half, tip], axis=1)
    loose = strip.at(rows.ravel(), np.clip(columns.ravel(), 0.0, last))
    kite = np.array([[0, 2, 1], [1, 2, 3]])
    triangles = (4 * count[:, None, None] + kite).reshape(-1, 3)
    return replace(loose, triangles=triangles)


def _line(strip: _Strip) -> Piece:
    """Return a band along the lid that narrows towards both corners of the eye."""
    columns = np.arange(strip.grid.shape[1], dtype=np.float64)
    full = np.sin(np.pi * np.clip(columns / columns[-1], 0.04, 0.96)) ** 0.5
    inner, outer = LINE
    rows = np.concatenate([np.full(len(columns), inner), inner + (outer - inner) * full])
    loose = strip.at(rows, np.tile(columns, 2))
    a = np.arange(len(columns) - 1)
    b = a + len(columns)
    triangles = np.concatenate([np.stack([a, a + 1, b + 1], 1), np.stack([a, b + 1, b], 1)])
    return replace(loose, triangles=triangles)


def _grid(quads: Ints, vertices: Floats, eyes: Floats) -> Ints:
    """Return a strip's vertices as a grid (R, C), from the nearer eye and from the nose outwards.

    Steps along edges from two corners at one side tell row and column of a vertex.
    """
    names, numbered = np.unique(quads, return_inverse=True)
    faces = numbered.reshape(quads.shape)
    edges = np.concatenate([faces[:, [k, (k + 1) % 4]] for k in range(4)])
    at = vertices[names]
    reach = np.linalg.norm(at[:, None] - eyes, axis=2).min(axis=1)
    corners = np.flatnonzero(np.bincount(faces.ravel()) == 1)
    first = int(corners[reach[corners].argmin()])
    from_first = _steps(edges, first, len(names))
    second = int(corners[np.argsort(from_first[corners])[2]])
    from_second = _steps(edges, second, len(names))
    width = from_first[second]
    column, row = (from_first - from_second + width) // 2, (from_first + from_second - width) // 2
    grid = np.empty((row.max() + 1, width + 1), dtype=np.int64)
    grid[row, column] = names
    outwards = abs(vertices[grid[0, 0], 0]) < abs(vertices[grid[0, -1], 0])
    return grid if outwards else grid[:, ::-1]


def _steps(edges: Ints, start: int, count: int) -> Ints:
    """Return how many edges lead from a vertex to each, (count,)."""
    steps = np.full(count, count)
    steps[start] = 0
    for _ in range(count):
        before = steps.copy()
        for a, b in ((0, 1), (1, 0)):
            np.minimum.at(steps, edges[:, a], before[edges[:, b]] + 1)
        if np.array_equal(steps, before):
            break
    return steps
