"""The points of a surface that are nearest to given points, exactly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False, slots=True)
class Nearest:
    """For each of n points, the nearest one of the surface, (n, 3), its triangle and distance."""

    points: Floats
    triangles: Ints
    distances: Floats


def nearest(vertices: Floats, triangles: Ints, points: Floats) -> Nearest:
    """Find the nearest points of triangles (F, 3) on vertices (N, 3) to points (n, 3).

    Each triangle is inside a ball around its middle. Only triangles are tried whose ball begins
    before the ball of another triangle ends.
    """
    corners = vertices[triangles]
    middles = (corners[:, 0] + corners[:, 1] + corners[:, 2]) / 3.0
    radii = np.max([_length(corners[:, k] - middles) for k in range(3)], axis=0)
    found = np.empty((len(points), 3))
    which = np.empty(len(points), dtype=np.int64)
    distances = np.empty(len(points))
    for i, point in enumerate(points):
        away = _length(middles - point)
        tried = np.flatnonzero(away - radii <= (away + radii).min())
        on = closest_on_triangles(corners[tried], point)
        lengths = _length(on - point)
        best = int(lengths.argmin())
        found[i], which[i], distances[i] = on[best], tried[best], lengths[best]
    return Nearest(found, which, distances)


def _length(v: Floats) -> Floats:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", v, v)))


def closest_on_triangles(corners: Floats, point: Floats) -> Floats:
    """Return the point of each triangle (n, 3, 3) that is nearest to a point (3,), (n, 3).

    This is the foot of the perpendicular if it is inside, else the nearest point of the edges.
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    square = np.sum(normal * normal, axis=1)
    flat = square <= 0.0
    height = np.sum((point - a) * normal, axis=1) / np.where(flat, 1.0, square)
    foot = point - height[:, None] * normal
    inside = ~flat
    best, least = np.empty_like(a), np.full(len(a), np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        edge = end - start
        inside &= np.sum(np.cross(edge, foot - start) * normal, axis=1) >= 0.0
        length = np.sum(edge * edge, axis=1)
        along = np.sum((point - start) * edge, axis=1) / np.where(length > 0.0, length, 1.0)
        on = start + np.clip(along, 0.0, 1.0)[:, None] * edge
        off = _length(on - point)
        nearer = off < least
        best[nearer], least = on[nearer], np.minimum(off, least)
    return np.where(inside[:, None], foot, best)


def barycentric(corners: Floats, points: Floats) -> Floats:
    """Shares (n, 3) of the corners (n, 3, 3) of triangles at points (n, 3) in their planes."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    area = (normal * normal).sum(axis=1)
    u = (np.cross(c - b, points - b) * normal).sum(axis=1) / area
    v = (np.cross(a - c, points - c) * normal).sum(axis=1) / area
    return np.stack([u, v, 1.0 - u - v], axis=1)
