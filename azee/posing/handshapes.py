"""Hand shapes by their names: the posture rules that shape one hand as it is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.lang.program import Program
from azee.lang.scope import AmbiguousRule
from azee.lang.values import ConstraintsValue
from azee_grammar.diagnostic import AZeeError
from azee_solver.anatomy import Part, anatomy
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
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side

Array = NDArray[np.float64]

LEAST = 10
"""A shape says where so many joints of the hand are, at least."""
SAME_RAD, FARTHEST_RAD = np.radians(8.0), np.radians(25.0)
"""Shapes so near, in the root mean square of the joints, are nearly the same; and at most."""


@dataclass(frozen=True, slots=True, eq=False)
class ShapeName:
    """A hand shape as AZee writes it. off_rad: root mean square from the hand's joints."""

    text: str
    off_rad: float

    @property
    def cost(self) -> float:
        """How far it is, in units of what an author would call the same."""
        return float((self.off_rad / SAME_RAD) ** 2)


def shape_names(program: Program, evaluator: Evaluator, q: Array, side: Side) -> list[ShapeName]:
    """Return the rules that shape a hand as a posture (V,) has it, the nearest first.

    Args: side: strong or weak.
    """
    found = []
    for text in _shaping_rules(program, side):
        angles = _angles(program, text, evaluator, side)
        if len(angles) < LEAST:
            continue
        members = [*angles]
        limits = evaluator.rig.coordinates
        asked = np.clip([*angles.values()], limits.lower[members], limits.upper[members])
        off = float(np.sqrt(np.mean((q[members] - asked) ** 2)))
        if off <= FARTHEST_RAD:
            found.append(ShapeName(text, off))
    return sorted(found, key=lambda name: name.off_rad)


def _shaping_rules(program: Program, side: Side) -> Iterator[str]:
    """Yield the rules that take a side and can go without other arguments, as postures."""
    for name in program.scope.names():
        try:
            rule = program.scope.find(name)
        except AmbiguousRule:
            continue
        if rule is None or any(mandatory for _, mandatory in rule.parameters):
            continue
        if "side" in (parameter for parameter, _ in rule.parameters):
            given = "" if side is Side.STRONG else f"('side = {side.value})"
            yield f":#{name}{given}"


def _angles(program: Program, text: str, evaluator: Evaluator, side: Side) -> dict[int, float]:
    """Return what a rule asks of the joints of one hand, radians; nothing if of others too."""
    try:
        value = program.value(text, "a hand shape")
    except AZeeError:
        return {}
    if not isinstance(value, ConstraintsValue):
        return {}
    hand = anatomy(evaluator.rig.chain, evaluator.rig.coordinates).of(Part.HAND)
    end = f"_{side.bound(evaluator.binding.dominant).value}_"
    names = evaluator.rig.coordinates.names
    if not all(_is_of_hand(c, evaluator) for c in value.content):
        return {}
    angles = evaluator.binding.presets(value.content)
    own = {v: a for v, a in angles.items() if v in hand and end in names[v]}
    return own if len(own) == len(angles) else {}


def _is_of_hand(constraint: Constraint, evaluator: Evaluator) -> bool:
    """Whether a constraint shapes a hand and does not move it: the palm is where it is."""
    match constraint:
        case Morph():
            return evaluator.binding.has(constraint) and evaluator.binding.is_skeletal(constraint)
        case Place(site=site):
            return not evaluator.binding.site(site).bone.startswith(("palm", "f_arm", "arm"))
        case Orient(bone=bone):
            return bone.name in ("thumb", "index", "middle", "ring", "little")
        case Look() | LookAt() | Rotate() | Trill() | Transpath():
            return False
