"""Assembles the signer: skin, clothes, hair, brows, eyes, mouth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES, Anatomy
from azee_rig.build.brows import brows
from azee_rig.build.clothes import bare, clothes
from azee_rig.build.face import eyeballs, tinted
from azee_rig.build.hair import hair
from azee_rig.build.lashes import lashes
from azee_rig.build.makehuman import Body
from azee_rig.build.piece import Piece

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SKIN = (0.40, 0.215, 0.140)
TEETH = (0.72, 0.69, 0.62)
TONGUE = (0.36, 0.10, 0.10)
TEETH_BACK_M = 0.0025
TEETH_WIDTH = 0.86
"""How far the teeth move back, and how narrow they become, so that closed lips hide them."""


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
    teeth = cut("helper-upper-teeth", "helper-lower-teeth")
    eyes = {s: cut(f"helper-{s.lower()}-eye") for s in SIDES}
    return [
        replace(bare(skin, anatomy), name="skin", colour=SKIN, roughness=0.62),
        *clothes(cut("helper-tights"), skin, anatomy),
        hair(skin, ears[skin_rows], anatomy),
        *brows(skin, anatomy),
        eyeballs(anatomy, eyes),
        lashes(body, whole, np.array([anatomy.origin(f"eye_{side}") for side in SIDES])),
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
