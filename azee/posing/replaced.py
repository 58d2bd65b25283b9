"""Which constraints of a text a handle speaks of too, and so replaces."""

from __future__ import annotations

from azee.motion.tasks.limbs import is_finger, limb_of_bone
from azee.posing.handle import BoneHandle, GazeHandle, Handle, MorphHandle, SiteHandle
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


def is_replaced(constraint: Constraint, handle: Handle, binding: Binding) -> bool:
    """Whether a constraint is replaced by what is dragged.

    A placement does if its site is on the same hand, or on the same bone elsewhere; an orientation
    if it is of the same axis of the same bone; all gazes do; a morph if it is the same one or moves
    the same joints, since the angles of morphs add up.
    """
    match handle, constraint:
        case SiteHandle(site), Place(site=other):
            one, two = (binding.site(s).bone for s in (site, other))
            return one == two or (_hand(one) is not None and _hand(one) == _hand(two))
        case BoneHandle(bone, axis), Orient(axis=other_axis, bone=other_bone):
            dominant = binding.dominant
            return axis is other_axis and bone.key(dominant) == other_bone.key(dominant)
        case GazeHandle(), Look() | LookAt():
            return True
        case MorphHandle(), Morph() as morph:
            return is_same(handle, morph, binding) or bool(
                _joints(Morph(handle.name, handle.side, 1.0), binding) & _joints(morph, binding)
            )
        case _, Place() | Orient() | Look() | LookAt() | Morph() | Rotate() | Trill() | Transpath():
            return False


def is_same(handle: MorphHandle, morph: Morph, binding: Binding) -> bool:
    """Whether a morph is the one of a handle, with whatever weight."""
    dominant = binding.dominant
    return Morph(handle.name, handle.side, 0.0).key(dominant) == morph.key(dominant)


def _joints(morph: Morph, binding: Binding) -> frozenset[int]:
    if not (binding.has(morph) and binding.is_skeletal(morph)):
        return frozenset()
    return frozenset(binding.preset(morph))


def _hand(bone: str) -> str | None:
    """Return the side of the hand that a bone is of, L or R."""
    limb = limb_of_bone(bone)
    if is_finger(limb) or bone.startswith("palm_"):
        return limb[-1]
    return None
