"""Rests: the postures in which the signer stands before and after, and an idle hand meanwhile.

Signers let their arms hang, or lay one hand on the other before the belly. Each rest is stated by
constraints and found by the solver, so that every body has it, free of collisions.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from azee_solver.anatomy import Part, part_of
from azee_solver.binding import Binding
from azee_solver.constraint import BoneAxis, Constraint, Orient, Place, Relation
from azee_solver.geometry import Bone, Side, Site, SitePoint, Vec, VTranslate
from azee_solver.options import SolveOptions
from azee_solver.solve import solve
from azee_solver.task import Task

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Rest = Literal["folded", "hanging", "ready"]

RESTS: tuple[Rest, ...] = get_args(Rest)
DEFAULT: Rest = "hanging"

RELAXED_DEG: Mapping[str, float] = {
    f"{finger}_{{side}}_{joint}": angle
    for finger, angles in {
        "index": (1, 22, 25, 10),
        "middle": (0, 25, 28, 12),
        "ring": (-2, 28, 31, 14),
        "little": (-4, 31, 33, 15),
    }.items()
    for joint, angle in zip(
        ("1.deviation", "1.flexion", "2.flexion", "3.flexion"), angles, strict=True
    )
} | {"thumb_{side}_1.flexion": -30, "thumb_{side}_1.abduction": 26}
"""Digits that nothing is asked of: together, and more and more bent from index to little finger, as
a hand at rest has them (Taylor & Schwarz 1955); the angles are ours."""

ARMS_DEG: Mapping[Rest, Mapping[str, float]] = {
    "hanging": {
        "arm_{side}.flexion": 0,
        "arm_{side}.abduction": 6,
        "arm_{side}.rotation": 15,
        "f_arm_{side}.flexion": 16,
        "f_arm_{side}.pronation": 20,
        "palm_{side}.flexion": 5,
    },
    "folded": {
        "arm_{side}.flexion": 28,
        "arm_{side}.abduction": 20,
        "arm_{side}.rotation": 78,
        "f_arm_{side}.flexion": 75,
        "f_arm_{side}.pronation": -40,
        "palm_{side}.flexion": 8,
    },
    "ready": {},
}
"""Where the search starts, and what it is drawn to. `ready` has the arms of the rig's neutral
posture."""


@lru_cache(maxsize=16)
def rest_posture(rig: Rig, rest: Rest, dominant: Side) -> Array:
    """Return a rest of a body, (V,) radians, read-only.

    Trunk, head, eyes and clavicles are as in the rig's neutral posture. What a body lacks, such as
    hands, is left out.
    """
    coordinates = rig.coordinates
    posture = np.clip(
        _with(coordinates.idle, {**RELAXED_DEG, **ARMS_DEG[rest]}, rig),
        coordinates.lower,
        coordinates.upper,
    )
    binding = Binding(rig, dominant)
    tasks = [
        Task(constraint, (rest,), Fraction(0), rank, 0.0)
        for rank, constraint in enumerate(_constraints(rest, dominant))
        if binding.has(constraint)
    ]
    if tasks:
        fixed = frozenset(
            v
            for v, name in enumerate(coordinates.names)
            if part_of(name) is not Part.ARM or name.startswith("clav")
        )
        options = SolveOptions(fixed=fixed, far=False, patience=0)
        found = solve(
            rig, tasks, dominant=dominant, start=posture, reference=posture, options=options
        )
        posture = np.array(found.coordinates)
    posture.setflags(write=False)
    return posture


def _constraints(rest: Rest, dominant: Side) -> Sequence[Constraint]:
    """Return what states a rest; x is to the signer's left, y up, z forward."""
    strong, weak = Side.STRONG, Side.WEAK
    inward = 1.0 if dominant is Side.RIGHT else -1.0
    match rest:
        case "folded":
            # Both palms face the belly, the strong hand before the weak one, as near as may be.
            return (
                *_palm(weak, along=(-0.85 * inward, -0.25, 0.3), facing=(0.0, 0.2, -1.0)),
                Place(Site("PA", weak), SitePoint(Site("AB")), distance_m=0.05),
                *_palm(strong, along=(0.85 * inward, -0.25, 0.3), facing=(0.0, 0.2, -1.0)),
                Place(
                    Site("PA", strong),
                    VTranslate(SitePoint(Site("H_BACK", weak)), Vec(0.0, 0.03, 0.07)),
                ),
            )
        case "hanging":
            # The palms face the thighs.
            return (
                *_palm(strong, along=(0.0, -1.0, 0.15), facing=(inward, 0.0, -0.2)),
                *_palm(weak, along=(0.0, -1.0, 0.15), facing=(-inward, 0.0, -0.2)),
            )
        case "ready":
            return ()


def _palm(
    side: Side, *, along: tuple[float, float, float], facing: tuple[float, float, float]
) -> tuple[Orient, Orient]:
    """Orient a hand along a direction, its palm as near to another as it can be."""
    d, n = np.array(along), np.array(facing)
    n = n - d * (n @ d) / (d @ d)
    bone = Bone("palm", side)
    return (
        Orient(BoneAxis.DIR, bone, Relation.ALONG, Vec(*d.tolist())),
        Orient(BoneAxis.NRM, bone, Relation.ALONG, Vec(*n.tolist())),
    )


def _with(posture: Array, angles_deg: Mapping[str, float], rig: Rig) -> Array:
    """Set coordinates of both sides; those that the body lacks are left out."""
    out, index = np.array(posture), rig.coordinates.index
    for name, angle in angles_deg.items():
        for side in "LR":
            if (v := index.get(name.format(side=side))) is not None:
                out[v] = math.radians(angle)
    return out
