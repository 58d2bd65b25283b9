"""Points against surfaces: the kernels of `winding`. Only `machine_code` imports this."""

from __future__ import annotations

import math

from numba import cfunc

from azee_rig.machine_code import KEEPS
from azee_rig.pointers import WORDS, carray, reals


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
