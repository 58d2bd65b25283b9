"""Clothes cut from the body's helper suit: a plain top, trousers, shoes.

The suit lies close to the skin everywhere below the head. Each garment is the part of it where a
function is positive, raised off the body. Skin well below cloth is removed, so that it cannot show
through the cloth, however the arms move.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import SIDES, Anatomy
from azee_rig.build.piece import Piece

Floats = NDArray[np.float64]

TOP = (0.036, 0.075, 0.125)
BANDS = (0.026, 0.055, 0.095)
TROUSERS = (0.030, 0.031, 0.036)
INSIDE = 0.45
"""How dark cloth is at the inner end of a rim, where little light comes."""
SHOES = (0.012, 0.011, 0.011)
BAND_M = 0.014
CUFF_FROM_M, COLLAR_FROM_M = 0.085, 0.04
"""Distance from its rim at which cloth begins to narrow."""
BAND_LIFT_M = 0.0025
"""Height of cuffs and collar over the skin."""
CLOSED_M = 0.0015
"""How deep in skin or trousers the top's rims end, so that nobody looks into a sleeve."""
SLEEVE = 0.93
"""Share of the forearm that the sleeve covers."""


@dataclass(frozen=True, eq=False)
class Pattern:
    """The borders of garments, as signed distances in metres: positive is covered.

    Each function takes places (n, 3) of the body in its own posture.
    """

    anatomy: Anatomy

    def neckline(self, at: Floats) -> Floats:
        """Return the distance below a round neckline: low in front, high behind."""
        neck = self.anatomy.origin("neck")
        notch = self.anatomy.origin("clav_L")[1]
        side, back = neck[1] + 0.006, neck[1] + 0.016
        around = np.arctan2(at[:, 0], at[:, 2] - neck[2] - 0.01)
        front = notch + 0.012
        middle = (front + back) / 4.0 + side / 2.0
        height = (
            middle
            + (front - back) / 2.0 * np.cos(around)
            + (front + back - 2 * side) / 4.0 * np.cos(2 * around)
        )
        return np.asarray(height - at[:, 1])

    def sleeves(self, at: Floats) -> Floats:
        """Return the distance above the nearer sleeve's end, along the forearm."""
        left = at[:, 0] > 0.0
        out = np.empty(len(at))
        for side, rows in zip(SIDES, (left, ~left), strict=True):
            elbow, wrist = (self.anatomy.origin(f"{b}_{side}") for b in ("f_arm", "palm"))
            length = float(np.linalg.norm(wrist - elbow))
            along = (at[rows] - elbow) @ (wrist - elbow) / length
            aside = (at[rows] - elbow) - np.outer(along / length, wrist - elbow)
            near = np.linalg.norm(aside, axis=1) < 0.12
            out[rows] = np.where(near, SLEEVE * length - along, 1.0)
        return out

    def hem(self, at: Floats, below_hips_m: float) -> Floats:
        """Return the distance above a level line at some depth below the hip joints."""
        hips = self.anatomy.origin("back_1")[1]
        return np.asarray(at[:, 1] - hips + below_hips_m)

    def ankle(self, at: Floats) -> Floats:
        """Return the distance above the ankles."""
        return np.asarray(at[:, 1] - 0.105)

    def covered(self, at: Floats) -> Floats:
        """Return the distance from the nearest edge of all clothes; negative if visible."""
        return np.minimum(self.neckline(at), self.sleeves(at))


def clothes(suit: Piece, skin: Piece, anatomy: Anatomy) -> Sequence[Piece]:
    """Return top with collar and cuffs, trousers and shoes from the helper suit.

    skin: all of the body's, on which collar and cuffs lie. The top is closed towards skin and legs.
    """
    pattern = Pattern(anatomy)
    upper = pattern.hem(suit.vertices, 0.20) > 0.0
    loose = suit.smoothed(4, 0.6 * _chest(suit.vertices, anatomy))
    fine = loose.only(np.asarray(upper[loose.triangles].all(axis=1))).subdivided().smoothed(2, 0.35)
    fine = fine.relaxed(8)
    wide = pattern.hem(fine.vertices, 0.07)
    cloth = fine.raised(0.0045 + 0.006 * smooth_step(0.35, 0.0, wide))
    cuffs = smooth_step(CUFF_FROM_M, BAND_M, pattern.sleeves(cloth.vertices))
    collar = smooth_step(COLLAR_FROM_M, BAND_M, pattern.neckline(cloth.vertices))
    cloth = _drawn_in(cloth, skin, np.maximum(cuffs, collar))
    rims = np.minimum(pattern.covered(cloth.vertices), pattern.hem(cloth.vertices, 0.07))
    close = loose.raised(0.003)
    waist = -pattern.hem(close.vertices, -0.05)
    legs = close.clipped(np.minimum(waist, pattern.ankle(close.vertices) + 0.025))
    shirt = _closed(cloth.clipped(rims), skin, legs)
    rib = pattern.covered(shirt.vertices) - BAND_M
    feet = loose.raised(0.009)
    return [
        replace(shirt.clipped(rib), name="top", colour=TOP, roughness=0.9),
        replace(shirt.clipped(-rib), name="bands", colour=BANDS, roughness=0.9),
        replace(legs.folded(0.004), name="trousers", colour=TROUSERS, roughness=0.9),
        replace(
            feet.clipped(-pattern.ankle(feet.vertices)), name="shoes", colour=SHOES, roughness=0.6
        ),
    ]


def _drawn_in(cloth: Piece, skin: Piece, share: Floats) -> Piece:
    """Return cloth that lies close to the skin, and moves with it, by a share (n,) of the way."""
    rows = np.flatnonzero(share > 0.0)
    close, part = skin.under(cloth.vertices[rows], -BAND_LIFT_M), share[rows, None]
    vertices, weights = np.array(cloth.vertices), np.array(cloth.weights)
    vertices[rows] += part * (close.vertices - vertices[rows])
    weights[rows] += part * (close.weights - weights[rows])
    return replace(cloth, vertices=vertices, weights=weights)


def _closed(cloth: Piece, *below: Piece) -> Piece:
    """Return cloth whose rims turn in and end below what is nearest of some pieces."""
    rim = cloth.vertices[cloth.rims[1]]
    found = [piece.under(rim, CLOSED_M) for piece in below]
    nearest = np.argmin([np.linalg.norm(one.vertices - rim, axis=1) for one in found], axis=0)
    rows = np.arange(len(rim))
    return cloth.turned_in(
        replace(
            cloth,
            vertices=np.stack([one.vertices for one in found])[nearest, rows],
            weights=np.stack([one.weights for one in found])[nearest, rows],
            deltas=np.stack([one.deltas for one in found], axis=1)[:, nearest, rows],
            colours=np.full((len(rim), 3), INSIDE),
        )
    )


def bare(skin: Piece, anatomy: Anatomy, margin_m: float = 0.02) -> Piece:
    """Return the skin without the parts further below cloth than a margin."""
    hidden = Pattern(anatomy).covered(skin.vertices) > margin_m
    return skin.only(np.asarray(~hidden[skin.triangles].all(axis=1)))


def smooth_step(start: float, end: float, x: Floats) -> Floats:
    """Return a smooth step: 0 at `start`, 1 at `end`, level at both, in either order."""
    t = np.clip((x - start) / (end - start), 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))


def _chest(at: Floats, anatomy: Anatomy) -> Floats:
    """Return 1 on the front of the chest, where cloth spans a hollow of the body, 0 elsewhere."""
    height = anatomy.origin("clav_L")[1]
    out = anatomy.origin("arm_L")[0]
    level = smooth_step(0.30, 0.18, height - at[:, 1]) * smooth_step(0.0, 0.06, height - at[:, 1])
    return np.asarray(level * smooth_step(out * 1.1, out * 0.8, np.abs(at[:, 0])))
