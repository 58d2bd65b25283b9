"""The two compiled loops over all of a body's skin: blending and normals.

There is no thread and no fast-math: the same input gives the same bits. Only `machine_code` imports
this.
"""

from __future__ import annotations

import math

from numba import cfunc

from azee_rig.machine_code import KEEPS
from azee_rig.pointers import WORDS, carray, integers, reals


@cfunc(WORDS, cache=not KEEPS, error_model="numpy")
def blended(words):
    """Vertices (N, 3) moved by v' = Σ_k w_k T_k (v, 1), skipping influences without weight.

    Words: N, K, J, vertices (N, 3), joints (N, K), weights (N, K), transforms (J, 3, 4), and the
    result (N, 3).
    """
    w = carray(words, (8,))
    count, influences = w[0], w[1]
    vertices, out = reals(w[3], (count, 3)), reals(w[7], (count, 3))
    joints, weights = integers(w[4], (count, influences)), reals(w[5], (count, influences))
    transforms = reals(w[6], (w[2], 3, 4))
    for v in range(count):
        x, y, z = vertices[v, 0], vertices[v, 1], vertices[v, 2]
        for r in range(3):
            out[v, r] = 0.0
        for k in range(influences):
            weight = weights[v, k]
            if weight != 0.0:
                j = joints[v, k]
                for r in range(3):
                    out[v, r] += weight * (
                        transforms[j, r, 0] * x
                        + transforms[j, r, 1] * y
                        + transforms[j, r, 2] * z
                        + transforms[j, r, 3]
                    )


@cfunc(WORDS, cache=not KEEPS, error_model="numpy")
def smooth_normals(words):
    """Compute unit normals (N, 3), each the mean of its triangles' by area; 0 if there is none.

    Words: N, F, vertices (N, 3), triangles (F, 3), and the result (N, 3).
    """
    w = carray(words, (5,))
    count = w[0]
    vertices, triangles = reals(w[2], (count, 3)), integers(w[3], (w[1], 3))
    out = reals(w[4], (count, 3))
    for v in range(count):
        for r in range(3):
            out[v, r] = 0.0
    for t in range(w[1]):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        x, y, z = vertices[a, 0], vertices[a, 1], vertices[a, 2]
        ux, uy, uz = vertices[b, 0] - x, vertices[b, 1] - y, vertices[b, 2] - z
        wx, wy, wz = vertices[c, 0] - x, vertices[c, 1] - y, vertices[c, 2] - z
        nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
        for k in range(3):
            v = triangles[t, k]
            out[v, 0] += nx
            out[v, 1] += ny
            out[v, 2] += nz
    for v in range(count):
        length = math.sqrt(out[v, 0] ** 2 + out[v, 1] ** 2 + out[v, 2] ** 2)
        if length > 0.0:
            for r in range(3):
                out[v, r] /= length


@cfunc(WORDS, cache=not KEEPS, error_model="numpy")
def unit_turns(words):
    """Compute how one face unit turns normals; only triangles that it moves are visited.

    Words: N, F, n, stamp, which no call before had; rows (n,) that move, by deltas (n, 3); vertices
    (N, 3), triangles (F, 3), those around vertices, one vertex' after the other's (3F,), and where
    they start (N + 1,), sums of triangles' normals by area (N, 3); room for shifts (N, 3), which
    are zero, for changes (N, 3), and for stamps of triangles (F,) and vertices (N,); results: how
    many normals turn (1,), whose (N,), and their new directions (N, 3).
    """
    w = carray(words, (18,))
    count, faces, moved, stamp = w[0], w[1], w[2], w[3]
    rows, deltas = integers(w[4], (moved,)), reals(w[5], (moved, 3))
    vertices, triangles = reals(w[6], (count, 3)), integers(w[7], (faces, 3))
    around, starts = integers(w[8], (3 * faces,)), integers(w[9], (count + 1,))
    sums, shift, change = (
        reals(w[10], (count, 3)),
        reals(w[11], (count, 3)),
        reals(w[12], (count, 3)),
    )
    seen, met = integers(w[13], (faces,)), integers(w[14], (count,))
    number, whose, turned = (
        integers(w[15], (1,)),
        integers(w[16], (count,)),
        reals(w[17], (count, 3)),
    )
    for n in range(moved):
        for r in range(3):
            shift[rows[n], r] = deltas[n, r]
    found = 0
    for n in range(moved):
        for place in range(starts[rows[n]], starts[rows[n] + 1]):
            t = around[place]
            if seen[t] == stamp:
                continue
            seen[t] = stamp
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            for k in range(3):
                v = triangles[t, k]
                if met[v] != stamp:
                    met[v] = stamp
                    whose[found] = v
                    found += 1
                    for r in range(3):
                        change[v, r] = 0.0
            for r in range(3):
                i, j = (r + 1) % 3, (r + 2) % 3
                ui, uj = vertices[b, i] - vertices[a, i], vertices[b, j] - vertices[a, j]
                wi, wj = vertices[c, i] - vertices[a, i], vertices[c, j] - vertices[a, j]
                before = ui * wj - uj * wi
                ui += shift[b, i] - shift[a, i]
                uj += shift[b, j] - shift[a, j]
                wi += shift[c, i] - shift[a, i]
                wj += shift[c, j] - shift[a, j]
                gain = ui * wj - uj * wi - before
                for k in range(3):
                    change[triangles[t, k], r] += gain
    for n in range(found):
        v = whose[n]
        length = 0.0
        for r in range(3):
            turned[n, r] = sums[v, r] + change[v, r]
            length += turned[n, r] ** 2
        length = math.sqrt(length)
        if length > 0.0:
            for r in range(3):
                turned[n, r] /= length
    for n in range(moved):
        for r in range(3):
            shift[rows[n], r] = 0.0
    number[0] = found
