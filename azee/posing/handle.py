"""What of a body can be dragged, and what a drag asks of the solver."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from azee.lang.program import Program
from azee.lang.values import BoneValue, ConstraintsValue, SiteValue
from azee.posing.fault import cannot_pose
from azee_grammar.diagnostic import AZeeError
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    LookAt,
    Morph,
    Orient,
    Place,
    Relation,
)
from azee_solver.geometry import Bone, Side, Site, Vec, WorldPoint
from azee_solver.notation import part_text


@dataclass(frozen=True, slots=True)
class SiteHandle:
    """A site of the skin, dragged to a point of the world, metres."""

    site: Site

    def __str__(self) -> str:
        return part_text(self.site)


@dataclass(frozen=True, slots=True)
class BoneHandle:
    """An axis of a bone, turned to a direction of the world."""

    bone: Bone
    axis: BoneAxis = BoneAxis.DIR

    def __str__(self) -> str:
        return f"{self.axis.value} {part_text(self.bone)}"


@dataclass(frozen=True, slots=True)
class GazeHandle:
    """The gaze, led to a point of the world, metres."""

    def __str__(self) -> str:
        return "gaze"


@dataclass(frozen=True, slots=True)
class MorphHandle:
    """A shape of the face, or the bend of a finger, with a weight."""

    name: str
    side: Side | None = None

    def __str__(self) -> str:
        return f"'{self.name}" + (f" {self.side.value}" if self.side else "")


Handle: TypeAlias = SiteHandle | BoneHandle | GazeHandle | MorphHandle
Target: TypeAlias = tuple[float, ...]
"""A point or a direction, three numbers; a weight, one."""


def read_handle(text: str, program: Program) -> Handle:
    """Read `@I_TIP(s)`, `I_TIP(s)`, `!palm(s)`, `nrm !palm(s)`, `gaze`, `'AU12`, `'index_bend s`.

    Raises: AZeeError: it is none of these, or the body of AZee has no such part.
    """
    words = text.split()
    if text.strip() == "gaze":
        return GazeHandle()
    if words and words[0].startswith("'") and len(words) <= 2:
        return _morph(words[0][1:], words[1] if len(words) == 2 else None, program)
    axis = BoneAxis.DIR
    if len(words) > 1 and words[0] in ("dir", "nrm"):
        axis, text = BoneAxis(words[0]), text.strip()[3:].strip()
    sigil = "" if text.strip()[:1] in "@!" else "@"
    part = program.value(f"{sigil}{text.strip()}", "the handle")
    if isinstance(part, SiteValue):
        return SiteHandle(part.content)
    if isinstance(part, BoneValue):
        return BoneHandle(part.content, axis)
    raise AZeeError(cannot_pose(f"`{text}` is no part of a body that can be dragged"))


def _morph(name: str, side: str | None, program: Program) -> MorphHandle:
    given = f" {side}" if side else ""
    value = program.value(f"morph '{name}{given} 1", "the handle")
    assert isinstance(value, ConstraintsValue)
    (morph,) = value.content
    assert isinstance(morph, Morph)
    return MorphHandle(morph.name, morph.side)


FARTHEST = 5.0
"""No drag goes beyond so many metres; a screen has an edge."""
HEAVIEST = 2.0
"""The greatest weight of a morph, to either side."""


def checked_target(name: str, target: Sequence[float], *, weight: bool) -> Target:
    """Return the target of a handle: three numbers, or a weight.

    Raises: AZeeError: cannot-pose: it is none, or out of all reach.
    """
    numbers = tuple(float(x) for x in target)
    if len(numbers) != (1 if weight else 3) or not all(map(math.isfinite, numbers)):
        kind = "a weight" if weight else "three numbers"
        raise AZeeError(cannot_pose(f"`{name}` is dragged to {kind}"))
    most = HEAVIEST if weight else FARTHEST
    if max(map(abs, numbers)) > most:
        raise AZeeError(cannot_pose(f"`{name}` is dragged too far: at most {most:g}"))
    return numbers


def constraint_of(handle: Handle, target: Target, touching: tuple[Site, ...] = ()) -> Constraint:
    """Return what dragging a handle to a target asks of a posture.

    Args: touching: sites of the part of the body whose skin is at a point, and may be touched.
    """
    match handle:
        case SiteHandle(site):
            x, y, z = target
            return Place(site, WorldPoint(x, y, z, touching))
        case BoneHandle(bone, axis):
            x, y, z = target
            return Orient(axis, bone, Relation.ALONG, Vec(x, y, z))
        case GazeHandle():
            x, y, z = target
            return LookAt(WorldPoint(x, y, z))
        case MorphHandle(name, side):
            (weight,) = target
            return Morph(name, side, weight)
