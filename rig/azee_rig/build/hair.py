"""Short hair: the scalp, cut along a hairline and raised off the head."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES, Anatomy
from azee_rig.build.clothes import smooth_step
from azee_rig.build.piece import Piece

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

COLOUR = (0.022, 0.014, 0.010)

HAIRLINE = np.array(
    [
        (0.0, 1.22),
        (22.0, 1.26),
        (38.0, 1.14),
        (50.0, 0.78),
        (60.0, 0.36),
        (68.0, 0.02),
        (75.0, -0.24),
        (82.0, -0.34),
        (88.0, -0.05),
        (94.0, 0.12),
        (104.0, 0.16),
        (114.0, 0.02),
        (124.0, -0.55),
        (134.0, -1.10),
        (150.0, -1.42),
        (180.0, -1.50),
    ]
)
"""Degrees around the head from the front, and the hairline's height above the eyes there, in
distances between the eyes: high over the temples, down before the ears, around them, and down to
the nape."""

FULL = np.array([(0.0, 15.0), (50.0, 12.0), (90.0, 8.0), (130.0, 9.0), (180.0, 10.0)])
"""Degrees around the head, and the hair's greatest thickness there in millimetres."""


def hair(skin: Piece, ears: Mask, anatomy: Anatomy) -> Piece:
    """Return hair for a head. skin: the bare body; ears: (n,) its vertices that stay free."""
    eyes = [anatomy.origin(f"eye_{s}") for s in SIDES]
    middle, apart = (eyes[0] + eyes[1]) / 2.0, float(np.linalg.norm(eyes[0] - eyes[1]))
    centre = middle + np.array([0.0, 0.4, -1.35]) * apart
    marked = replace(skin, colours=np.repeat(ears[:, None].astype(np.float64), 3, axis=1))
    near = (skin.vertices[:, 1] > middle[1] - 2.2 * apart) & (
        skin.vertices[:, 2] < middle[2] + 0.35 * apart
    )
    scalp = marked.only(near[skin.triangles].all(axis=1)).subdivided().subdivided()

    def above(at: Floats) -> Floats:
        return _above_hairline(at, centre, middle, apart)

    free = np.where(scalp.colours[:, 0] > 0.0, -0.02, above(scalp.vertices))
    cap = scalp.clipped(np.minimum(free, above(scalp.vertices))).smoothed(4, 0.5)
    inner = np.maximum(_rim_distance(cap, 0.05), 0.0)
    around = _around(cap.vertices, centre)
    full = np.interp(around, *FULL.T) * 1e-3
    top = smooth_step(0.6 * apart, 1.9 * apart, cap.vertices[:, 1] - middle[1])
    full = full * (1.0 - 0.2 * top)
    strands = _strands(cap.vertices, centre)
    height = 0.0006 + full * smooth_step(-0.004, 0.024, inner) * (1.0 + 0.10 * strands)
    lifted = cap.raised(height).smoothed(1, 0.3)
    shade = 1.0 + 0.35 * strands
    return replace(
        lifted,
        name="hair",
        colours=np.clip(np.repeat(shade[:, None], 3, axis=1) * 0.6, 0.0, 1.0),
        colour=(COLOUR[0] / 0.6, COLOUR[1] / 0.6, COLOUR[2] / 0.6),
        roughness=0.75,
    )


def _above_hairline(at: Floats, centre: Floats, middle: Floats, apart: float) -> Floats:
    around = _around(at, centre)
    line = middle[1] + apart * np.interp(around, *HAIRLINE.T)
    side = np.arctan2(at[:, 0] - centre[0], at[:, 2] - centre[2])
    fray = np.sin(47.0 * side + 0.4) + np.sin(83.0 * side) + 0.7 * np.sin(131.0 * side + 1.3)
    return np.asarray(at[:, 1] - line - 0.0004 * fray)


def _around(at: Floats, centre: Floats) -> Floats:
    """Return degrees around the head's vertical axis, 0 in front, the same on both sides."""
    return np.asarray(np.degrees(np.arctan2(np.abs(at[:, 0] - centre[0]), at[:, 2] - centre[2])))


def _rim_distance(piece: Piece, reach_m: float) -> Floats:
    """Return the distance of each vertex from the rim along edges, at most `reach_m`."""
    edges = np.concatenate([piece.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    edges = np.sort(edges, axis=1)
    unique, times = np.unique(edges, axis=0, return_counts=True)
    length = np.linalg.norm(piece.vertices[unique[:, 0]] - piece.vertices[unique[:, 1]], axis=1)
    distance = np.full(len(piece.vertices), reach_m)
    distance[unique[times == 1].ravel()] = 0.0
    for _ in range(60):
        for a, b in ((0, 1), (1, 0)):
            np.minimum.at(distance, unique[:, a], distance[unique[:, b]] + length)
    return distance


def _strands(at: Floats, centre: Floats) -> Floats:
    """Return a wave from −1 to 1 across the hair, which falls from a crown at the back."""
    crown = centre + np.array([0.012, 0.09, -0.03])
    turn = np.arctan2(at[:, 0] - crown[0], at[:, 2] - crown[2])
    fall = np.linalg.norm(at - crown, axis=1)
    wave = np.sin(23.0 * turn + 14.0 * fall) + 0.6 * np.sin(41.0 * turn - 23.0 * fall + 1.0)
    return np.asarray(wave / 1.6)
