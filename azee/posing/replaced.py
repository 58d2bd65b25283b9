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
    """Whether a constraint gives way to what is dragged.

    A placement does if its site is on the same hand, or on the same bone elsewhere; an orientation
    if it is of the same axis of the same bone; all gazes do; a morph if it is the same one.
    """
    match handle, constraint:
        case SiteHandle(site), Place(site=other):
            one, two = (binding.site(s).bone for s in (site, other))
            return one == two or _hand(one) is not None and _hand(one) == _hand(two)
        case BoneHandle(bone, axis), Orient(axis=other_axis, bone=other_bone):
            dominant = binding.dominant
            return axis is other_axis and bone.key(dominant) == other_bone.key(dominant)
        case GazeHandle(), Look() | LookAt():
            return True
        case MorphHandle(name, side), Morph() as morph:
            return Morph(name, side, 0.0).key(binding.dominant) == morph.key(binding.dominant)
        case _, Place() | Orient() | Look() | LookAt() | Morph() | Rotate() | Trill() | Transpath():
            return False


def _hand(bone: str) -> str | None:
    """Return the side of the hand that a bone is of, L or R."""
    limb = limb_of_bone(bone)
    if is_finger(limb) or bone.startswith("palm_"):
        return limb[-1]
    return None
