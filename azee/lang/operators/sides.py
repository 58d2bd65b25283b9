"""Sides of the body: the other one, the dominant one, the mirror image."""

from __future__ import annotations

from azee.lang import reflection
from azee.lang.conflict import orient_conflict
from azee.lang.machine import Machine
from azee.lang.native import Group, Native, Occurrence, Operand
from azee.lang.reflection import NoMirrorImage
from azee.lang.values import ConstraintsValue, Kind, ScoreValue, Value
from azee_solver.geometry import Side

_SIDE = Operand("side", "s, w, L or R", (Kind.SIDE,))
_CONTENT = Operand("content", "a score or constraints", (Kind.SCORE, Kind.CONSTRAINTS), raw=True)


def _opposite(at: Occurrence, side: Side) -> Side:
    return side.opposite


def _mirror(at: Occurrence, machine: Machine, content: Value) -> Value:
    machine.spend(content.size, at.span)
    try:
        return _changed(content, reflection.MIRROR)
    except NoMirrorImage as problem:
        raise at.fault("unknown-morph", str(problem), "content") from None


def _with_dominant(at: Occurrence, machine: Machine, side: Side, content: Value) -> Value:
    machine.spend(content.size, at.span)
    changed = _changed(content, reflection.with_dominant(side))
    if isinstance(changed, ConstraintsValue):
        conflict = orient_conflict(changed.content)
        if conflict is not None:
            raise at.fault("orient-conflict", conflict[0], "content")
    return changed


def _changed(content: Value, change: reflection.Change) -> Value:
    if isinstance(content, ScoreValue):
        return ScoreValue(change.score(content.content), content.size, content.depth + 1)
    assert isinstance(content, ConstraintsValue)
    constraints = tuple(change.constraint(c) for c in content.content)
    return ConstraintsValue(constraints, content.size, content.depth + 1)


OPERATORS = (
    Native(
        "opposite",
        Group.LANGUAGE,
        "The other side: weak for strong, left for right.",
        (_SIDE,),
        result=Kind.SIDE,
        function=_opposite,
        example="opposite s",
    ),
    Native(
        "mirror",
        Group.LANGUAGE,
        "The mirror image of a score or of constraints: sides, vectors and places change sides, "
        "strong and weak included.",
        (_CONTENT,),
        function=_mirror,
        uses_machine=True,
        whole=True,
        example="mirror (key .2 (place @I_TIP(s) ^Rssp))",
    ),
    Native(
        "with-dominant",
        Group.LANGUAGE,
        "The same with another hand as the dominant one: in it, s means that side and w the other.",
        (_SIDE, _CONTENT),
        function=_with_dominant,
        uses_machine=True,
        whole=True,
        example="with-dominant L (key .2 (place @I_TIP(s) ^Rssp))",
    ),
)
