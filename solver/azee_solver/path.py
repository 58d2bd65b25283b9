"""Points along the paths that AZee names, numerically: straight, arc, circle and through.

All paths lead from a start to an end while t goes from 0 to 1. Shapes: start and end (…, 3),
t (…,) broadcast against them, results (…, 3). A path that its operands do not define is NaN.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

TINY = 1e-9
"""Lengths below this, in metres or as a vector, have no direction."""


def straight(start: Array, end: Array, t: ArrayLike) -> Array:
    """Return points of the segment."""
    u = np.asarray(t, dtype=np.float64)[..., None]
    return np.asarray(start + u * (end - start))


def length(v: Array) -> Array:
    """Return lengths of vectors (…, 3), (…,)."""
    if v.ndim == 1:
        return np.asarray(math.hypot(*v.tolist()))
    return np.asarray(np.sqrt(np.add.reduce(v * v, axis=-1)))


def unit(v: Array) -> Array:
    """Return v at length one, NaN where it has no direction."""
    if v.ndim == 1:
        alone = math.hypot(*v.tolist())
        return np.asarray(v / alone) if alone > TINY else np.full(3, np.nan)
    size = length(v)[..., None]
    if (size > TINY).all():
        return np.asarray(v / size)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(size > TINY, v / size, np.nan)


def turned(v: Array, axis: Array, angle: ArrayLike) -> Array:
    """Turn v right-handed about a unit axis (Rodrigues)."""
    a = np.asarray(angle, dtype=np.float64)[..., None]
    along = np.sum(axis * v, axis=-1, keepdims=True) * axis
    return np.asarray(along + np.cos(a) * (v - along) + np.sin(a) * np.cross(axis, v))


def arc(start: Array, end: Array, bulge: Array, t: ArrayLike) -> Array:
    """Return points of the circular arc from start to end through (start + end) / 2 + bulge.

    Equal times are equal angles. Without a bulge to its side it is the straight path; between
    two equal points it is not defined.
    """
    apex = 0.5 * (start + end) + bulge
    a, b = start - apex, end - apex
    normal = np.cross(a, b)
    area = np.sum(normal * normal, axis=-1, keepdims=True)
    chord = np.linalg.norm(end - start, axis=-1, keepdims=True)
    flat = np.sqrt(area) <= TINY * np.maximum(chord, TINY)
    with np.errstate(invalid="ignore", divide="ignore"):
        # Circumcentre of the triangle (start, end, apex), seen from the apex.
        centre = apex + np.cross(
            np.sum(a * a, axis=-1, keepdims=True) * b - np.sum(b * b, axis=-1, keepdims=True) * a,
            normal,
        ) / (2 * area)
        axis = -unit(normal)
        spoke = start - centre
        across = np.cross(axis, spoke)
        sweep = np.mod(
            np.arctan2(
                np.sum(across * (end - centre), axis=-1), np.sum(spoke * (end - centre), axis=-1)
            ),
            2 * np.pi,
        )
        round_ = centre + turned(spoke, axis, sweep * np.asarray(t, dtype=np.float64))
    round_ = np.where(flat, straight(start, end, t), round_)
    no_side = (chord <= TINY) & (np.linalg.norm(bulge, axis=-1, keepdims=True) > TINY)
    return np.asarray(np.where(no_side, np.nan, round_))


def circle(
    start: Array, end: Array, axis: Array, radius: float, turns: float, t: ArrayLike
) -> Array:
    """Return points on circles about an axis while the whole travels from start to end.

    The movement starts at the circle's highest point, or where the axis is upright at the one
    farthest in front; whole turns between equal points give the circle itself. A part of a turn
    is led to the end by an even drift.
    """
    axis = unit(axis)
    upright = np.abs(axis[..., 1:2]) > 1 - 1e-6
    highest = np.where(upright, np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0]))
    spoke = radius * unit(highest - np.sum(axis * highest, axis=-1, keepdims=True) * axis)
    u = np.asarray(t, dtype=np.float64)
    gap = turned(spoke, axis, np.asarray(2 * np.pi * turns)) - spoke
    return straight(start, end - gap, u) + turned(spoke, axis, 2 * np.pi * turns * u) - spoke


_PER_SEGMENT = 64


def through(points: Array, t: ArrayLike) -> Array:
    """Return points of a centripetal Catmull–Rom curve, at even speed.

    points: (…, P, 3), the start first and the end last. Knots are the square roots of the chords
    (Barry and Goldman 1988; Yuksel et al. 2011); beyond the ends the curve is led by mirrored
    points. Equal times are equal lengths of the curve.
    """
    u = np.asarray(t, dtype=np.float64)
    batch = np.broadcast_shapes(points.shape[:-2], u.shape)
    whole = np.broadcast_to(points, (*batch, *points.shape[-2:]))
    times = np.broadcast_to(u, batch)
    out = np.empty((*batch, 3))
    for i in np.ndindex(*batch):
        out[i] = _along(whole[i], float(times[i]))
    return out


def _along(points: Array, t: float) -> Array:
    if not np.all(np.isfinite(points)):
        return np.full(3, np.nan)
    keep = np.r_[True, np.linalg.norm(np.diff(points, axis=0), axis=1) > TINY]
    p = points[keep]
    if len(p) == 1:
        return np.asarray(p[0])
    p = np.vstack([2 * p[0] - p[1], p, 2 * p[-1] - p[-2]])
    samples = [p[1]]
    for k in range(1, len(p) - 2):
        samples.extend(_segment(p[k - 1 : k + 3], np.arange(1, _PER_SEGMENT + 1) / _PER_SEGMENT))
    curve = np.array(samples)
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))]
    at = np.clip(t, 0.0, 1.0) * length[-1]
    k = min(int(np.searchsorted(length, at, side="right")) - 1, len(curve) - 2)
    step = length[k + 1] - length[k]
    u = (k % _PER_SEGMENT + (at - length[k]) / step) / _PER_SEGMENT
    first = k // _PER_SEGMENT
    return np.asarray(_segment(p[first : first + 4], np.array([u]))[0])


def _segment(p: Array, u: Array) -> Array:
    """Return points between p[1] and p[2], u from 0 to 1, (n, 3)."""
    knots = np.r_[0.0, np.cumsum(np.sqrt(np.linalg.norm(np.diff(p, axis=0), axis=1)))]
    s = (knots[1] + u * (knots[2] - knots[1]))[:, None]

    def mix(a: Array, b: Array, i: int, j: int) -> Array:
        return np.asarray(((knots[j] - s) * a + (s - knots[i]) * b) / (knots[j] - knots[i]))

    a1, a2, a3 = mix(p[0], p[1], 0, 1), mix(p[1], p[2], 1, 2), mix(p[2], p[3], 2, 3)
    return mix(mix(a1, a2, 0, 2), mix(a2, a3, 1, 3), 1, 2)
