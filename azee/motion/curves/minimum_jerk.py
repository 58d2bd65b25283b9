"""The curve of minimum jerk through samples in time, still at both ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

OVERSHOOT = 0.3
"""How far a curve may leave the range of the nearest four samples, as a share of that range."""


class MinimumJerkCurve:
    """The curve of minimum jerk through samples in time, still at the first and the last.

    Among all curves y through the samples whose velocity and acceleration are zero at both ends it
    has the least ∫ |y‴|² dt (Flash and Hogan 1985, there with one via point). Its pieces are of
    the fifth degree and join with four continuous derivatives. Through two samples a and b, a time
    T apart, it is a + (b − a)(10τ³ − 15τ⁴ + 6τ⁵) with τ = t/T.

    A coordinate that would overshoot its samples by more than `OVERSHOOT` gets the velocities of
    Fritsch and Butland (1984) and no acceleration at the inner knots instead; it then has two
    continuous derivatives. This happens where two samples lie close to a stop.
    """

    def __init__(self, knots: ArrayLike, values: ArrayLike) -> None:
        """Args: knots: (n,) increasing seconds, n ≥ 2. values: (n, d)."""
        x = self._x = np.asarray(knots, dtype=np.float64)
        y = self._y = np.asarray(values, dtype=np.float64)
        velocity, acceleration = self._velocity, self._acceleration = np.zeros((2, *y.shape))
        if len(x) > 2:
            velocity[1:-1], acceleration[1:-1] = _minimum_jerk_derivatives(x, y)
            overshooting = _overshoots(x, y, velocity, acceleration)
            velocity[:, overshooting] = _monotone_velocities(x, y[:, overshooting])
            acceleration[:, overshooting] = 0.0

    def __call__(self, at: ArrayLike) -> Array:
        """Return values at times (m,) inside the knots, (m, d)."""
        x, u = self._x, np.asarray(at, dtype=np.float64)
        k = np.clip(np.searchsorted(x, u, side="right") - 1, 0, len(x) - 2)
        return _quintic(x, self._y, self._velocity, self._acceleration, k, u)


def _minimum_jerk_derivatives(x: Array, y: Array) -> tuple[Array, Array]:
    """Velocities and accelerations of the minimum-jerk curve at its inner knots, (n − 2, d) each.

    They solve 2(n − 2) linear equations per coordinate: at each inner knot the third and the
    fourth derivatives of the two quintic pieces that meet there are equal.
    """
    h, n = np.diff(x), len(x) - 2
    rise = np.diff(y, axis=0)
    A, b = np.zeros((2 * n, 2 * n + 4)), np.empty((2 * n, y.shape[1]))
    for i in range(n):
        p, q, here = h[i], h[i + 1], 2 * i  # columns: velocity, acceleration of knot i, i+1, …
        A[here, here : here + 6] = (
            -24 / p**2, -3 / p, 36 / q**2 - 36 / p**2, 9 / p + 9 / q, 24 / q**2, -3 / q,
        )  # fmt: skip
        b[here] = 60 * (rise[i + 1] / q**3 - rise[i] / p**3)
        A[here + 1, here : here + 6] = (
            168 / p**3, 24 / p**2, 192 / p**3 + 192 / q**3, 36 / q**2 - 36 / p**2,
            168 / q**3, -24 / q**2,
        )  # fmt: skip
        b[here + 1] = 360 * (rise[i + 1] / q**4 + rise[i] / p**4)
    scale = np.max(np.abs(A), axis=1, keepdims=True)
    found = np.linalg.solve(A[:, 2:-2] / scale, b / scale)
    return found[0::2], found[1::2]


def _overshoots(x: Array, y: Array, velocity: Array, acceleration: Array) -> NDArray[np.bool_]:
    """Which coordinates leave the range of the samples around them by too much, (d,)."""
    parts = np.linspace(0.1, 0.9, 9)
    k = np.repeat(np.arange(len(x) - 1), len(parts))
    u = x[k] + np.tile(parts, len(x) - 1) * np.diff(x)[k]
    curve = _quintic(x, y, velocity, acceleration, k, u)
    around = np.clip(k[:, None] + np.arange(-1, 3), 0, len(x) - 1)
    low, high = y[around].min(axis=1), y[around].max(axis=1)
    allowed = OVERSHOOT * (high - low)
    return np.asarray(np.any((curve < low - allowed) | (curve > high + allowed), axis=0))


def _monotone_velocities(x: Array, y: Array) -> Array:
    """Velocities (n, d) of a curve that stays between its samples (Fritsch and Butland 1984).

    With the slopes a, b and lengths g, h of the pieces before and after a knot:
    3(g + h) / ((g + 2h)/a + (2g + h)/b) where a and b have one sign, else 0.
    """
    h = np.diff(x)[:, None]
    slopes = np.diff(y, axis=0) / h
    out = np.zeros_like(y)
    a, b = slopes[:-1], slopes[1:]
    p, q = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
    along = a * b > 0
    out[1:-1][along] = ((p + q) / (p / np.where(along, a, 1.0) + q / np.where(along, b, 1.0)))[
        along
    ]
    return out


def _quintic(
    x: Array, y: Array, velocity: Array, acceleration: Array, k: NDArray[np.int64], u: Array
) -> Array:
    """Values at times `u` in pieces `k` with given values and derivatives at the knots, (m, d)."""
    h = np.diff(x)[k][:, None]
    t = (u - x[k])[:, None] / h
    s = t**3 * (10.0 + t * (-15.0 + 6.0 * t))
    v0, v1, a0, a1 = (
        velocity[k] * h,
        velocity[k + 1] * h,
        acceleration[k] * h**2,
        acceleration[k + 1] * h**2,
    )
    return np.asarray(
        y[k]
        + s * (y[k + 1] - y[k])
        + t * (1 + t**2 * (-6 + t * (8 - 3 * t))) * v0
        + t**3 * (-4 + t * (7 - 3 * t)) * v1
        + t**2 * (0.5 + t * (-1.5 + t * (1.5 - 0.5 * t))) * a0
        + t**3 * (0.5 + t * (-1 + 0.5 * t)) * a1
    )
