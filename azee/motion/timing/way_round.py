"""Which way round a hand turns: the one that its joints lead from one posture to the next.

A turn by nearly half a circle goes over the thumb or over the little finger, and most often a
forearm can do one of them only. From one orientation to the other it is not seen which; from one
posture to the other it is.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.key_posture import KeyPosture, PostureSolver
from azee.motion.tasks.key_selection import KeySelection
from azee.motion.tasks.requirement import Requirement
from azee.motion.timing.first_postures import first_postures
from azee.score.rebuilt import rebuilt
from azee.score.score import Score
from azee_rig.chain import Frames
from azee_solver import kinematics
from azee_solver.constraint import Constraint, Orient
from azee_solver.evaluate import Evaluator, angle
from azee_solver.geometry import Swing

Array = NDArray[np.float64]
_Path: TypeAlias = tuple[str, ...]

LEAST_RAD = math.radians(100.0)
"""Smaller turns go the shorter way."""
NEARER_RAD = math.radians(20.0)
"""By how much the longer way is nearer to the joints' own, half-way, where it is taken."""


def turning_as_joints_do(
    score: Score, evaluator: Evaluator, selection: KeySelection, solver: PostureSolver, rest: Array
) -> Score:
    """Return a score in which bones turn by the longer way where their joints lead there.

    Args: solver: should remember its answers. rest: (V,) the posture of a body that nothing has
        moved yet.
    """
    frames = kinematics.frames(evaluator.rig.chain, rest)
    wide = [r for r in flatten(score).requirements if _turn_rad(r, evaluator, frames) > LEAST_RAD]
    if not wide:
        return score
    postures = first_postures(score, evaluator, selection, solver, rest)
    longer = {(r.path, r.constraint) for r in wide if _leads_round(r, postures, evaluator)}
    return rebuilt(score, partial(_with_longer, longer)) if longer else score


def _turn_rad(required: Requirement, evaluator: Evaluator, frames: Frames) -> float:
    """Return by how much an axis and the one beside it turn at most; 0 for one that is alone."""
    turns = (float(angle(*_ends(s, evaluator, frames))) for s in _pair(required))
    return max(turns, default=0.0)


def _pair(required: Requirement) -> Iterator[Swing]:
    constraint = required.constraint
    if isinstance(constraint, Orient) and isinstance(constraint.vector, Swing):
        swing = constraint.vector
        if swing.beside is not None:
            yield from (swing, swing.beside)


def _ends(swing: Swing, evaluator: Evaluator, frames: Frames) -> tuple[Array, Array]:
    first, last = (evaluator.vector(replace(swing, beside=None), frames, t) for t in (0.0, 1.0))
    return first, last


def _leads_round(
    required: Requirement, postures: tuple[KeyPosture, ...], evaluator: Evaluator
) -> bool:
    """Whether half-way between two postures a bone is nearer to the longer way than the shorter."""
    turn, span = required.constraint, required.interval
    assert isinstance(turn, Orient)
    assert isinstance(turn.vector, Swing)
    before = [p for p in postures if p.time <= span.start]
    after = [p for p in postures if p.time >= span.end]
    if not before or not after:
        return False
    middle = (before[-1].coordinates + after[0].coordinates) / 2.0
    frames = kinematics.frames(evaluator.rig.chain, middle)
    now = evaluator.axis(turn.bone, turn.axis, frames)
    shorter, longer = (
        float(angle(now, evaluator.vector(replace(turn.vector, longer=way), frames, 0.5)))
        for way in (False, True)
    )
    return longer < shorter - NEARER_RAD


def _with_longer(
    longer: set[tuple[_Path, Constraint]], path: _Path, found: tuple[Constraint, ...]
) -> tuple[Constraint, ...]:
    """Return the constraints of a key; if one axis of a bone goes the longer way, both do."""
    bones = {c.bone for c in found if isinstance(c, Orient) and (path, c) in longer}

    def changed(constraint: Constraint) -> Constraint:
        if isinstance(constraint, Orient) and constraint.bone in bones:
            swing = constraint.vector
            if isinstance(swing, Swing) and swing.beside is not None:
                return replace(constraint, vector=replace(swing, longer=True))
        return constraint

    return tuple(map(changed, found))
