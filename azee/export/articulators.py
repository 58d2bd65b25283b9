"""Which part of the signer a constraint moves, told without a body."""

from __future__ import annotations

from azee_grammar.vocabulary import MORPHS, SITES
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
from azee_solver.geometry import Bone, Side, Site

HANDS = {
    Side.STRONG: "strong hand",
    Side.WEAK: "weak hand",
    Side.RIGHT: "right hand",
    Side.LEFT: "left hand",
}
ARTICULATORS = (*HANDS.values(), "head", "gaze", "face", "trunk")
"""Names of the parts, in the order in which they are shown; a hand has its arm."""
CHANNEL = {"head": "head", "gaze": "eyes", "face": "face", "trunk": "trunk"}
"""What a hold calls a part; hands are `hands`."""


def articulator_of(constraint: Constraint) -> str:
    """Return the part of `ARTICULATORS` that a constraint moves; sites go with their bone."""
    match constraint:
        case Place(site=Site() as site) | Transpath(site=Site() as site):
            # Sites of both sides hang on the same bone, but for its side.
            entry = SITES.get(site.key(Side.RIGHT))
            return _of_bone(entry.bone if entry else "", site.side)
        case Orient(bone=Bone() as bone) | Rotate(bone=Bone() as bone) | Trill(bone=Bone() as bone):
            return _of_bone(bone.name, bone.side)
        case Look() | LookAt():
            return "gaze"
        case Morph():
            entry_of_morph = MORPHS.get(constraint.key(Side.RIGHT))
            skeletal = entry_of_morph is not None and entry_of_morph.kind.endswith("skeletal")
            return _of_preset(constraint) if skeletal else "face"


def _of_bone(bone: str, side: Side | None) -> str:
    if bone.startswith("eye"):
        return "gaze"
    if bone.startswith(("neck", "head")):
        return "head"
    if side is None or bone.startswith("back"):
        return "trunk"
    return HANDS[side]


def _of_preset(morph: Morph) -> str:
    """Return the part that a skeletal morph moves; names without a side operand may have one."""
    if morph.name.startswith("spine"):
        return "trunk"
    left = morph.name.lower().endswith("_l") or "_l_" in morph.name
    return HANDS[morph.side or (Side.LEFT if left else Side.RIGHT)]
