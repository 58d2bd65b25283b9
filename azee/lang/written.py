"""The applications of rules that a text writes, each with its place in the nesting."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from azee.lang.application_shape import Shape
from azee.lang.rule import Rule
from azee.lang.scope import Scope
from azee_grammar.source import Span
from azee_grammar.syntax import Application, Expr, RuleName


@dataclass(frozen=True, slots=True, eq=False)
class Written:
    """A rule that a text applies or hands over.

    name: that of the rule meant in the end, where the one written only forwards to it under
    another name; of an unknown rule the name as written. slot: the argument of `around` that it
    stands in, also where a list or an operator lies between. depth: how many applications are
    around it.
    """

    name: str
    rule: Rule | None
    span: Span
    around: Written | None
    slot: str | None
    depth: int
    slots: tuple[str, ...]
    """The arguments that it gives, by the names of `rule`."""


def written_in(expr: Expr, scope: Scope) -> Iterator[Written]:
    """Yield the applications of rules in an expression, outer before inner, as they are written.

    A rule that is handed over with `.name` counts, as does one that `scope` does not know.
    Nothing is evaluated.
    """
    left: list[tuple[Expr, Written | None, str | None]] = [(expr, None, None)]
    while left:
        node, around, slot = left.pop()
        if not isinstance(node, Application):
            continue
        shape = Shape.of(node, scope)
        found = _written(node, shape, around, slot)
        if found is not None:
            yield found
        if found is None:
            inside = [(operand, around, slot) for operand in shape.operands.values()]
        else:
            names = found.slots or (None,) * len(shape.operands)
            operands = shape.operands.values()
            inside = [(part, found, name) for part, name in zip(operands, names, strict=True)]
        left += sorted(inside, key=lambda part: part[0].span.start, reverse=True)


def _written(
    node: Application, shape: Shape, around: Written | None, slot: str | None
) -> Written | None:
    depth = 0 if around is None else around.depth + 1
    slots = tuple(shape.operands)
    if shape.head[0] == "rule":
        meant = shape.head[1]
        rule = meant if isinstance(meant, Rule) else None
        name = rule.name if rule else str(meant)
    elif isinstance(node.head, RuleName):  # of a known rule, with wrong arguments
        rule, name, slots = None, node.head.name, ()
    else:
        return None
    return Written(name, rule, node.span, around, slot, depth, slots)
