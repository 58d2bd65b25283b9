"""Which tasks no single posture can meet, told from their symbols alone."""

from __future__ import annotations

from collections.abc import Iterable

from azee.motion.tasks.timed_task import Bound
from azee_solver.binding import Binding
from azee_solver.constraint import Constraint, Look, LookAt, Morph, Orient, Place, Relation, Rotate

_TINY_RAD = 1e-9


def contradict(ending: Iterable[Bound], starting: Iterable[Bound], binding: Binding) -> bool:
    """Whether two sets of requirements say different things of one site, axis or joint.

    A contradiction is certain only in what the words say: two different expressions may still
    mean the same point. What this misses, the solver finds.
    """
    first, second = [b.constraint for b in ending], [b.constraint for b in starting]
    said = dict(_subjects(first, binding))
    return any(
        subject in said and said[subject] != claim for subject, claim in _subjects(second, binding)
    ) or _morphs_differ(first, second, binding)


def _subjects(
    constraints: Iterable[Constraint], binding: Binding
) -> Iterable[tuple[tuple[str, ...], object]]:
    for constraint in constraints:
        match constraint:
            case Place(site, point, distance):
                yield ("place", site.key(binding.dominant)), (point, distance)
            case Orient(axis, bone, Relation.ALONG, vector):
                yield ("orient", bone.key(binding.dominant), axis.value), vector
            case Rotate(bone, axis, angle):
                yield ("rotate", bone.key(binding.dominant)), (axis, angle)
            case Look() | LookAt():
                yield ("gaze",), constraint
            case _:
                pass


def _morphs_differ(
    first: Iterable[Constraint], second: Iterable[Constraint], binding: Binding
) -> bool:
    """Whether two sets of skeletal morphs ask one coordinate for different angles."""
    a, b = binding.presets(_distinct(first)), binding.presets(_distinct(second))
    return any(abs(a[v] - b[v]) > _TINY_RAD for v in a.keys() & b.keys())


def _distinct(constraints: Iterable[Constraint]) -> list[Constraint]:
    return [*dict.fromkeys(c for c in constraints if isinstance(c, Morph))]
