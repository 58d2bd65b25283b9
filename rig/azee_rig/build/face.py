"""Parts of a face: eyes with iris and pupil, brows, lips, nails."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import trimesh
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES, Anatomy
from azee_rig.build.clothes import smooth_step
from azee_rig.build.piece import Piece
from azee_rig.nearest import barycentric

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SCLERA, LIMBUS = (0.80, 0.78, 0.76), (0.022, 0.014, 0.010)
IRIS_OUT, IRIS_IN, PUPIL = (0.055, 0.026, 0.012), (0.20, 0.095, 0.040), (0.003, 0.003, 0.003)

EYE_RINGS: tuple[tuple[float, tuple[float, float, float]], ...] = (
    (0.0, PUPIL),
    (8.5, PUPIL),
    (9.2, IRIS_IN),
    (16.0, IRIS_IN),
    (21.5, IRIS_OUT),
    (23.0, LIMBUS),
    (24.5, LIMBUS),
    (26.0, SCLERA),
    (34.0, SCLERA),
    (46.0, SCLERA),
    (60.0, (0.72, 0.62, 0.60)),
    (78.0, (0.60, 0.42, 0.40)),
    (100.0, (0.50, 0.30, 0.28)),
)
"""Rings of an eyeball: degrees from the middle of the pupil, and their linear colour."""
EYE_SEGMENTS = 32

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
BROW_COLOUR = (0.020, 0.013, 0.009)
BROW_STEPS, BROW_ROWS = 24, 5


def eyeballs(anatomy: Anatomy, old: Mapping[str, Piece]) -> Piece:
    """Return eyes as spheres whose rings end at the borders of pupil and iris.

    old: the body's own eyeballs; the lids fit their radius.
    """
    made = [_eyeball(anatomy, side, old[side]) for side in SIDES]
    first, second = made
    return replace(
        first,
        vertices=np.concatenate([first.vertices, second.vertices]),
        triangles=np.concatenate([first.triangles, second.triangles + len(first.vertices)]),
        weights=np.concatenate([first.weights, second.weights]),
        deltas=np.concatenate([first.deltas, second.deltas], axis=1),
        colours=np.concatenate([first.colours, second.colours]),
        name="eyes",
        roughness=0.12,
    )


def _eyeball(anatomy: Anatomy, side: str, old: Piece) -> Piece:
    centre = anatomy.origin(f"eye_{side}")
    radius = float(np.linalg.norm(old.vertices - centre, axis=1).max())
    ahead = np.array([0.0, 0.0, 1.0])
    vertices, colours = [], []
    for degrees, colour in EYE_RINGS:
        polar = np.radians(degrees)
        bulge = 0.045 * smooth_step(27.0, 8.0, np.array([degrees]))[0]
        for k in range(EYE_SEGMENTS):
            turn = 2.0 * np.pi * k / EYE_SEGMENTS
            out = np.array([np.cos(turn) * np.sin(polar), np.sin(turn) * np.sin(polar), 0.0])
            vertices.append(centre + radius * (1.0 + bulge) * (out + ahead * np.cos(polar)))
            colours.append(colour)
    n = EYE_SEGMENTS
    triangles = []
    for ring in range(len(EYE_RINGS) - 1):
        for k in range(n):
            a, b = ring * n + k, ring * n + (k + 1) % n
            if ring > 0:
                triangles.append((a, a + n, b))
            triangles.append((b, a + n, b + n))
    rows = np.zeros((len(vertices), 1), dtype=np.int64)
    still = replace(old, deltas=np.zeros_like(old.deltas))
    made = still.blend(rows, np.ones((len(vertices), 1)), np.array(vertices))
    return replace(made, triangles=np.array(triangles), colours=np.array(colours))


def brows(skin: Piece, anatomy: Anatomy, colour: tuple[float, float, float]) -> Piece:
    """Return two strips that lie on the brow ridge and move with the skin under them."""
    eyes = [anatomy.origin(f"eye_{s}") for s in SIDES]
    middle, apart = (eyes[0] + eyes[1]) / 2.0, float(np.linalg.norm(eyes[0] - eyes[1]))
    front = skin.vertices[:, 2] > middle[2] - 0.6 * apart
    face = skin.only(front[skin.triangles].all(axis=1))
    mesh = trimesh.Trimesh(face.vertices, face.triangles, process=False)
    steps = np.linspace(0.0, 1.0, BROW_STEPS)
    knots = np.linspace(0.0, 1.0, len(BROW))
    across, up, half = (_curve(steps, knots, BROW[:, k]) for k in range(3))
    slope = np.gradient(up, across)
    tilt = np.stack([-slope, np.ones_like(slope)], axis=1)
    tilt /= np.linalg.norm(tilt, axis=1, keepdims=True)
    rows = np.linspace(-1.0, 1.0, BROW_ROWS)
    plane = (
        np.stack([across, up], axis=1)[:, None]
        + (rows[:, None] * half[:, None, None]) * tilt[:, None]
    )
    places: list[Floats] = []
    lifts: list[float] = []
    triangles: list[tuple[int, int, int]] = []
    for sign in (1.0, -1.0):
        start = len(places)
        for i in range(BROW_STEPS):
            for j in range(BROW_ROWS):
                x, y = plane[i, j]
                places.append(middle + apart * np.array([sign * x, y, 1.5]))
                taper = min(1.0, 4.0 * steps[i] + 0.25, 3.0 * (1.0 - steps[i]) + 0.1)
                lifts.append(0.0007 + 0.0022 * (1.0 - rows[j] ** 2) * taper)
        for i in range(BROW_STEPS - 1):
            for j in range(BROW_ROWS - 1):
                a = start + i * BROW_ROWS + j
                quad = (a, a + BROW_ROWS, a + BROW_ROWS + 1, a + 1)
                order = quad if sign > 0 else quad[::-1]
                triangles += [(order[0], order[1], order[2]), (order[0], order[2], order[3])]
    found, hit, shares = _under(mesh, np.array(places))
    normals = np.einsum("mk,mkc->mc", shares, mesh.vertex_normals[mesh.faces[hit]])
    lifted = found + np.array(lifts)[:, None] * normals
    strip = face.blend(mesh.faces[hit], shares, lifted)
    return replace(
        strip,
        name="brows",
        triangles=np.array(triangles),
        colours=np.ones((len(lifted), 3)),
        colour=colour,
        roughness=0.8,
    )


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


def tinted(skin: Piece, regions: Mapping[str, Ints], count: int) -> Piece:
    """Return the skin with lips, nails and inner mouth in their own colours.

    count: vertices of the whole body, in which `regions` are numbered; `skin` is uncut.
    """
    tint = np.ones((count, 3))
    tint[regions["lip_edge"]] = (0.93, 0.80, 0.80)
    tint[regions["lips"]] = (0.84, 0.60, 0.60)
    tint[regions["nails"]] = (1.0, 0.92, 0.92)
    tint[regions["mouth"]] = (0.42, 0.20, 0.20)
    return replace(skin, colours=skin.colours * tint)
