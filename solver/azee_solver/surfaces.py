"""Points against surfaces: the kernels of `winding`. Only `machine_code` imports this."""

from __future__ import annotations

import math

from numba import cfunc

from azee_rig.machine_code import KEEPS
from azee_rig.pointers import WORDS, carray, integers, reals


@cfunc(WORDS, cache=not KEEPS, error_model="numpy")
def wind(words):
    """Sum of solid angles over 4π (Van Oosterom and Strackee 1983).

    Half the solid angle of a triangle is the angle of a complex number, spread + i volume. Their
    product has the sum of the angles, but for whole turns, which are counted: a sum of two angles
    of one sign goes beyond ±π where the imaginary part changes its sign.

    Words: n, F, points (n, 3), triangles (F, 3, 3), and the result (n,).
    """
    w = carray(words, (5,))
    points, triangles = reals(w[2], (w[0], 3)), reals(w[3], (w[1], 3, 3))
    out = reals(w[4], (w[0],))
    for n in range(points.shape[0]):
        re, im, turns = 1.0, 0.0, 0.0
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
            if volume == 0.0 and spread == 0.0:
                continue  # the point is a corner
            before = im
            re, im = re * spread - im * volume, re * volume + im * spread
            if before >= 0.0 and volume >= 0.0 and im < 0.0:
                turns += 1.0
            elif before < 0.0 and volume < 0.0 and im >= 0.0:
                turns -= 1.0
            if t % 8 == 7:
                length = abs(re) + abs(im)
                re, im = re / length, im / length
        out[n] = math.atan2(im, re) / (2.0 * math.pi) + turns


@cfunc(WORDS, cache=not KEEPS, error_model="numpy")
def measure(words):
    """Nearest point of each triangle, by its Voronoi regions (Ericson 2005, §5.1.5).

    Words: n, F, points (n, 3), triangles (F, 3, 3), and the result (n,).
    """
    w = carray(words, (5,))
    points, triangles = reals(w[2], (w[0], 3)), reals(w[3], (w[1], 3, 3))
    out = reals(w[4], (w[0],))
    for n in range(points.shape[0]):
        best = math.inf
        for t in range(triangles.shape[0]):
            d1, d2, d3, d4, d5, d6 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for i in range(3):
                a, b, c = triangles[t, 0, i], triangles[t, 1, i], triangles[t, 2, i]
                p = points[n, i]
                d1 += (b - a) * (p - a)
                d2 += (c - a) * (p - a)
                d3 += (b - a) * (p - b)
                d4 += (c - a) * (p - b)
                d5 += (b - a) * (p - c)
                d6 += (c - a) * (p - c)
            va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
            v, w = 0.0, 0.0  # of the nearest point: a + v (b − a) + w (c − a)
            if d1 <= 0.0 and d2 <= 0.0:
                pass
            elif d3 >= 0.0 and d4 <= d3:
                v = 1.0
            elif d6 >= 0.0 and d5 <= d6:
                w = 1.0
            elif vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
                v = d1 / (d1 - d3)
            elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
                w = d2 / (d2 - d6)
            elif va <= 0.0 and d4 >= d3 and d5 >= d6:
                w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
                v = 1.0 - w
            else:
                v, w = vb / (va + vb + vc), vc / (va + vb + vc)
            square = 0.0
            for i in range(3):
                a, b, c = triangles[t, 0, i], triangles[t, 1, i], triangles[t, 2, i]
                square += (points[n, i] - a - v * (b - a) - w * (c - a)) ** 2
            best = min(best, square)
        out[n] = math.sqrt(best)


@cfunc(WORDS, cache=not KEEPS, error_model="numpy")
def behind(words):
    """Find how far points are behind the nearest vertices of a surface, along these' normals.

    Points outside the surface's box are not looked at, nor are vertices that are farther from a
    point than the last number says.

    Words: N, n, m, vertices (N, 3), normals (N, 3), which vertices are the points (n,) and which
    the surface (m,), how far to look (1,), and the result (1,): the farthest, 0 if none is behind.
    """
    w = carray(words, (9,))
    vertices, normals = reals(w[3], (w[0], 3)), reals(w[4], (w[0], 3))
    points, surface = integers(w[5], (w[1],)), integers(w[6], (w[2],))
    farthest, out = reals(w[7], (1,))[0], reals(w[8], (1,))
    low_x, low_y, low_z = math.inf, math.inf, math.inf
    high_x, high_y, high_z = -math.inf, -math.inf, -math.inf
    for k in range(surface.shape[0]):
        x, y, z = vertices[surface[k], 0], vertices[surface[k], 1], vertices[surface[k], 2]
        low_x, low_y, low_z = min(low_x, x), min(low_y, y), min(low_z, z)
        high_x, high_y, high_z = max(high_x, x), max(high_y, y), max(high_z, z)
    deepest = 0.0
    for n in range(points.shape[0]):
        x, y, z = vertices[points[n], 0], vertices[points[n], 1], vertices[points[n], 2]
        if x < low_x or x > high_x or y < low_y or y > high_y or z < low_z or z > high_z:
            continue
        best, depth = farthest * farthest, 0.0
        for k in range(surface.shape[0]):
            v = surface[k]
            dx, dy, dz = vertices[v, 0] - x, vertices[v, 1] - y, vertices[v, 2] - z
            square = dx * dx + dy * dy + dz * dz
            if square < best:
                best = square
                depth = dx * normals[v, 0] + dy * normals[v, 1] + dz * normals[v, 2]
        deepest = max(deepest, depth)
    out[0] = deepest
