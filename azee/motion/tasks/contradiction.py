"""Which tasks no single posture can meet, decided from their symbols alone."""

from __future__ import annotations

from collections.abc import Iterable

from azee.motion.tasks.timed_task import TimedTask
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
from azee_solver.geometry import Swing, Vector

_TINY_RAD = 1e-9


def contradict(
    ending: Iterable[TimedTask], starting: Iterable[TimedTask], binding: Binding
) -> bool:
    """Whether two sets of tasks give one site, axis or joint different targets.

    Targets are compared as expressions, without a posture; of a swing its end before and its start
    after. Two different expressions may mean the
    same point: then the blocks are separated though one posture could serve both. The same
    expression never contradicts itself. What this does not find, the solver does.
    """
    first, second = [t.constraint for t in ending], [t.constraint for t in starting]
    targets = dict(_targets(first, binding, at_end=True))
    return any(
        subject in targets and targets[subject] != target
        for subject, target in _targets(second, binding, at_end=False)
    ) or _morphs_differ(first, second, binding)


def _targets(
    constraints: Iterable[Constraint], binding: Binding, *, at_end: bool
) -> Iterable[tuple[tuple[str, ...], object]]:
    """Yield what each constraint acts on, and the target that it gives it at one of its ends."""
    for constraint in constraints:
        match constraint:
            case Place(site, point, distance):
                yield ("place", site.key(binding.dominant)), (point, distance)
            case Orient(axis, bone, Relation.ALONG, vector):
                target: Vector | None = vector
                if isinstance(vector, Swing):
                    target = vector.end if at_end else vector.start
                yield ("orient", bone.key(binding.dominant), axis.value), target
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
