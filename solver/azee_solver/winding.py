"""How often a surface winds around points, and how far its triangles are: compiled.

The generalised winding number (Jacobson et al. 2013) needs no closed surface: a trunk cut open at
neck and sleeves still tells inside from outside.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

Array = NDArray[np.float64]


def winding_numbers(points: Array, triangles: Array) -> Array:
    """Return the winding number of a surface about points, (n,); triangles: (F, 3, 3)."""
    out = np.zeros(len(points))
    _wind(np.ascontiguousarray(points), np.ascontiguousarray(triangles), out)
    return out


def distances(points: Array, triangles: Array) -> Array:
    """Return the distance of points (n, 3) to the nearest of some triangles (F, 3, 3), (n,)."""
    out = np.empty(len(points))
    _measure(np.ascontiguousarray(points), np.ascontiguousarray(triangles), out)
    return out


_points = types.Array(types.float64, 2, "C")
_triangles = types.Array(types.float64, 3, "C")
_values = types.Array(types.float64, 1, "C")


@njit(types.void(_points, _triangles, _values), cache=True)
def _wind(points, triangles, out):  # type: ignore[no-untyped-def]
    """Sum of solid angles over 4π (Van Oosterom and Strackee 1983)."""
    for n in range(points.shape[0]):
        total = 0.0
        for t in range(triangles.shape[0]):
            ax = triangles[t, 0, 0] - points[n, 0]
            ay = triangles[t, 0, 1] - points[n, 1]
            az = triangles[t, 0, 2] - points[n, 2]
            bx = triangles[t, 1, 0] - points[n, 0]
            by = triangles[t, 1, 1] - points[n, 1]
            bz = triangles[t, 1, 2] - points[n, 2]
            cx = triangles[t, 2, 0] - points[n, 0]
            cy = triangles[t, 2, 1] - points[n, 1]
            cz = triangles[t, 2, 2] - points[n, 2]
            a = math.sqrt(ax * ax + ay * ay + az * az)
            b = math.sqrt(bx * bx + by * by + bz * bz)
            c = math.sqrt(cx * cx + cy * cy + cz * cz)
            volume = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
            spread = (
                a * b * c
                + (ax * bx + ay * by + az * bz) * c
                + (bx * cx + by * cy + bz * cz) * a
                + (cx * ax + cy * ay + cz * az) * b
            )
            total += math.atan2(volume, spread)
        out[n] = total / (2.0 * math.pi)


@njit
def _dot(a, b):  # type: ignore[no-untyped-def]
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(types.void(_points, _triangles, _values), cache=True)
def _measure(points, triangles, out):  # type: ignore[no-untyped-def]
    """Nearest point of each triangle, by its Voronoi regions (Ericson 2005, §5.1.5)."""
    for n in range(points.shape[0]):
        p = points[n]
        best = np.inf
        for t in range(triangles.shape[0]):
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            ab, ac, ap = b - a, c - a, p - a
            d1, d2 = _dot(ab, ap), _dot(ac, ap)
            bp, cp = p - b, p - c
            d3, d4 = _dot(ab, bp), _dot(ac, bp)
            d5, d6 = _dot(ab, cp), _dot(ac, cp)
            va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
            if d1 <= 0.0 and d2 <= 0.0:
                near = a
            elif d3 >= 0.0 and d4 <= d3:
                near = b
            elif d6 >= 0.0 and d5 <= d6:
                near = c
            elif vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
                near = a + d1 / (d1 - d3) * ab
            elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
                near = a + d2 / (d2 - d6) * ac
            elif va <= 0.0 and d4 >= d3 and d5 >= d6:
                near = b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)
            else:
                near = a + (vb * ab + vc * ac) / (va + vb + vc)
            gap = p - near
            best = min(best, _dot(gap, gap))
        out[n] = math.sqrt(best)
