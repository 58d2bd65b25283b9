"""A score with other constraints: the same blocks at the same times."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

from azee.score.score import Group, Key, Score
from azee_solver.constraint import Constraint

Path: TypeAlias = tuple[str, ...]


def rebuilt(
    score: Score, change: Callable[[Path, tuple[Constraint, ...]], tuple[Constraint, ...]],
    path: Path = (),
) -> Score:  # fmt: skip
    """Return the score with the constraints of all its keys changed."""
    if isinstance(score, Key):
        return replace(score, constraints=change(path, score.constraints))
    if isinstance(score, Group):
        blocks = (replace(b, score=rebuilt(b.score, change, (*path, b.name))) for b in score.blocks)
        return replace(score, blocks=tuple(blocks))
    return score
