"""The two loops over all of a body's skin, compiled: blending and normals.

numba compiles them once and caches them on disk. No thread, no fast-math: the same input gives
the same bits. Import this module where it is needed, not at the top: numba takes its time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit, types

_floats = types.Array(types.float64, 2, "C", readonly=True)
_indices = types.Array(types.int64, 2, "C", readonly=True)
_transforms = types.Array(types.float64, 3, "C", readonly=True)


@njit(types.float64[:, ::1](_floats, _indices, _floats, _transforms), cache=True)
def blended(vertices: Any, joints: Any, weights: Any, transforms: Any) -> Any:
    """Vertices (N, 3) moved by v' = Σ_k w_k T_k (v, 1), skipping influences without weight.

    Args: joints, weights: (N, K) influences. transforms: (J, 3, 4).
    """
    out = np.zeros_like(vertices)
    for v in range(vertices.shape[0]):
        x, y, z = vertices[v, 0], vertices[v, 1], vertices[v, 2]
        for k in range(joints.shape[1]):
            w = weights[v, k]
            if w != 0.0:
                T = transforms[joints[v, k]]
                for r in range(3):
                    out[v, r] += w * (T[r, 0] * x + T[r, 1] * y + T[r, 2] * z + T[r, 3])
    return out


@njit(types.float64[:, ::1](_floats, _indices), cache=True)
def smooth_normals(vertices: Any, triangles: Any) -> Any:
    """Return unit normals (N, 3), each the mean of its triangles' by area; 0 where there is none.

    Args: triangles: (F, 3).
    """
    out = np.zeros_like(vertices)
    for t in range(triangles.shape[0]):
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
    for v in range(out.shape[0]):
        length = np.sqrt(out[v, 0] ** 2 + out[v, 1] ** 2 + out[v, 2] ** 2)
        if length > 0.0:
            for r in range(3):
                out[v, r] /= length
    return out
