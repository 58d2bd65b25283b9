"""Which tasks no single posture can meet, decided from their targets alone."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from azee.motion.tasks.timed_task import TimedTask
from azee_rig.chain import Frames
from azee_solver.binding import Binding
from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.evaluate import Evaluator, angle
from azee_solver.geometry import Point, Swing, Vector

_TINY_RAD = 1e-9
_SAME_M, _SAME_RAD = 1e-4, 1e-3
"""Targets that differ by no more are one."""


def contradict(
    ending: Iterable[TimedTask],
    starting: Iterable[TimedTask],
    evaluator: Evaluator,
    frames: Frames,
) -> bool:
    """Whether two sets of tasks give one site, axis or joint different targets.

    Of what moves, the end is compared before and the start after. Two expressions that mean one
    place or direction, such as the end of a movement and the place where the next block has the
    hand, are one target. What this does not find, the solver does.

    Args: frames: of a posture near by, on which places of the body are compared.
    Raises: BindingError: the rig lacks a bone or site.
    """
    binding = evaluator.binding
    first, second = [t.constraint for t in ending], [t.constraint for t in starting]
    targets = dict(_targets(first, binding, at_end=True))
    return any(
        subject in targets and not _agree(targets[subject], target, evaluator, frames)
        for subject, target in _targets(second, binding, at_end=False)
    ) or _morphs_differ(first, second, binding)


def _agree(ends: object, starts: object, evaluator: Evaluator, frames: Frames) -> bool:
    """Whether two targets of one subject are the same, by their expressions or where they are."""
    match ends, starts:
        case _Aim(a, at, b), _Aim(c, since, d):
            if a == c or b != d:
                return b == d
            one, other = evaluator.point(a, frames, at), evaluator.point(c, frames, since)
            return bool(np.linalg.norm(one - other) <= _SAME_M)
        case _Heading(v), _Heading(w) if v != w:
            one, other = evaluator.vector(v, frames), evaluator.vector(w, frames)
            return bool(angle(one, other) <= _SAME_RAD)
    return ends == starts


@dataclass(frozen=True, slots=True)
class _Aim:
    """Where a site is to be, at a share of its block, and how far from there."""

    point: Point
    phase: float
    distance_m: float


@dataclass(frozen=True, slots=True)
class _Heading:
    """Where an axis of a bone is to point."""

    vector: Vector


def _targets(
    constraints: Iterable[Constraint], binding: Binding, *, at_end: bool
) -> Iterable[tuple[tuple[str, ...], object]]:
    """Yield what each constraint acts on, and the target that it gives it at one of its ends."""
    for constraint in constraints:
        match constraint:
            case Place(site, point, distance):
                aim = _Aim(point, 1.0 if at_end else 0.0, distance)
                yield ("place", site.key(binding.dominant)), aim
            case Orient(axis, bone, Relation.ALONG, vector):
                target: Vector | None = vector
                if isinstance(vector, Swing):
                    target = vector.end if at_end else vector.start
                if target is not None:
                    yield ("orient", bone.key(binding.dominant), axis.value), _Heading(target)
            case Rotate(bone, axis, angle):
                yield ("rotate", bone.key(binding.dominant)), (axis, angle)
            case Look() | LookAt():
                yield ("gaze",), constraint
            case Orient() | Morph() | Trill() | Transpath():
                pass


def _morphs_differ(
    first: Iterable[Constraint], second: Iterable[Constraint], binding: Binding
) -> bool:
    """Whether two sets of skeletal morphs ask one coordinate for different angles."""
    a, b = binding.presets(_distinct(first)), binding.presets(_distinct(second))
    return any(abs(a[v] - b[v]) > _TINY_RAD for v in a.keys() & b.keys())


def _distinct(constraints: Iterable[Constraint]) -> list[Constraint]:
    return [*dict.fromkeys(c for c in constraints if isinstance(c, Morph))]
