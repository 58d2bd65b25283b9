"""How far a hand's skin is from the skin that a notation says it touches.

Sites and the converter have no part in it: the skin of the notated part of the hand is measured
against the skin around the notated part of the body, or against the other hand. It is the skin as
it is drawn: where a shoulder is raised, that of the chest is stretched.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from azee_rig.rig import Rig
from azee_solver.sliding import skin_of
from azee_solver.winding import distances, winding_numbers

Array = NDArray[np.float64]
CONSIDERED_M = 0.03
"""Points of a hand that are farther than this from a box around what it touches are left out."""


@dataclass(frozen=True, slots=True)
class Touch:
    """A touch that is notated.

    own: parts of the hand that touches: bones, or digits, without `_L` or `_R`. on: what is
    touched: parts of the other hand, or with `near` bones of the body by their full names.
    near: sites about which the skin of the body counts. second: those of the other place, where
    the touch is between two; the skin about the middles counts too. radius_m: how far about them.
    """

    own: tuple[str, ...]
    on: tuple[str, ...]
    near: tuple[str, ...]
    radius_m: float
    second: tuple[str, ...] = ()


def gap_m(rig: Rig, q: Array, touch: Touch, side: str) -> float:
    """Return how far the skins are apart, in metres; 0 where one is inside the other.

    Args: q: (V,) a posture. side: of the hand that touches, L or R.
    """
    skin = rig.skin(rig.pose(q))
    names = [name for own in touch.own for name in _on_side(rig, own, side)]
    points = skin[np.unique(np.vstack([_triangles(rig, name) for name in names]))]
    bones = touch.on
    if not touch.near:
        bones = tuple(n for on in touch.on for n in _on_side(rig, on, "R" if side == "L" else "L"))
    surface = skin[np.vstack([_triangles(rig, bone) for bone in bones])]
    if touch.near:
        frames = rig.chain.frames(q)
        first, second = (
            np.array([rig.sites[key].point(frames) for key in keys]).reshape(-1, 3)
            for keys in (touch.near, touch.second)
        )
        middles = ((first[:, None] + second) / 2).reshape(-1, 3)
        sites = np.vstack([first, second, middles])
        away = np.linalg.norm(surface.mean(axis=1)[:, None] - sites, axis=2).min(axis=1)
        surface = surface[away <= touch.radius_m]
    low, high = surface.min(axis=(0, 1)), surface.max(axis=(0, 1))
    near = np.all((points > low - CONSIDERED_M) & (points < high + CONSIDERED_M), axis=1)
    if not near.any():
        return float(distances(points, surface).min())
    if (winding_numbers(points[near], surface) > 0.5).any():
        return 0.0
    return float(distances(points[near], surface).min())


def _on_side(rig: Rig, own: str, side: str) -> Iterable[str]:
    """Yield the bones of a part of one hand: a bone, or the phalanges of a digit."""
    known = (f"{own}_{side}", *(f"{own}_{side}_{k}" for k in (1, 2, 3)))
    return (name for name in known if name in rig.bones)


@lru_cache(maxsize=128)
def _triangles(rig: Rig, bone: str) -> NDArray[np.int64]:
    """Return the triangles of the mesh (F, 3) that are the skin of a bone."""
    part, bind = skin_of(rig, rig.bones[bone]), np.asarray(rig.coordinates.bind)
    frames = rig.chain.frames(bind)
    placed = part.vertices @ frames.rotations[part.node].T + frames.positions[part.node]
    rows: NDArray[np.int64] = cKDTree(rig.skin(rig.pose(bind))).query(placed)[1]
    return rows[part.triangles]
