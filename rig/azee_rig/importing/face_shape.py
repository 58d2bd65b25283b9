"""Measures a face that others made: drawn faces have other proportions than the signer's.

AZee's sites of the head are counted in distances between the eyes. Where eyes are large and far
apart, or their joints lie deep in the head, these would lie beside the face or inside of it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES, Anatomy
from azee_rig.build.sites import FaceShape
from azee_rig.importing.skin_of import ForeignSurface

Floats = NDArray[np.float64]

SIGNER = {"out": 1.45, "up": 2.04, "down": 1.82, "ahead": 0.72, "back": 3.06}
"""What the signer measures, in distances between the eyes."""
EYE_FRONT, DEEP = 0.28, 0.5
"""Likewise from the middle of an eye to its front; joints that lie deeper than that by so much are
no middles of eyes."""
USUAL = 1.25
"""A face whose proportions differ from the signer's by less is measured by its eyes alone."""
HELD = 0.5
"""Share of its skin weight that a vertex of the head has from the head."""
LEVEL, MIDDLE, FRONT = 0.5, 0.3, 0.35
"""Of the head's half width: what counts as at the height of the eyes, and as the middle of the
face. Of the way from the eyes to the tip of the nose: what counts as the front."""


def face_shape(surface: ForeignSurface, anatomy: Anatomy, head: str) -> FaceShape:
    """Measure a face against the signer's. head: the joint that carries it."""
    eyes = [anatomy.origin(f"eye_{s}") for s in SIDES]
    middle, apart = (eyes[0] + eyes[1]) / 2.0, float(np.linalg.norm(eyes[0] - eyes[1]))
    own = surface.share([head]) >= HELD
    skin = np.unique(surface.mesh.triangles[surface.roles == "skin"])
    whole = surface.mesh.vertices[own] - middle
    skin = skin[own[skin]]
    face = surface.mesh.vertices[skin] - middle
    if not len(face) or not apart > 0.0:
        return FaceShape()
    height, width = float(whole[:, 1].max()), float(np.abs(face[:, 0]).max())
    level = np.abs(face[:, 1]) < LEVEL * width
    centre = np.abs(face[:, 0]) < MIDDLE * width
    if not level.any() or not centre.any() or height <= 0.0:
        return FaceShape()
    nose = float(face[centre, 2].max())
    deep = _depth(face, width)
    front = centre & (face[:, 2] > deep + FRONT * (nose - deep))
    found = {
        "out": float(np.abs(face[level, 0]).max()),
        "up": height,
        "down": -float(face[front, 1].min()) if front.any() else 0.0,
        "ahead": nose - deep,
        "back": deep - float(whole[:, 2].min()),
    }
    shares = {name: size / (SIGNER[name] * apart) for name, size in found.items()}
    if min(shares.values()) <= 0.0:
        return FaceShape()
    if all(1.0 / USUAL < share < USUAL for share in shares.values()):
        return FaceShape()
    return FaceShape(**shares, deep=deep / apart)


def _depth(face: Floats, width: float) -> float:
    """How far the joints of the eyes lie behind where eyes of this face's size would have them."""
    x, y = np.abs(face[:, 0]), np.abs(face[:, 1])
    beside = (y < 0.25 * width) & (x > 0.2 * width) & (x < 0.5 * width)
    if not beside.any():
        return 0.0
    size = width / SIGNER["out"]
    deep = float(face[beside, 2].max()) - EYE_FRONT * size
    return deep if deep > DEEP * size else 0.0
