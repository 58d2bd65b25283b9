"""What the utterances of a text say to each other: places that are referred to.

A rule whose definition has the entry `'refers "pt"` points back: its argument `'pt` is a place
where something was put before. Every rule that is given a place as an argument puts something
there.
"""

from __future__ import annotations

from collections.abc import Iterator

from azee.lang.application_shape import Shape
from azee.lang.code import Constant
from azee.lang.places import utterances
from azee.lang.resolve import Resolving
from azee.lang.rule import Rule
from azee.lang.scope import Scope
from azee.lang.values import PointValue
from azee_grammar.diagnostic import Diagnostic, Severity
from azee_grammar.source import Span
from azee_grammar.syntax import Application, Expr, File, Parameter
from azee_solver.geometry import NamedPoint, Point, SigningSpace

REFERS = "refers"
"""The entry of a rule's definition with the names of the arguments that refer back."""
_ADDRESSEE = NamedPoint(SigningSpace.ADDRESSEE)


def unintroduced_places(file: File, scope: Scope, resolving: Resolving) -> Iterator[Diagnostic]:
    """Yield `unintroduced-place` for places that are referred to and were not given before.

    Only expressions in utterances count, in the order of the text.
    """
    introduced: set[Point] = {_ADDRESSEE}
    for rule, argument, value in _arguments(file, scope):
        point = _point(value, scope, resolving)
        if point is None:
            continue
        refers = rule is not None and argument in (rule.entry(REFERS) or "").split()
        if refers and point not in introduced:
            assert rule is not None
            yield _warning(rule, value.span)
        introduced.add(point)


def _arguments(file: File, scope: Scope) -> list[tuple[Rule | None, str, Expr]]:
    """Return all arguments of rules in a text's utterances, each with its rule and its name."""
    found: list[tuple[Rule | None, str, Expr]] = []
    left: list[Expr] = [item.expr for item in utterances(file)]
    while left:
        node = left.pop()
        if not isinstance(node, Application):
            continue
        shape = Shape.of(node, scope)
        left += shape.operands.values()
        if shape.head[0] == "rule":
            rule = shape.head[1] if isinstance(shape.head[1], Rule) else None
            found += ((rule, name, value) for name, value in shape.operands.items())
    return sorted(found, key=lambda argument: argument[2].span.start)


def _point(expr: Expr, scope: Scope, resolving: Resolving) -> Point | None:
    """Return the point that an argument is, if it is one of literals and names."""
    if not isinstance(expr, Parameter | Application):
        return None
    code = resolving.resolver(scope, None, []).resolve(expr)
    if isinstance(code, Constant) and isinstance(code.value, PointValue):
        return code.value.content
    return None


def _warning(rule: Rule, span: Span) -> Diagnostic:
    return Diagnostic(
        "unintroduced-place",
        f"{rule.title} refers to `{span.text}`, and nothing was put there before",
        span,
        help="a rule that is given this place before introduces it, such as `:about-ref`",
        severity=Severity.WARNING,
    )
