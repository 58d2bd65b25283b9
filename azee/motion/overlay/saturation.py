"""What a face can show: weights of face units add up, but lids and jaw do not go past their ends.

How far a unit closes an eye is read off the mesh: the share of the displacement that closes the
eye which the unit's own displacement has along it, on the vertices that move then. Where shares
add up to more than a closed eye, all units that close it are scaled by one factor, so that a blink
under a squint closes the lids and does not fold them through each other. Likewise the jaw.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig

Array = NDArray[np.float64]

ENDS = (("AU43_L", "AU43"), ("AU43_R", "AU43"), ("AU27", "AU26"))
"""Morphs that go all the way, each with another for bodies that lack it: eyes closed, jaw down."""
SMALL_SHARE = 0.3
"""Units that do less of a movement do not count."""


def saturated(weights: Array, rig: Rig) -> Array:
    """Return weights of face units (T, U) that lids and jaw can show."""
    out = weights.copy()
    for shares in _shares(rig):
        done = out * shares
        towards, back = np.maximum(done, 0.0).sum(axis=1), np.minimum(done, 0.0).sum(axis=1)
        beyond = towards + back > 1.0
        factor = (1.0 - back[beyond]) / towards[beyond]
        out[beyond] = np.where(done[beyond] > 0.0, out[beyond] * factor[:, None], out[beyond])
    return out


@lru_cache(maxsize=4)
def _shares(rig: Rig) -> tuple[Array, ...]:
    """Return for each end how much of the way there each unit goes at weight 1, (U,)."""
    out = {}
    for names in ENDS:
        name = next((n for n in names if n in rig.face_morphs), None)
        if name is not None:
            out[name] = _shares_of(rig, name)
    return tuple(out.values())


def _shares_of(rig: Rig, morph: str) -> Array:
    count = len(rig.mesh.vertices)
    whole = np.zeros((count, 3))
    for unit, weight in rig.face_morphs[morph].items():
        rows, deltas = rig.mesh.unit(unit)
        whole[rows] += weight * deltas
    square = float(np.sum(whole**2))
    shares = np.zeros(len(rig.units))
    for u, unit in enumerate(rig.units):
        rows, deltas = rig.mesh.unit(unit)
        shares[u] = float(np.sum(whole[rows] * deltas)) / square if square > 0.0 else 0.0
    shares[np.abs(shares) < SMALL_SHARE] = 0.0
    return shares
