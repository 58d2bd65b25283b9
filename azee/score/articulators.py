"""Which part of the signer a constraint moves, told by its names, without a body."""

from __future__ import annotations

import re

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
from azee_solver.geometry import Side

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
    """Return the part of `ARTICULATORS` that a constraint moves; sites go with their bone.

    Shoulders that are raised or shrugged count as trunk, though they belong to an arm.
    """
    match constraint:
        case Morph(name=name) if name.startswith(("spine", "shoulder")):
            return "trunk"
        case Morph() if not _is_preset(constraint):
            return "face"
        case Look() | LookAt():
            return "gaze"
        case Place() | Transpath() | Orient() | Rotate() | Trill() | Morph():
            arm = arm_of(constraint)
            return _CARRIERS.get(_bone(constraint)[:4], "trunk") if arm is None else HANDS[arm]


_CARRIERS = {"eye": "gaze", "neck": "head", "head": "head"}
"""Parts that bones of no arm belong to; all others are the trunk's."""


def arm_of(constraint: Constraint) -> Side | None:
    """Return the side of the arm or hand that a constraint is about; None for all else."""
    match constraint:
        case Place(site=site) | Transpath(site=site):
            return site.side if _ARM.fullmatch(_bone(constraint)) else None
        case Orient(bone=bone) | Rotate(bone=bone) | Trill(bone=bone):
            return bone.side if _ARM.fullmatch(_bone(constraint)) else None
        case Morph(name=name, side=side):
            if not _is_preset(constraint) or name.startswith("spine"):
                return None
            return side or (Side.LEFT if _LEFT.search(name) else Side.RIGHT)
        case Look() | LookAt():
            return None


_ARM = re.compile(r"clav|arm|f_arm|palm|thumb|index|middle|ring|little")
_LEFT = re.compile(r"_[Ll](_|$)")
"""In names of presets that take no side; those without it are of the right hand."""


def _bone(constraint: Constraint) -> str:
    """Return the bone that a constraint moves, without its side."""
    match constraint:
        case Place(site=site) | Transpath(site=site):
            # Sites of both sides hang on the same bone, but for its side.
            entry = SITES.get(site.key(Side.RIGHT))
            return _SIDE.sub("", entry.bone) if entry else ""
        case Orient(bone=bone) | Rotate(bone=bone) | Trill(bone=bone):
            return bone.name
        case Look() | LookAt() | Morph():
            return ""


_SIDE = re.compile(r"_[LR](_\d)?$")


def _is_preset(morph: Morph) -> bool:
    """Whether a morph moves joints, not the face."""
    entry = MORPHS.get(morph.key(Side.RIGHT))
    return entry is not None and entry.kind.endswith("skeletal")
