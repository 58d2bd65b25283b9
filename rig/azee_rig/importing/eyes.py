"""Finds the eyes of a body: by joints, else as two balls in the head, else at the usual place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.importing.reduced import Reduced

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

RADIUS_M = (0.006, 0.030)
"""Radii of eyes on a body as tall as `BODY_M`; drawn figures have large ones."""
BODY_M = 1.7
ROUND = 0.15
"""How much the distances of an eyeball's skin from its middle may vary."""
PAIRED = 0.25
"""How far the middle of one eyeball may be from the other's mirror image, in radii."""
WELD_M = 1e-5
USUAL = (0.031, 0.075, 0.075)
"""Left, up and forward from the head's joint to an eye, as the signer has it, in metres for a head
of `HEAD_M` from that joint to its top."""
HEAD_M = 0.205


@dataclass(frozen=True, eq=False, slots=True)
class Ball:
    """An eyeball: its middle (3,), radius, and vertices (N,)."""

    middle: Floats
    radius: float
    taken: NDArray[np.bool_]


def find_balls(
    vertices: Floats, triangles: Ints, head: NDArray[np.bool_], height: float
) -> dict[str, Ball]:
    """Return the two eyeballs of a head by side; nothing if there is no such pair.

    Args: head: vertices that the head carries, (N,). height: of the body, metres.
    """
    inside = head[triangles].all(axis=1)
    scale = height / BODY_M
    balls = [
        ball
        for piece in _pieces(vertices, triangles[inside])
        if (ball := _ball(vertices, piece, scale)) is not None
    ]
    best: tuple[float, Ball, Ball] | None = None
    for left in balls:
        for right in balls:
            if left.middle[0] <= 0.2 * left.radius or right.middle[0] >= 0.0:
                continue
            off = np.linalg.norm(left.middle * (-1, 1, 1) - right.middle) / left.radius
            # Of nested balls, such as a cornea, the largest contains the eye.
            if off < PAIRED and (best is None or left.radius > best[0]):
                best = left.radius, left, right
    if best is None:
        return {}
    return {side: _with_inner(ball, balls) for side, ball in zip("LR", best[1:], strict=True)}


def usual_place(reduced: Reduced, head: str, vertices: Floats, side: str) -> Floats:
    """Return the place of an eye in most heads."""
    origin = reduced.place(head)
    skull = vertices[reduced.held([head])]
    size = (float(skull[:, 1].max()) - origin[1]) / HEAD_M if len(skull) else 1.0
    x, y, z = (size * v for v in USUAL)
    return np.asarray(origin + np.array([x if side == "L" else -x, y, z]))


def _with_inner(outer: Ball, balls: list[Ball]) -> Ball:
    taken = outer.taken.copy()
    for ball in balls:
        if np.linalg.norm(ball.middle - outer.middle) < 0.6 * outer.radius:
            taken |= ball.taken
    return Ball(outer.middle, outer.radius, taken)


def _pieces(vertices: Floats, triangles: Ints) -> Iterator[Ints]:
    """Yield the vertices of each connected piece; vertices at the same place count as one."""
    if not len(triangles):
        return
    _, welded = np.unique(np.round(vertices / WELD_M), axis=0, return_inverse=True)
    welded = welded.ravel()
    corners = welded[triangles]
    label = np.arange(welded.max() + 1)
    while True:
        lowest = label[corners].min(axis=1)
        new = label.copy()
        for k in range(3):
            np.minimum.at(new, corners[:, k], lowest)
        new = new[new]
        if (new == label).all():
            break
        label = new
    used = np.unique(triangles)
    of = label[welded[used]]
    order = np.argsort(of, kind="stable")
    yield from np.split(used[order], np.flatnonzero(np.diff(of[order])) + 1)


def _ball(vertices: Floats, piece: Ints, scale: float) -> Ball | None:
    points = vertices[piece]
    if len(points) < 12:
        return None
    # Sphere of least squares: |p|² = 2 c·p + (r² − |c|²).
    system = np.hstack([2.0 * points, np.ones((len(points), 1))])
    found, *_ = np.linalg.lstsq(system, (points**2).sum(axis=1), rcond=None)
    middle = found[:3]
    distance = np.linalg.norm(points - middle, axis=1)
    radius = float(distance.mean())
    extent = np.ptp(points, axis=0)
    if not RADIUS_M[0] * scale <= radius <= RADIUS_M[1] * scale:
        return None
    # The piece must be about half a ball or more.
    if distance.std() > ROUND * radius or np.sort(extent)[1] < 1.2 * radius:
        return None
    taken = np.zeros(len(vertices), dtype=bool)
    taken[piece] = True
    return Ball(middle, radius, taken)
