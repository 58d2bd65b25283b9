"""Brows: a thin patch on the brow ridge, and hairs on it that make its outline.

Brows carry grammar, so they must be seen from afar: the patch keeps them dark where hairs are finer
than a pixel. Every vertex takes weights and shapes from the skin under it and follows its moves.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import trimesh
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES, Anatomy
from azee_rig.build.piece import Piece
from azee_rig.nearest import barycentric

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BROW = np.array(
    [
        (0.22, 0.350, 0.030),
        (0.27, 0.362, 0.052),
        (0.38, 0.388, 0.062),
        (0.52, 0.415, 0.058),
        (0.66, 0.422, 0.050),
        (0.80, 0.395, 0.036),
        (0.93, 0.325, 0.014),
    ]
)
"""A brow from the nose outwards: place to the side and above the eyes, and half its width, in
distances between the eyes."""
COLOUR = (0.026, 0.016, 0.011)
PATCH_STEPS, PATCH_ROWS, PATCH_WIDTH = 22, 3, 0.76
"""The patch is narrower than the brow by this factor; hairs reach beyond it."""
PATCH_ROUND = 0.14
"""Share of the brow over which the patch narrows towards the nose, where only hairs are seen."""
PATCH_LIFT_M = 0.0004, 0.0009
"""Height over the skin at the rim and in the middle."""
HAIRS = 84
"""Hairs in a brow."""
HAIR_M = 0.00055
"""Width of a hair at its root: several hairs in one."""
LEAN = np.array([(0.0, 78.0, 62.0), (0.18, 58.0, 34.0), (0.45, 36.0, 4.0), (1.0, 14.0, -12.0)])
"""Place along the brow, and how steeply hairs rise there at the lower and at the upper rim, in
degrees from the way outwards: up at the nose, together in the middle, outwards at the end."""
LENGTH = np.array([(0.0, 0.085), (0.25, 0.125), (0.6, 0.125), (1.0, 0.075)])
"""Place along the brow, and length of the hairs there in distances between the eyes."""
HAIR_LIFT_M = 0.00025, 0.0007
"""Height of roots and tips of hairs over the patch."""
GOLDEN = 0.6180339887498949


@dataclass(frozen=True, eq=False)
class _Ridge:
    """The skin of a face, and the plane in which brows are drawn before they are laid on it."""

    face: Piece
    mesh: trimesh.Trimesh
    middle: Floats
    apart: float

    def laid(self, plane: Floats, lifts: Floats) -> Piece:
        """Return loose vertices over the skin at places (n, 2) of the plane, lifts (n,) metres."""
        ahead = np.column_stack([plane, np.full(len(plane), 1.5)])
        found, hit, shares = _under(self.mesh, self.middle + self.apart * ahead)
        rows = self.mesh.faces[hit]
        normals = np.einsum("mk,mkc->mc", shares, self.mesh.vertex_normals[rows])
        return self.face.blend(rows, shares, found + lifts[:, None] * normals)


def brows(skin: Piece, anatomy: Anatomy) -> tuple[Piece, Piece]:
    """Return the patches of both brows, and their hairs."""
    eyes = [anatomy.origin(f"eye_{s}") for s in SIDES]
    middle, apart = (eyes[0] + eyes[1]) / 2.0, float(np.linalg.norm(eyes[0] - eyes[1]))
    front = skin.vertices[:, 2] > middle[2] - 0.6 * apart
    face = skin.only(front[skin.triangles].all(axis=1))
    mesh = trimesh.Trimesh(face.vertices, face.triangles, process=False)
    ridge = _Ridge(face, mesh, middle, apart)
    return _patches(ridge), _hairs(ridge)


def _patches(ridge: _Ridge) -> Piece:
    steps = np.repeat(np.linspace(0.02, 0.98, PATCH_STEPS), PATCH_ROWS)
    rows = np.tile(np.linspace(-1.0, 1.0, PATCH_ROWS), PATCH_STEPS)
    wide = np.sqrt(np.clip(steps / PATCH_ROUND, 0.04, 1.0))
    rim, high = PATCH_LIFT_M
    corner = np.arange(PATCH_STEPS * PATCH_ROWS).reshape(PATCH_STEPS, PATCH_ROWS)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    triangles = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return _both(
        ridge,
        _drawn(steps, PATCH_WIDTH * wide * rows + 0.04),
        rim + (high - rim) * (1.0 - rows**2),
        triangles,
        np.ones(len(steps)),
    )


def _hairs(ridge: _Ridge) -> Piece:
    """Return hairs as triangles: two corners at the root, one at the tip."""
    count = np.arange(HAIRS)
    along = (count + 0.5) / HAIRS * 0.97
    across = 2.0 * np.modf(count * GOLDEN)[0] - 1.0
    uneven = np.modf(count * GOLDEN**2)[0] - 0.5
    low, high = (np.interp(along, LEAN[:, 0], LEAN[:, k]) for k in (1, 2))
    lean = np.radians(low + (high - low) * (across + 1.0) / 2.0 + 16.0 * uneven)
    outward, upward = _axes(along)
    way = np.cos(lean)[:, None] * outward + np.sin(lean)[:, None] * upward
    aside = np.column_stack([way[:, 1], -way[:, 0]]) * HAIR_M / 2.0 / ridge.apart
    length = np.interp(along, *LENGTH.T) * (1.0 + 0.4 * uneven)
    root = _drawn(along, 0.86 * across - 0.06)
    plane = np.stack([root - aside, root + aside, root + length[:, None] * way], axis=1)
    under = PATCH_LIFT_M[0] + (PATCH_LIFT_M[1] - PATCH_LIFT_M[0]) * (1.0 - across**2)
    lifts = (under[:, None] + np.take(HAIR_LIFT_M, (0, 0, 1))).ravel()
    shade = np.repeat(0.3 + 0.5 * np.modf(count * GOLDEN**3)[0], 3)
    triangles = np.arange(3 * HAIRS).reshape(-1, 3)
    drawn = _both(ridge, plane.reshape(-1, 2), lifts, triangles, shade)
    return replace(drawn, name="brow_hairs")


def _both(ridge: _Ridge, plane: Floats, lifts: Floats, triangles: Ints, shade: Floats) -> Piece:
    """Return what is drawn for the left side, and its mirror image on the right."""
    laid = ridge.laid(np.concatenate([plane, plane * (-1.0, 1.0)]), np.tile(lifts, 2))
    return replace(
        laid,
        name="brows",
        triangles=np.concatenate([triangles, triangles[:, ::-1] + len(plane)]),
        colours=np.repeat(np.tile(shade, 2)[:, None], 3, axis=1),
        colour=COLOUR,
        roughness=1.0,
    )


def _drawn(along: Floats, across: Floats) -> Floats:
    """Return places (n, 2) in the plane: along from the nose 0 … 1, across from low −1 to high."""
    out, up, half = (_curve(along, np.linspace(0.0, 1.0, len(BROW)), BROW[:, k]) for k in range(3))
    _, upward = _axes(along)
    return np.stack([out, up], axis=1) + (across * half)[:, None] * upward


def _axes(along: Floats) -> tuple[Floats, Floats]:
    """Return unit vectors (n, 2) along the brow and up across it."""
    knots, step = np.linspace(0.0, 1.0, len(BROW)), 1e-4
    before, after = np.maximum(along - step, 0.0), np.minimum(along + step, 1.0)
    way = np.stack([_curve(after, knots, x) - _curve(before, knots, x) for x in BROW.T[:2]], axis=1)
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    return way, np.column_stack([-way[:, 1], way[:, 0]])


def _curve(at: Floats, knots: Floats, values: Floats) -> Floats:
    """Return a Catmull–Rom curve through values at even knots."""
    tangent = np.gradient(values, knots)
    i = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, len(knots) - 2)
    width = knots[i + 1] - knots[i]
    t = (at - knots[i]) / width
    return np.asarray(
        (2 * t**3 - 3 * t**2 + 1) * values[i]
        + (t**3 - 2 * t**2 + t) * width * tangent[i]
        + (3 * t**2 - 2 * t**3) * values[i + 1]
        + (t**3 - t**2) * width * tangent[i + 1]
    )


def _under(mesh: trimesh.Trimesh, places: Floats) -> tuple[Floats, Ints, Floats]:
    """Return the first surface behind each place: point, triangle and barycentric shares."""
    found, ray, hit = mesh.ray.intersects_location(
        places, np.tile([0.0, 0.0, -1.0], (len(places), 1)), multiple_hits=False
    )
    order = np.argsort(ray)
    if len(order) != len(places):
        raise ValueError("a brow reaches beyond the face")
    found, hit = found[order], hit[order]
    shares = barycentric(mesh.triangles[hit], found)
    return found, hit, shares
