"""Accents: what keeps its own clock while the time around it bends.

A head shake, a nod or a blink has a rhythm of its own: it does not become slower because a hand has
a long way to go meanwhile.
"""

from __future__ import annotations

from azee.motion.tasks.limbs import TRUNK, limb_of_constraint
from azee.score.score import Group, Hold, Key, Score, leaves
from azee_solver.binding import Binding
from azee_solver.constraint import Constraint, Morph, Rotate, Trill

ACCENTED = frozenset((TRUNK, "head", "face"))
"""What an accent moves."""


def is_accent(score: Score, binding: Binding) -> bool:
    """Whether a score is a group that only turns head and trunk or moves the face.

    A single block is none: it lasts as long as what it accompanies, as raised brows do. Neither is
    a group with a hold, which is about keeping something. What the body lacks does not count.
    """
    if not isinstance(score, Group):
        return False
    found = False
    for leaf in leaves(score):
        if isinstance(leaf.score, Hold):
            return False
        for constraint in leaf.score.constraints if isinstance(leaf.score, Key) else ():
            if binding.has(constraint):
                if not _is_of_accents(constraint, binding):
                    return False
                found = True
    return found


def _is_of_accents(constraint: Constraint, binding: Binding) -> bool:
    if not isinstance(constraint, Rotate | Trill | Morph):
        return False
    return limb_of_constraint(constraint, binding) in ACCENTED
