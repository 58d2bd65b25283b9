"""Shows values in lines for people, each kind in its own way."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass

from azee.lang.procedure import Applicable
from azee.lang.values import (
    BoneValue,
    BooleanValue,
    ConstraintsValue,
    ListValue,
    NumberValue,
    OperatorValue,
    PathValue,
    PointValue,
    ScoreValue,
    SideValue,
    SiteValue,
    SymbolValue,
    TextValue,
    Value,
    VectorValue,
)
from azee.repl.diagram import diagram
from azee.repl.ink import Ink, Line
from azee.score.score import leaves
from azee.wording import counted
from azee_solver.geometry import Bone, NamedPoint, Side, Site
from azee_solver.notation import (
    constraint_text,
    part_text,
    path_text,
    point_text,
    vector_text,
)

MOST_LINES = 40


def value_lines(value: Value, columns: int, *, colour: bool) -> Iterator[Line]:
    """Show a value: a score as a diagram, geometry with the parts of the body it depends on."""
    match value:
        case ScoreValue(content=score):
            yield from diagram(score, columns, colour=colour)
            count = sum(1 for _ in leaves(score))
            length = f"{float(score.duration):.4g} s"
            yield ((Ink.FAINT, f"a score of {length}, {counted(count, 'block')}"),)
        case ConstraintsValue(content=constraints):
            for constraint in constraints[:MOST_LINES]:
                yield ((Ink.PLAIN, constraint_text(constraint)),)
            yield from _more(len(constraints))
            yield ((Ink.FAINT, counted(len(constraints), "constraint")),)
        case VectorValue() | PointValue() | PathValue():
            yield ((Ink.PLAIN, short(value)), (Ink.FAINT, f"  {value.kind.value}"))
            yield from _dependence(value.content)
        case OperatorValue(content=operator):
            yield from _operator(operator)
        case ListValue(content=values):
            yield ((Ink.FAINT, f"a list of {counted(len(values), 'value')}"),)
            for i, element in enumerate(values[:MOST_LINES], 1):
                kind = (Ink.FAINT, f"  {element.kind.value}")
                yield ((Ink.FAINT, f"{i:>3}  "), (Ink.PLAIN, short(element)), kind)
            yield from _more(len(values))
        case (
            NumberValue()
            | SymbolValue()
            | TextValue()
            | SideValue()
            | BooleanValue()
            | BoneValue()
            | SiteValue()
        ):
            yield ((Ink.PLAIN, short(value)), (Ink.FAINT, f"  {value.kind.value}"))


def short(value: Value) -> str:
    """Return a value on one line, in AZee's notation where possible."""
    match value:
        case NumberValue(content=number):
            return f"{number:.15g}"
        case SymbolValue(content=symbol):
            return f"'{symbol}"
        case TextValue(content=text):
            return f'"{text}"'
        case SideValue(content=side):
            return side.value
        case BooleanValue(content=yes):
            return "yes" if yes else "no"
        case BoneValue(content=bone):
            return part_text(bone)
        case SiteValue(content=site):
            return part_text(site)
        case VectorValue(content=vector):
            return vector_text(vector)
        case PointValue(content=point):
            return point_text(point)
        case PathValue(content=path):
            return path_text(path)
        case ListValue(content=values):
            return f"list({', '.join(map(short, values[:4]))}{', …' if len(values) > 4 else ''})"
        case ConstraintsValue(content=constraints):
            if len(constraints) == 1:
                return constraint_text(constraints[0])
            return counted(len(constraints), "constraint")
        case ScoreValue(content=score):
            name = f"{score.calls[0].title}, " if score.calls else ""
            return f"{name}{float(score.duration):.4g} s"
        case OperatorValue(content=operator):
            return operator.title.strip("`").replace(":", ".", 1)


def _operator(operator: Applicable) -> Iterator[Line]:
    rule = operator.procedure.rule
    title = f".{rule}" if rule else "azop"
    yield ((Ink.NAME, title), (Ink.FAINT, "  an operator"))
    for name, value in operator.bound.items():
        yield ((Ink.PLAIN, f"  '{name}  {short(value)}"),)
    for parameter in operator.open_parameters:
        open_ = "open" if parameter.default is None else "open, has a default"
        yield ((Ink.PLAIN, f"  '{parameter.name}"), (Ink.FAINT, f"  {open_}"))
    if not operator.open_parameters:
        yield ((Ink.FAINT, "  nothing is open: `apply` gives its result"),)


def _dependence(content: object) -> Iterator[Line]:
    """Describe the parts of the body whose posture determines it."""
    parts = dict.fromkeys(_parts(content))
    if not parts:
        yield ((Ink.FAINT, "depends on nothing: the same in every posture"),)
        return
    words = [part_text(part) for part in parts if isinstance(part, Bone | Site)]
    if words:
        yield ((Ink.FAINT, f"depends on {', '.join(words)}: known once the body stands"),)
    if any(isinstance(part, NamedPoint) for part in parts):
        yield ((Ink.FAINT, "depends on the signer's size and place"),)
    if any(part in (Side.STRONG, Side.WEAK) for part in parts):
        yield ((Ink.FAINT, "depends on which hand is the strong one"),)


def _parts(content: object) -> Iterator[Bone | Site | NamedPoint | Side]:
    """Yield the bones, sites, named places and sides in geometry."""
    if isinstance(content, Bone | Site):
        yield content
        if content.side is not None:
            yield content.side
    elif isinstance(content, NamedPoint | Side):
        yield content
    elif isinstance(content, tuple):
        for part in content:
            yield from _parts(part)
    elif is_dataclass(content) and not isinstance(content, type):
        for field in fields(content):
            yield from _parts(getattr(content, field.name))


def _more(count: int) -> Iterator[Line]:
    if count > MOST_LINES:
        yield ((Ink.FAINT, f"… {count - MOST_LINES} more"),)
