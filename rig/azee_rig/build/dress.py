"""Assembles the signer: skin, clothes, hair, brows, eyes, mouth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES, Anatomy
from azee_rig.build.clothes import bare, clothes
from azee_rig.build.face import BROW_COLOUR, brows, eyeballs, tinted
from azee_rig.build.hair import hair
from azee_rig.build.makehuman import Body
from azee_rig.build.piece import Piece

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SKIN = (0.40, 0.215, 0.140)
LASHES = (0.012, 0.009, 0.007)
TEETH = (0.72, 0.69, 0.62)
TONGUE = (0.36, 0.10, 0.10)
TEETH_BACK_M = 0.0025
TEETH_WIDTH = 0.86
"""How far the teeth move back, and how narrow they become, so that closed lips hide them."""
LASH_LENGTH = 0.45
"""Share of the lashes' length that is kept, since a solid strip looks heavier than hairs."""


def dress(body: Body, whole: Piece, anatomy: Anatomy, regions: Mapping[str, Ints]) -> list[Piece]:
    """Return all pieces of the signer. whole: all groups of the body with weights and shapes."""

    def cut(*groups: str) -> Piece:
        inside = np.zeros(len(body.vertices), dtype=bool)
        inside[body.vertices_of(*groups)] = True
        return whole.only(np.asarray(inside[whole.triangles].all(axis=1)))

    count = len(body.vertices)
    ears = np.zeros(count, dtype=bool)
    ears[regions["ears"]] = True
    skin_rows = body.vertices_of("body")
    coloured = replace(whole, colours=tinted(whole, regions, count).colours)
    inside = np.zeros(count, dtype=bool)
    inside[skin_rows] = True
    skin = coloured.only(np.asarray(inside[whole.triangles].all(axis=1)))
    upper_lashes = [g for g in body.group_names if g.endswith("eyelashes-2")]
    teeth = cut("helper-upper-teeth", "helper-lower-teeth")
    eyes = {s: cut(f"helper-{s.lower()}-eye") for s in SIDES}
    return [
        replace(bare(skin, anatomy), name="skin", colour=SKIN, roughness=0.62),
        *clothes(cut("helper-tights"), anatomy),
        hair(skin, ears[skin_rows], anatomy),
        brows(skin, anatomy, BROW_COLOUR),
        eyeballs(anatomy, eyes),
        _lashes(cut(*upper_lashes), np.array([anatomy.origin(f"eye_{side}") for side in SIDES])),
        replace(
            teeth,
            vertices=teeth.vertices * (TEETH_WIDTH, 1.0, 1.0) - (0.0, 0.0, TEETH_BACK_M),
            name="teeth",
            colour=TEETH,
            roughness=0.35,
        ),
        replace(
            cut("helper-tongue").subdivided().smoothed(2),
            name="tongue",
            colour=TONGUE,
            roughness=0.5,
        ),
    ]


def _lashes(long: Piece, eyes: Floats) -> Piece:
    """Return shorter lashes: each place, with its data, is moved towards the nearest root.

    eyes: (2, 3). Roots are the half of the places that are nearest to an eye.
    """
    reach = np.linalg.norm(long.vertices[:, None] - eyes, axis=2).min(axis=1)
    roots = np.flatnonzero(reach <= np.median(reach))
    apart = np.linalg.norm(long.vertices[:, None] - long.vertices[roots], axis=2)
    root = roots[apart.argmin(axis=1)]
    shares = np.tile([LASH_LENGTH, 1.0 - LASH_LENGTH], (len(root), 1))
    rows = np.stack([np.arange(len(root)), root], axis=1)
    places = np.einsum("mk,mkc->mc", shares, long.vertices[rows])
    short = replace(long.blend(rows, shares, places), triangles=long.triangles)
    return replace(short, name="lashes", colour=LASHES, roughness=0.9)
