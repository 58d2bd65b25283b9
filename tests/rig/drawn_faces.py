"""Bodies of `body_families` with a face as VRoid draws them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from body_families import Body

DRAWN_PARTS = {
    "skin": "N00_000_00_Face_00_SKIN",
    "top": "N00_000_00_Tops_01_CLOTH",
    "bands": "N00_000_00_Accessory_01_CLOTH",
    "trousers": "N00_000_00_Bottoms_01_CLOTH",
    "shoes": "N00_000_00_Shoes_01_CLOTH",
    "hair": "N00_000_Hair_00_HAIR",
    "brows": "N00_000_00_FaceBrow_00_FACE",
    "eyes": "N00_000_00_EyeIris_00_EYE",
    "lashes": "N00_000_00_FaceEyelash_00_FACE",
}
"""How VRoid calls the materials of the parts."""


def drawn(body: Body, *, apart_m: float = 0.095, deep_m: float = 0.0) -> Body:
    """Return a body with a face as VRoid draws them: large eyes far apart, a short chin, no nose.

    It has neither tongue nor teeth, and its eyes are flat. apart_m: between the eyes' joints.
    deep_m: how far behind the eyes their joints lie.
    """
    number = {name: j for j, name in enumerate(body.names)}
    eyes = [number[body.bones[f"eye_{s}"][0]] for s in "LR"]
    head = number[body.bones["head"][0]]
    at = body.places[eyes].mean(axis=0)
    own = body.weights[:, [head, *eyes]].sum(axis=1)[:, None]
    face = body.vertices - at
    flat = np.minimum(face[:, 2], 0.035 - 0.15 * np.abs(face[:, 0]))
    below = np.where(face[:, 1] < 0.0, 0.55, 1.15)
    new = np.column_stack([1.1 * face[:, 0], below * face[:, 1], flat])
    vertices = body.vertices + own * (new - face)
    places = np.array(body.places)
    for joint, sign in zip(eyes, (1.0, -1.0), strict=True):
        places[joint] = at + np.array([sign * apart_m / 2.0, 0.0, -deep_m])
    parts = [(DRAWN_PARTS[n], a, b) for n, a, b in body.parts if n in DRAWN_PARTS]
    return replace(body, vertices=vertices, places=places, parts=parts)
