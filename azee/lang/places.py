"""Places of a discourse: points in space that a text names once, for all its expressions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from azee.lang.arguments import flattened
from azee.lang.fault import Fault, fault
from azee.lang.machine import Machine
from azee.lang.values import PointValue, SiteValue
from azee_grammar.diagnostic import Diagnostic, Related
from azee_grammar.source import Span
from azee_grammar.syntax import Application, Expr, File, Item, OperatorName, Symbol, Utterance

if TYPE_CHECKING:
    from azee.lang.resolve import Resolving
    from azee.lang.scope import Scope

PATTERN = "places 'NAME POINT …"


@dataclass(frozen=True, slots=True)
class NamedPlace:
    """A point that the text calls `^name`, and where it says so; None after a mistake."""

    value: PointValue | SiteValue | None
    name_span: Span


def declares_places(item: Item) -> bool:
    """Whether an item of a file is a `places` line."""
    if not isinstance(item, Utterance) or not isinstance(item.expr, Application):
        return False
    head = item.expr.head
    return isinstance(head, OperatorName) and head.name == "places"


def utterances(file: File) -> Iterator[Utterance]:
    """Yield the utterances of a file, without its `places` lines."""
    for item in file.items:
        if isinstance(item, Utterance) and not declares_places(item):
            yield item


def declare_places(file: File, scope: Scope, resolving: Resolving) -> list[Diagnostic]:
    """Put the places that a file names into its scope; return the mistakes.

    A place may be described by those before it. The rules of the file must be in scope already.
    """
    problems: list[Diagnostic] = []
    for item in file.items:
        if not declares_places(item):
            continue
        assert isinstance(item, Utterance)
        assert isinstance(item.expr, Application)
        for name, point in _pairs(item.expr, problems):
            other = scope.places.get(name.name)
            if other is not None:
                message = f"there are two places `'{name.name}`"
                first = Related("the first is named", other.name_span)
                problem = Diagnostic("duplicate-argument", message, name.span, related=(first,))
                problems.append(problem)
                continue
            value = _evaluated(name, point, scope, resolving, problems)
            scope.places[name.name] = NamedPlace(value, name.span)
    return problems


def _pairs(line: Application, problems: list[Diagnostic]) -> Iterator[tuple[Symbol, Expr]]:
    operands = flattened(line)
    hint = f"it is written `{PATTERN}`"
    if not operands:
        message = "`places` lacks its names and points"
        problems.append(Diagnostic("missing-argument", message, line.head.span, help=hint))
    for i in range(0, len(operands), 2):
        name = operands[i]
        if not isinstance(name, Symbol):
            message = "the name of a place, such as `'here`, is expected here"
            problems.append(Diagnostic("expected-argument-name", message, name.span, help=hint))
            return
        if i + 1 == len(operands):
            message = f"`'{name.name}` has no point"
            problems.append(Diagnostic("missing-value", message, name.span, help=hint))
            return
        yield name, operands[i + 1]


def _evaluated(
    name: Symbol, point: Expr, scope: Scope, resolving: Resolving, problems: list[Diagnostic]
) -> PointValue | SiteValue | None:
    code = resolving.resolver(scope, None, problems).resolve(point)
    try:
        value = code.evaluate(Machine(resolving.machine.limits, scope.libraries), {})
        if not isinstance(value, PointValue | SiteValue):
            message = f"the place `'{name.name}` wants a point, not {value.kind.value}"
            label = f"this is {value.kind.value}"
            raise fault("wrong-type", message, point.span, label=label)
    except Fault as problem:
        problems += problem.diagnostics
        return None
    return value
