"""The places and directions of AZee's bones on any body: the input of the chain builder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.makehuman import Body

Floats = NDArray[np.float64]
SIDES = ("L", "R")
FINGERS = ("index", "middle", "ring", "little")
DIGITS = ("thumb", *FINGERS)
PHALANGES = (1, 2, 3)


@dataclass(frozen=True, eq=False, slots=True)
class Anatomy:
    """Places of a body's joints in its own posture, metres, by AZee bone.

    joints: per bone the places of its joints, proximal first; all AZee bones are present.
    tips: per digit, such as `index_L`, the end of its last phalanx.
    head_top: (3,). gaze: per eye a unit vector.
    thumb_nail: per side the outward unit normal of the thumbnail, which determines the plane in
        which the thumb bends better than its joints do.
    """

    joints: Mapping[str, Sequence[Floats]]
    tips: Mapping[str, Floats]
    head_top: Floats
    gaze: Mapping[str, Floats]
    thumb_nail: Mapping[str, Floats]

    def origin(self, bone: str) -> Floats:
        """Return the place of a bone's proximal joint."""
        return self.joints[bone][0]


def read_anatomy(
    body: Body,
    bones: Mapping[str, Sequence[str]],
    nails: Mapping[str, NDArray[np.int64]],
) -> Anatomy:
    """Read the anatomy of a body through its bones-map."""
    place = dict(zip(body.joints, body.heads, strict=True))
    end = dict(zip(body.joints, body.tails, strict=True))
    joints = {bone: [place[j] for j in chain] for bone, chain in bones.items()}
    gaze = {s: unit(end[bones[f"eye_{s}"][0]] - joints[f"eye_{s}"][0]) for s in SIDES}
    return Anatomy(
        joints=joints,
        tips={f"{d}_{s}": end[bones[f"{d}_{s}_3"][0]] for d in DIGITS for s in SIDES},
        head_top=end[bones["head"][0]],
        gaze=gaze,
        thumb_nail={s: _normal(body, nails[s]) for s in SIDES},
    )


def unit(v: Floats) -> Floats:
    """Return v with length one."""
    return np.asarray(v / np.linalg.norm(v))


def _normal(body: Body, rows: NDArray[np.int64]) -> Floats:
    """Return the mean outward normal of the faces whose vertices are all among some vertices."""
    quads = body.faces[body.faces[:, 3] >= 0]
    quads = quads[np.isin(quads, rows).all(axis=1)]
    corner = body.vertices[quads]
    return unit(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]).sum(axis=0))
