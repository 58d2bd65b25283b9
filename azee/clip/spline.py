"""Curves through samples: a cubic spline with continuous curvature, and minimum jerk in time."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

CHUNK = 4096
"""Times that are evaluated together: what is on the way to values stays small."""


def minimum_jerk(tau: ArrayLike) -> Array:
    """Return 10τ³ − 15τ⁴ + 6τ⁵ of a time that goes from 0 to 1 (Flash and Hogan 1985).

    This is the movement between two standing points with the least third derivative: speed and
    acceleration are zero at both ends. Times outside stay at the nearer end.
    """
    t = np.minimum(np.maximum(np.asarray(tau, dtype=np.float64), 0.0), 1.0)
    return np.minimum(t * t * t * (10.0 + t * (-15.0 + 6.0 * t)), 1.0)


def cubic_spline(knots: ArrayLike, values: ArrayLike, at: ArrayLike) -> Array:
    """Return the C² cubic spline through samples, not-a-knot at its ends.

    Two knots give the straight line, three the parabola; from four on, the first and the last
    two pieces are one polynomial each, so that cubics are reproduced exactly.

    Args: knots: (n,) increasing, n ≥ 2. values: (n, d). at: (m,) inside the knots.
    Returns: (m, d).
    """
    x: Array = np.asarray(knots, dtype=np.float64)
    y: Array = np.asarray(values, dtype=np.float64)
    u: Array = np.asarray(at, dtype=np.float64)
    n = len(x)
    h, slopes = np.diff(x), np.diff(y, axis=0) / np.diff(x)[:, None]
    curvature: Array = np.zeros_like(y)  # second derivatives at the knots
    if n == 3:
        curvature[:] = 2.0 * (slopes[1] - slopes[0]) / (x[2] - x[0])
    elif n > 3:
        curvature[1:-1] = _not_a_knot(h, 6.0 * np.diff(slopes, axis=0))
        curvature[0] = curvature[1] + h[0] / h[1] * (curvature[1] - curvature[2])
        curvature[-1] = curvature[-2] + h[-1] / h[-2] * (curvature[-2] - curvature[-3])
    out = np.empty((len(u), *y.shape[1:]))
    for start in range(0, len(u), CHUNK):
        part = slice(start, start + CHUNK)
        k = np.clip(np.searchsorted(x, u[part], side="right") - 1, 0, n - 2)
        right = (u[part] - x[k])[:, None]
        left, width = (x[k + 1] - u[part])[:, None], h[k][:, None]
        out[part] = (
            (curvature[k] * left**3 + curvature[k + 1] * right**3) / (6.0 * width)
            + (y[k] / width - curvature[k] * width / 6.0) * left
            + (y[k + 1] / width - curvature[k + 1] * width / 6.0) * right
        )
    return out


def _not_a_knot(h: Array, b: Array) -> Array:
    """Return second derivatives at the inner knots, (n − 2, d), by elimination along the diagonal.

    Inside, h₋c₋ + 2(h₋ + h₊)c + h₊c₊ = b. The third derivative does not jump at the second knot:
    (c₁ − c₀)/h₀ = (c₂ − c₁)/h₁, which removes c₀ from the first row; the other end is alike. The
    remaining matrix is dominated by its diagonal and needs no pivoting.

    Args: h: (n − 1,) lengths of the pieces. b: (n − 2, d).
    """
    diagonal, above, below = 2.0 * (h[:-1] + h[1:]), h[1:-1].copy(), h[1:-1].copy()
    diagonal[0] += h[0] + h[0] ** 2 / h[1]
    diagonal[-1] += h[-1] + h[-1] ** 2 / h[-2]
    above[0] -= h[0] ** 2 / h[1]
    below[-1] -= h[-1] ** 2 / h[-2]
    c = np.array(b)
    for i in range(1, len(c)):
        share = below[i - 1] / diagonal[i - 1]
        diagonal[i] -= share * above[i - 1]
        c[i] -= share * c[i - 1]
    c[-1] /= diagonal[-1]
    for i in range(len(c) - 2, -1, -1):
        c[i] = (c[i] - above[i] * c[i + 1]) / diagonal[i]
    return c
