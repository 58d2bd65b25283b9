"""Points along the paths that AZee names, numerically, but for those on the skin.

All paths lead from a start to an end while t goes from 0 to 1. Shapes: start and end (…, 3),
t (…,) broadcast against them, results (…, 3). A path that its operands do not define is NaN.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from azee_rig.rotation import part_turn, to_matrices, to_quaternions

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


def swung(start: Array, end: Array, t: ArrayLike) -> Array:
    """Return unit vectors on the shorter arc from one direction to another (slerp).

    NaN between opposite directions, which have no shorter arc.
    """
    a, b = unit(start), unit(end)
    u = np.asarray(t, dtype=np.float64)[..., None]
    angle = 2.0 * np.arctan2(length(a - b), length(a + b))[..., None]
    sine = np.sin(angle)
    with np.errstate(invalid="ignore", divide="ignore"):
        between = (np.sin((1.0 - u) * angle) * a + np.sin(u * angle) * b) / sine
    alike = angle < TINY
    opposite = (np.pi - angle < 1e-6) & (u > 0.0) & (u < 1.0)
    between = np.where(alike | (u <= 0.0), a, np.where(u >= 1.0, b, between))
    return np.asarray(np.where(opposite, np.nan, between))


def turned_together(
    start: Array,
    end: Array,
    start_beside: Array,
    end_beside: Array,
    t: float,
    *,
    longer: bool = False,
) -> Array:
    """Return a direction on its way, (…, 3) at length one, as a bone turns that it is an axis of.

    It is the shorter turn, or the longer, about one axis: R(t) = exp(t log(R₁ R₀ᵀ)), between frames
    with first columns `start` and `end`, and second columns as near to the directions beside them
    as is square to these. NaN where a frame has no direction.
    """
    before, after = frame(start, start_beside), frame(end, end_beside)
    between = after @ np.swapaxes(before, -1, -2)
    known = np.asarray(np.isfinite(between).all(axis=(-2, -1)))
    turn = to_quaternions(np.where(known[..., None, None], between, np.eye(3)))
    out = np.einsum(
        "...ij,...j->...i", to_matrices(part_turn(turn, t, longer=longer)), before[..., 0]
    )
    return np.asarray(np.where(known[..., None], out, np.nan))


def frame(first: Array, second: Array) -> Array:
    """Return a right-handed frame, (…, 3, 3): columns along the first direction, in their plane."""
    x = unit(first)
    y = unit(second - np.sum(x * second, axis=-1, keepdims=True) * x)
    return np.stack([x, y, np.cross(x, y)], axis=-1)


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
    start: Array,
    end: Array,
    axis: Array,
    radius: float,
    turns: float,
    t: ArrayLike,
    *,
    phase: float = 0.0,
    ratio: float = 1.0,
    end_radius: float | None = None,
) -> Array:
    """Return points on circles about an axis while the whole travels from start to end.

    The movement starts `phase` radians beyond the circle's highest point, or where the axis is
    upright beyond the one farthest in front; whole turns between equal points give the circle
    itself. A part of a turn is led to the end by an even drift.

    Args: ratio: of height and width. end_radius: a spiral's at its end.
    """
    axis = unit(axis)
    upright = np.abs(axis[..., 1:2]) > 1 - 1e-6
    highest = np.where(upright, np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0]))
    top = unit(highest - np.sum(axis * highest, axis=-1, keepdims=True) * axis)
    beside = np.cross(axis, top)
    last = radius if end_radius is None else end_radius

    def ring(u: Array) -> Array:
        angle = (phase + 2 * np.pi * turns * u)[..., None]
        size = (radius + (last - radius) * u)[..., None]
        return np.asarray(size * (ratio * np.cos(angle) * top + np.sin(angle) * beside))

    return _led(start, end, ring, t)


def _led(start: Array, end: Array, curve: Callable[[Array], Array], t: ArrayLike) -> Array:
    """Return a curve of u from 0 to 1, with an even drift that leads it from start to end."""
    u = np.asarray(t, dtype=np.float64)
    first, last = curve(np.zeros(())), curve(np.ones(()))
    return np.asarray(straight(start - first, end - last, u) + curve(u))


def around(
    start: Array, end: Array, centre: Array, axis: Array, turns: float, t: ArrayLike
) -> Array:
    """Return points that turn about an axis through a centre, from start to end.

    The angle is the one from start to end that is nearest to so many turns; distance from the axis
    and height along it change evenly. Equal times are equal angles.
    """
    axis = unit(axis)
    u = np.asarray(t, dtype=np.float64)
    heights, spokes, sizes = [], [], []
    for point in (start, end):
        from_centre = point - centre
        height = np.sum(axis * from_centre, axis=-1, keepdims=True)
        heights.append(height)
        spokes.append(from_centre - height * axis)
        sizes.append(np.linalg.norm(spokes[-1], axis=-1, keepdims=True))
    between = np.arctan2(
        np.sum(axis * np.cross(spokes[0], spokes[1]), axis=-1), np.sum(spokes[0] * spokes[1], -1)
    )
    angle = between + 2 * np.pi * np.round(turns - between / (2 * np.pi))
    with np.errstate(invalid="ignore", divide="ignore"):
        way = np.where(sizes[0] > TINY, spokes[0] / sizes[0], spokes[1] / sizes[1])
    v = u[..., None]
    size = sizes[0] + (sizes[1] - sizes[0]) * v
    height = heights[0] + (heights[1] - heights[0]) * v
    return np.asarray(centre + height * axis + size * turned(way, axis, angle * u))


def wave(start: Array, end: Array, side: Array, waves: float, t: ArrayLike) -> Array:
    """Return points of the segment, moved to and fro along `side`: so many sines."""
    u = np.asarray(t, dtype=np.float64)
    aside = np.sin(2 * np.pi * waves * u)[..., None] * side
    last = u[..., None] * np.sin(2 * np.pi * waves) * side
    return np.asarray(straight(start, end, u) + aside - last)


def zigzag(start: Array, end: Array, side: Array, corners: int, t: ArrayLike) -> Array:
    """Return points of a line with corners on both sides of the segment in turns.

    They lie evenly along the way, the first on the side of `side`. A point slows down before a
    corner and speeds up behind it, on each leg by minimum jerk.
    """
    u = np.clip(np.asarray(t, dtype=np.float64), 0.0, 1.0)
    at = np.array([0.0, *((k + 0.5) / corners for k in range(corners)), 1.0])
    off = np.array([0.0, *(1.0 if k % 2 == 0 else -1.0 for k in range(corners)), 0.0])
    leg = np.clip(np.searchsorted(at, u, side="right") - 1, 0, corners)
    share = (u - at[leg]) / (at[leg + 1] - at[leg])
    eased = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    along = at[leg] + eased * (at[leg + 1] - at[leg])
    aside = off[leg] + eased * (off[leg + 1] - off[leg])
    return np.asarray(straight(start, end, along) + aside[..., None] * side)


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
