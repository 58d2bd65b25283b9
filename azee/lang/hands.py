"""Scores of one arm, as far as names tell without a body."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from azee.score.articulators import arm_of
from azee.score.score import Group, Key, Score, leaves
from azee_solver.constraint import Constraint
from azee_solver.geometry import Side


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
