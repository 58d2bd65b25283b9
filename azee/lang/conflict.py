"""Orientations that exclude each other in one set."""

from __future__ import annotations

from collections.abc import Sequence

from azee_solver.constraint import BoneAxis, Constraint, Orient
from azee_solver.geometry import Bone, Side


def orient_conflict(
    constraints: Sequence[Constraint], dominant: Side | None = None
) -> tuple[str, int] | None:
    """Find a second `'dir` or a second `'nrm` of one bone (Nunnari et al. 2018, section 4.2).

    Without a dominant hand, `s` and `R` count as different sides.

    Returns: the mistake, and the number of the second constraint.
    """
    seen: set[tuple[BoneAxis, str, Side | None, int | None]] = set()
    for i, constraint in enumerate(constraints):
        if not isinstance(constraint, Orient):
            continue
        bone = constraint.bone
        side = bone.side if bone.side is None or dominant is None else bone.side.bound(dominant)
        key = (constraint.axis, bone.name, side, bone.phalanx)
        if key in seen:
            message = f"the {constraint.axis.value} of {_title(bone)} is oriented twice in one set"
            return message, i
        seen.add(key)
    return None


def _title(bone: Bone) -> str:
    side = None if bone.side is None else bone.side.value
    operands = ", ".join(str(part) for part in (side, bone.phalanx) if part is not None)
    return f"`!{bone.name}({operands})`" if operands else f"`!{bone.name}`"
