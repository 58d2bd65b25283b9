"""What stands behind `morph`: names, sides, weights, and how far each yields."""

from __future__ import annotations

import math

from azee.lang.fault import Fault, did_you_mean, fault
from azee.lang.native import Occurrence
from azee.lang.values import NumberValue, SideValue, SymbolValue, Value
from azee_grammar import vocabulary
from azee_grammar.source import Span
from azee_solver.constraint import Constraint, Morph

SOFT = "soft"
SOFT_DEG = 40.0
"""How far a joint of a soft morph yields to what is in its way, unless its text says otherwise."""


def morphs(at: Occurrence, values: tuple[Value, ...]) -> tuple[Constraint, ...]:
    """Read the morphs of an application of `morph`, one after the other. Raises: Fault."""
    found: list[Constraint] = []
    i = 0
    while i < len(values):
        name = values[i]
        if not isinstance(name, SymbolValue):
            message = (
                f"the name of a morph, such as `'AU12`, is expected here, not {name.kind.value}"
            )
            raise at.fault("wrong-type", message, "item", i)
        start = i
        i += 1
        side = None
        if i < len(values) and isinstance(given := values[i], SideValue):
            side = given.content
            i += 1
        weight = values[i] if i < len(values) else None
        if not isinstance(weight, NumberValue):
            message = f"the morph `'{name.content}` has no weight"
            raise at.fault("missing-value", message, "item", start)
        i += 1
        bound, i = _yielding(at, values, i)
        if name.content == SOFT:
            message = "`'soft` stands behind the weight of a morph"
            raise at.fault("unknown-morph", message, "item", start)
        if (problem := unknown_morph(name.content, at.span_of("item", start))) is not None:
            raise problem
        entry = vocabulary.morph(name.content)
        assert entry is not None
        if side is not None and not entry.takes_side:
            message = f"the morph `'{name.content}` takes no side"
            raise at.fault("bad-side", message, "item", start + 1)
        if side is None and entry.takes_side and not entry.side_optional:
            raise at.fault(
                "bad-side",
                f"the morph `'{name.content}` lacks its side",
                "item",
                start,
                help=f"write `'{name.content} s {weight.content:g}`: s, w, L or R",
            )
        if bound and "skeletal" not in _kind(name.content):
            message = f"`'{name.content}` moves the face, which yields to nothing"
            raise at.fault("unknown-keyword", message, "item", start, help="leave out `'soft`")
        found.append(Morph(name.content, side, weight.content, bound, origin=at.origin))
    return tuple(found)


def _yielding(at: Occurrence, values: tuple[Value, ...], i: int) -> tuple[float, int]:
    """Read `'soft [DEGREES]` behind a weight: how far a morph yields, radians, and what is next."""
    if i >= len(values) or not (isinstance(v := values[i], SymbolValue) and v.content == SOFT):
        return 0.0, i
    i += 1
    if i >= len(values) or not isinstance(bound := values[i], NumberValue):
        return math.radians(SOFT_DEG), i
    if not 0 <= bound.content <= 180:
        message = "a morph yields by at least 0 and at most 180 degrees"
        raise at.fault("number-range", message, "item", i)
    return math.radians(bound.content), i + 1


def _kind(morph: str) -> str:
    """Return the kind of a morph that AZee has, written with or without its side."""
    entry = vocabulary.MORPHS.get(morph) or vocabulary.MORPHS[f"{morph}_R"]
    return entry.kind


def unknown_morph(name: str, span: Span) -> Fault | None:
    """Return the mistake if AZee has no such morph."""
    if name == SOFT or vocabulary.morph(name) is not None:
        return None
    message = f"AZee has no morph `'{name}`"
    instead = vocabulary.WITHOUT_MORPH.get(name)
    if instead is not None:
        return fault("unknown-morph", message, span, help=instead)
    known = (*vocabulary.morph_names(), *vocabulary.MORPHS)
    return fault(
        "unknown-morph", message, span, label="no such morph", help=did_you_mean(name, known, "'")
    )
