"""Templates: expressions with holes, and the expressions of a text that they match.

Two expressions match if they differ only in notation: `:f 'x :a`, `f(:a)` and `f('x = a())` match
each other. Rules are compared, not their names. So a rule that only applies another rule under
other names matches that rule. Everything else is compared as written, without evaluation: a missing
argument does not match its default. A hole matches any one expression, and if it occurs twice, the
same expression twice.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from azee.lang.application_shape import Shape
from azee.lang.arguments import flattened
from azee.lang.program import Program
from azee.lang.scope import Scope
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.parser import parse_expression
from azee_grammar.source import Source
from azee_grammar.syntax import Application, Definition, Expr, Hole, Number, Utterance


@dataclass(frozen=True, slots=True)
class Match:
    """An expression that a template matches, and the expressions for its holes."""

    expr: Expr
    bindings: Mapping[str, Expr]
    """Expressions by the holes' names, in the order of the template."""


@dataclass(frozen=True)
class Template:
    """An expression in which `?name` stands for any expression."""

    expr: Expr

    @classmethod
    def read(cls, text: str, name: str = "<template>") -> Template:
        """Read a template. Raises: AZeeError: the text is not one expression."""
        expr, diagnostics = parse_expression(Source(name, text), template=True)
        if expr is None:
            raise AZeeError(*diagnostics)
        return cls(expr)

    @cached_property
    def holes(self) -> tuple[str, ...]:
        """Names of the holes, each once, in the order of the text."""
        found: dict[str, None] = {}
        left: list[Expr] = [self.expr]
        while left:
            node = left.pop()
            if isinstance(node, Hole):
                found[node.name] = None
            elif isinstance(node, Application):
                left += reversed(flattened(node))
        return tuple(found)

    def problems(self, program: Program) -> tuple[Diagnostic, ...]:
        """Return the mistakes in the template if it is read as a part of a program.

        The arguments of a rule that the program knows must be right. A rule that it does not know
        is not a mistake.
        """
        return tuple(
            problem
            for node in _expressions(self.expr, program.scope)
            if isinstance(node, Application)
            for problem in Shape.of(node, program.scope).problems
        )

    def search(self, program: Program) -> Iterator[Match]:
        """Yield every match in the utterances and rules of a text, outer matches first.

        The names of rules have the meaning that they have in that text.
        """
        for item in program.file.items:
            expr = None
            if isinstance(item, Utterance):
                expr = item.expr
            elif isinstance(item, Definition):
                expr = item.body
            if expr is None:
                continue
            for node in _expressions(expr, program.scope):
                match = self.match(node, program.scope)
                if match is not None:
                    yield match

    def match(self, expr: Expr, scope: Scope) -> Match | None:
        """Match one expression as a whole; `scope` gives the rules that names mean."""
        found: dict[str, Expr] = {}
        if not _matches(self.expr, expr, scope, found):
            return None
        return Match(expr, {name: found[name] for name in self.holes})


def _matches(template: Expr, expr: Expr, scope: Scope, found: dict[str, Expr]) -> bool:
    """Compare two expressions, part by part, and store the expressions for holes.

    The function is not recursive, so that deep nesting needs no deep stack.
    """
    pairs = [(template, expr)]
    while pairs:
        left, right = pairs.pop()
        if isinstance(left, Hole):
            earlier = found.setdefault(left.name, right)
            if earlier is not right:
                pairs.append((earlier, right))
        elif isinstance(left, Application) and isinstance(right, Application):
            wanted, given = Shape.of(left, scope), Shape.of(right, scope)
            if wanted.head != given.head or wanted.operands.keys() != given.operands.keys():
                return False
            names = reversed(wanted.operands)
            pairs += [(wanted.operands[name], given.operands[name]) for name in names]
        elif isinstance(left, Number) and isinstance(right, Number):
            if left.value != right.value:
                return False
        elif left != right:
            return False
    return True


def _expressions(expr: Expr, scope: Scope) -> Iterator[Expr]:
    """Yield an expression and all its parts in the order of the text.

    The names of a rule's arguments are not expressions.
    """
    left = [expr]
    while left:
        node = left.pop()
        yield node
        if isinstance(node, Application):
            parts = Shape.of(node, scope).operands.values()
            left += sorted(parts, key=lambda part: part.span.start, reverse=True)
