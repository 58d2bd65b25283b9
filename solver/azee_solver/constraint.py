"""Constraints as AZee declares them: rig-independent, frozen, each with its origin.

Only declarations: neither this module nor what it imports needs more than the standard library: a
text can be checked without loading a solver.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import TypeAlias

from azee_solver.geometry import Bone, Path, Point, Side, Site, Vector
from azee_solver.hashing import RemembersHash, hash_once


@dataclass(frozen=True, slots=True)
class Origin:
    """Where something was written: file, line and column from 1, and the rule it stands in."""

    file: str
    line: int
    column: int
    rule: str | None = None


@dataclass(frozen=True, slots=True)
class _Constraint(RemembersHash):
    origin: Origin | None = field(default=None, compare=False, kw_only=True)


class BoneAxis(Enum):
    """Which of a bone's axes an orientation speaks of."""

    DIR = "dir"
    NRM = "nrm"


class Relation(Enum):
    """Parallel in the same sense, or perpendicular."""

    ALONG = "along"
    ACROSS = "across"


@hash_once
@dataclass(frozen=True, slots=True)
class Place(_Constraint):
    """`place SITE POINT`: the site lies at the point.

    `distance_m` lies along the outward normal where the point is a site, in any direction from a
    free point. `contact` lets the surfaces touch there and exempts them from collision. It is met
    up to `within_m` away, and drawn to the middle.
    """

    site: Site
    point: Point
    distance_m: float = 0.0
    contact: bool = False
    within_m: float = 0.0


@hash_once
@dataclass(frozen=True, slots=True)
class Orient(_Constraint):
    """`orient 'dir|'nrm BONE 'along|'across VECTOR`: met up to `within_rad` off."""

    axis: BoneAxis
    bone: Bone
    relation: Relation
    vector: Vector
    within_rad: float = 0.0


@hash_once
@dataclass(frozen=True, slots=True)
class Look(_Constraint):
    """`look VECTOR`: eyes first, then head, then neck."""

    vector: Vector


@hash_once
@dataclass(frozen=True, slots=True)
class LookAt(_Constraint):
    """`lookat POINT`: eyes first, then head, then neck."""

    point: Point


@hash_once
@dataclass(frozen=True, slots=True)
class Morph(_Constraint):
    """`morph 'name [side] w`: facial shapes and skeletal presets; negative weights are legal.

    A skeletal one yields to contacts by up to `within_rad` in each joint.
    """

    name: str
    side: Side | None
    weight: float
    within_rad: float = 0.0

    def key(self, dominant: Side) -> str:
        """Name in the morph table, such as `index_bend_R`."""
        return self.name if self.side is None else f"{self.name}_{self.side.bound(dominant).value}"


@hash_once
@dataclass(frozen=True, slots=True)
class Trill(_Constraint):
    """`trill BONE AXIS`: a small rapid oscillation of a bone about an axis, while it lasts.

    The angle goes between `amplitude_rad` about the axis and `back_rad` against it, the same where
    it is None. It starts in the middle, or at `phase_rad` of a cycle. `cycles`: how often while it
    lasts, instead of a frequency.
    """

    bone: Bone
    axis: Vector
    frequency_hz: float
    amplitude_rad: float
    back_rad: float | None = None
    phase_rad: float = 0.0
    cycles: float | None = None

    @property
    def other_rad(self) -> float:
        """How far the bone turns against the axis."""
        return self.amplitude_rad if self.back_rad is None else self.back_rad

    def hz(self, duration_s: float) -> float:
        """Oscillations a second of a trill that lasts so long."""
        if self.cycles is None:
            return self.frequency_hz
        return self.cycles / duration_s if duration_s > 0 else math.inf


@hash_once
@dataclass(frozen=True, slots=True)
class Rotate(_Constraint):
    """`rotate BONE AXIS ANGLE`: from neutral, axis in the parent bone's frame."""

    bone: Bone
    axis: Vector
    angle_rad: float


class Manner(Enum):
    """How a movement takes its time; its words are those of a text."""

    TENSE = "tense"
    SLOW_START = "slow-start"
    SHARP_STOP = "sharp-stop"
    SOFT = "soft"

    __hash__ = object.__hash__


@hash_once
@dataclass(frozen=True, slots=True)
class Transpath(_Constraint):
    """`transpath SITE PATH`: controlled movement between the places before and after."""

    site: Site
    path: Path
    manner: Manner | None = None


Constraint: TypeAlias = Place | Orient | Look | LookAt | Morph | Trill | Rotate | Transpath
