"""The two loops over all of a body's skin, compiled: blending and normals.

No thread, no fast-math: the same input gives the same bits. Only `machine_code` imports this.
"""

from __future__ import annotations

import math

from numba import cfunc

from azee_rig.machine_code import KEEPS
from azee_rig.pointers import WORDS, carray, integers, reals


@cfunc(WORDS, cache=not KEEPS, error_model="numpy")
def blended(words):  # type: ignore[no-untyped-def]
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
def smooth_normals(words):  # type: ignore[no-untyped-def]
    """Work out unit normals (N, 3), each the mean of its triangles' by area; 0 where there is none.

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
