"""Which arm a constraint is about, as far as its names tell without a body."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from azee.score.score import Group, Key, Score, leaves
from azee_grammar import vocabulary
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

_ARM = re.compile(r"(clav|arm|f_arm|palm|thumb|index|middle|ring|little)_[LR](_\d)?", re.ASCII)
_SUFFIX = re.compile(r".+_([LR])", re.ASCII)


def arm_of(constraint: Constraint) -> Side | None:
    """Return the side of the arm or hand that a constraint is about; None for all else."""
    match constraint:
        case Place(site=site) | Transpath(site=site):
            return site.side if _is_arm(vocabulary.SITES[site.key(Side.RIGHT)].bone) else None
        case Orient(bone=bone) | Rotate(bone=bone) | Trill(bone=bone):
            return bone.side if _is_arm(bone.key(Side.RIGHT)) else None
        case Morph(name=name, side=side):
            if not vocabulary.MORPHS[constraint.key(Side.RIGHT)].kind.endswith("skeletal"):
                return None
            found = _SUFFIX.fullmatch(name)
            return side or (Side(found[1]) if found else None)
        case Look() | LookAt():
            return None


def kept(score: Score, keeps: Callable[[Constraint], bool]) -> Score:
    """Return the score with only some of its constraints; times stay."""
    if isinstance(score, Key):
        return replace(score, constraints=tuple(c for c in score.constraints if keeps(c)))
    if isinstance(score, Group):
        blocks = tuple(replace(b, score=kept(b.score, keeps)) for b in score.blocks)
        return replace(score, blocks=blocks)
    return score


def names_arm(score: Score, side: Side) -> bool:
    """Whether a score says anything about an arm."""
    keys = (leaf.score for leaf in leaves(score) if isinstance(leaf.score, Key))
    return any(arm_of(constraint) is side for key in keys for constraint in key.constraints)


def _is_arm(bone: str) -> bool:
    return _ARM.fullmatch(bone) is not None
