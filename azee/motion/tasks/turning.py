"""Orientations on their way: `turning` gets its ends from the orientations before and after."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial

from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.requirement import Requirement
from azee.score.rebuilt import rebuilt
from azee.score.score import Score
from azee_solver.constraint import BoneAxis, Constraint, Orient, Relation
from azee_solver.geometry import Side, Swing

LONGEST_WAIT_S = Fraction(3, 5)
"""Orientations farther away than this in time are not the ends of a turn, as with paths."""


def with_turns(score: Score, dominant: Side) -> Score:
    """Return a score in which every turn knows from where to where it leads.

    A turn without an orientation of the same axis before or after it asks for nothing.
    """
    required = flatten(score).requirements
    turns = [r for r in required if is_turn(r.constraint)]
    if not turns:
        return score
    known = [r for r in required if _is_end(r.constraint)]
    ways: dict[tuple[tuple[str, ...], Constraint], Orient | None] = {}
    for turn in turns:
        own = _axis(turn.constraint, dominant)
        same = [r for r in known if _axis(r.constraint, dominant) == own]
        ways[turn.path, turn.constraint] = _way(turn, same)
    ways = {key: _together(way, key[0], ways) for key, way in ways.items()}
    return rebuilt(score, partial(_with_ways, ways))


def is_turn(constraint: Constraint) -> bool:
    """Whether a constraint is an orientation whose ends are those around it."""
    return isinstance(constraint, Orient) and constraint.vector == Swing(None, None)


def _is_end(constraint: Constraint) -> bool:
    return (
        isinstance(constraint, Orient)
        and constraint.relation is Relation.ALONG
        and not is_turn(constraint)
    )


def _axis(constraint: Constraint, dominant: Side) -> tuple[BoneAxis, str]:
    assert isinstance(constraint, Orient)
    return constraint.axis, constraint.bone.key(dominant)


def _way(turn: Requirement, ends: Iterable[Requirement]) -> Orient | None:
    """Return the swing between the nearest orientations before and after, with their wider bound.

    None where there is none on one side.
    """
    own = turn.interval
    earlier, later = [], []
    for end in ends:
        span = end.interval
        if span.start <= own.start and own.start - LONGEST_WAIT_S <= span.end < own.end:
            earlier.append(end)
        if span.end >= own.end and own.start < span.start <= own.end + LONGEST_WAIT_S:
            later.append(end)
    before = max(earlier, key=lambda r: r.interval.end, default=None)
    after = min(later, key=lambda r: r.interval.start, default=None)
    if before is None or after is None:
        return None
    first, last, way = before.constraint, after.constraint, turn.constraint
    assert isinstance(first, Orient)
    assert isinstance(last, Orient)
    assert isinstance(way, Orient)
    bound = max(first.within_rad, last.within_rad)
    return replace(way, vector=Swing(first.vector, last.vector), within_rad=bound)


def _together(
    way: Orient | None,
    path: tuple[str, ...],
    ways: Mapping[tuple[tuple[str, ...], Constraint], Orient | None],
) -> Orient | None:
    """Return a way that goes along with that of the other axis of its bone, if both turn.

    Each on its own shorter arc, they would not stay square: between them the hand would have to
    fold.
    """
    if way is None:
        return None
    for (other_path, _), other in ways.items():
        if other is None or other_path != path or other.axis is way.axis or other.bone != way.bone:
            continue
        assert isinstance(way.vector, Swing)
        assert isinstance(other.vector, Swing)
        return replace(way, vector=replace(way.vector, beside=other.vector))
    return way


def _with_ways(
    ways: Mapping[tuple[tuple[str, ...], Constraint], Orient | None],
    path: tuple[str, ...],
    found: tuple[Constraint, ...],
) -> tuple[Constraint, ...]:
    """Return the constraints of a key, turns with their ways; those without one are left out."""
    known = (ways[path, c] if is_turn(c) else c for c in found)
    return tuple(c for c in known if c is not None)
