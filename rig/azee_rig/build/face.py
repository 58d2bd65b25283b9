"""Parts of a face: eyes with iris and pupil, lips, nails."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES, Anatomy
from azee_rig.build.clothes import smooth_step
from azee_rig.build.piece import Piece

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
