"""Limbs: the parts of a body whose coordinates are keyed together.

The signer has fifteen: trunk, head with neck, eyes, each arm from clavicle to palm, each finger.
A key posture keys only limbs that something constrains there. The others have keys at their own
times, so that a head shake does not stop an arm on its way.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from azee.score.score import SIDE_CHANNELS
from azee_rig.coordinates import Coordinates
from azee_solver.binding import Binding
from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import Bone, Site

TRUNK = "trunk"
"""The limb that carries all others."""
CARRIERS = (TRUNK, "head")
"""Limbs that carry others: where they turn, arms, head or eyes go along."""

NON_MANUAL = (TRUNK, "head", "eyes", "face")
"""What constraints name beside arms and fingers."""

_FINGER = re.compile(r"((?:thumb|index|middle|ring|little)_[LR])(?:_\d)?")
_ARM = re.compile(r"(?:clav|arm|f_arm|palm)_([LR])")


@lru_cache(maxsize=1024)
def limb_of_bone(bone: str) -> str:
    """Limb that a bone of the body belongs to, such as `arm_L`, by the bone's key."""
    if found := _FINGER.fullmatch(bone):
        return found[1]
    if found := _ARM.fullmatch(bone):
        return f"arm_{found[1]}"
    if bone.startswith("eye_"):
        return "eyes"
    if bone in ("neck", "head"):
        return "head"
    return TRUNK if bone.startswith("back_") else bone


@lru_cache(maxsize=1024)
def limb_of_coordinate(coordinate: str) -> str:
    """Limb of a coordinate, by its name: `f_arm_R.pronation` is of `arm_R`."""
    return limb_of_bone(coordinate.partition(".")[0])


def channel_of_limb(limb: str) -> str:
    """Channel of `azee.score.score.CHANNELS` that a limb belongs to."""
    return limb if limb in ("head", "trunk", "eyes") else "hands"


ARM_ORDER = ("clav", "arm", "f_arm", "palm")
"""Bones of an arm from the trunk outwards."""


def place_in_arm(coordinate: str) -> float:
    """How far down the arm a coordinate is, 0 at the clavicle to 1 at the hand; else 0."""
    bone = coordinate.partition(".")[0]
    if not _ARM.fullmatch(bone):
        return 0.0
    return ARM_ORDER.index(bone[:-2]) / (len(ARM_ORDER) - 1)


def is_finger(limb: str) -> bool:
    """Whether a limb is a finger or a thumb."""
    return _FINGER.fullmatch(limb) is not None


@dataclass(frozen=True, eq=False)
class Limbs:
    """The limbs of one rig: names (L,) and the limb of every coordinate, (V,) indices."""

    names: tuple[str, ...]
    of_coordinate: NDArray[np.int64]

    @staticmethod
    @lru_cache(maxsize=16)
    def of(coordinates: Coordinates) -> Limbs:
        """Group a rig's coordinates, once; limbs stand in the order of their first coordinate."""
        each = [limb_of_coordinate(name) for name in coordinates.names]
        names = tuple(dict.fromkeys(each))
        return Limbs(names, np.array([names.index(limb) for limb in each], dtype=np.int64))

    @cached_property
    def members(self) -> dict[str, NDArray[np.int64]]:
        """Indices of each limb's coordinates."""
        return {n: np.flatnonzero(self.of_coordinate == i) for i, n in enumerate(self.names)}

    def touching(self, coordinates: Iterable[int]) -> frozenset[str]:
        """Limbs that own any of the coordinates."""
        return frozenset(self._limb_names[v] for v in coordinates)

    @cached_property
    def _limb_names(self) -> tuple[str, ...]:
        """The limb of every coordinate, by name."""
        return tuple(self.names[i] for i in self.of_coordinate.tolist())


def limb_of_constraint(constraint: Constraint, binding: Binding) -> str:
    """Limb of the bone or site that a constraint names; `face` for a facial morph.

    A site belongs to the limb of its bone; gaze belongs to the eyes. Raises: BindingError.
    """
    match constraint:
        case Place(site=Site() as site) | Transpath(site=Site() as site):
            return limb_of_bone(binding.site(site).bone)
        case Orient(bone=Bone() as bone) | Rotate(bone=Bone() as bone) | Trill(bone=Bone() as bone):
            return limb_of_bone(bone.key(binding.dominant))
        case Look() | LookAt():
            return "eyes"
        case Morph():
            if not binding.is_skeletal(constraint):
                return "face"
            angles = binding.rig.skeletal_morphs[constraint.key(binding.dominant)]
            return limb_of_coordinate(next(iter(angles)))


def channels_of_constraint(constraint: Constraint, binding: Binding) -> frozenset[str]:
    """Channels of which a hold must name one to keep a constraint: for a hand also its side's."""
    limb = limb_of_constraint(constraint, binding)
    if limb == "face" or channel_of_limb(limb) != "hands":
        return frozenset({limb})
    sides = {
        name
        for name, side in SIDE_CHANNELS.items()
        if limb.endswith(f"_{side.bound(binding.dominant).value}")
    }
    return frozenset({"hands", *sides})
