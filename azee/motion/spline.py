"""Curves through samples: a cubic spline with continuous curvature, and minimum jerk in time."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def minimum_jerk(tau: ArrayLike) -> Array:
    """10τ³ − 15τ⁴ + 6τ⁵ of a time that goes from 0 to 1 (Flash and Hogan 1985).

    The movement between two points at rest whose third derivative is smallest: speed and
    acceleration are zero at both ends. Times outside stay at the nearer end.
    """
    t = np.clip(np.asarray(tau, dtype=np.float64), 0.0, 1.0)
    return np.asarray(np.clip(t**3 * (10.0 + t * (-15.0 + 6.0 * t)), 0.0, 1.0))


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
        A, b = np.zeros((n, n)), np.zeros_like(y)
        A[0, :3] = h[1], -(h[0] + h[1]), h[0]
        A[-1, -3:] = h[-1], -(h[-2] + h[-1]), h[-2]
        i = np.arange(1, n - 1)
        A[i, i - 1], A[i, i], A[i, i + 1] = h[:-1], 2.0 * (h[:-1] + h[1:]), h[1:]
        b[1:-1] = 6.0 * np.diff(slopes, axis=0)
        curvature = np.asarray(np.linalg.solve(A, b))
    k = np.clip(np.searchsorted(x, u, side="right") - 1, 0, n - 2)
    right = (u - x[k])[:, None]
    left, width = (x[k + 1] - u)[:, None], h[k][:, None]
    return np.asarray(
        (curvature[k] * left**3 + curvature[k + 1] * right**3) / (6.0 * width)
        + (y[k] / width - curvature[k] * width / 6.0) * left
        + (y[k + 1] / width - curvature[k + 1] * width / 6.0) * right
    )
