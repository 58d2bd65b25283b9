"""Templates: expressions with holes, and the expressions of a text that they match.

Two expressions match where they are the same but for notation: `:f 'x :a`, `f(:a)` and
`f('x = a())` are one. Rules are compared, not their names, so that a rule that only forwards to
another under other names stands for that other. Everything else is compared as it is written,
unevaluated: an argument that is left out does not match its default. A hole matches any one
expression, and where it is used twice, the same one twice.
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
    """An expression that a template matches, and what its holes stand for there."""

    expr: Expr
    bindings: Mapping[str, Expr]
    """By the holes' names, in the order in which the template has them."""


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
        """Return what is wrong with the template where it is read as a part of a program.

        The arguments of a rule that the program knows must be right; a rule that it does not
        know is no mistake.
        """
        return tuple(
            problem
            for node in _expressions(self.expr, program.scope)
            if isinstance(node, Application)
            for problem in Shape.of(node, program.scope).problems
        )

    def search(self, program: Program) -> Iterator[Match]:
        """Yield every match in a text, in its utterances and rules, outer before inner.

        The names of rules mean what they mean in that text.
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
        """Match one expression as a whole; `scope` says which rules names mean."""
        found: dict[str, Expr] = {}
        if not _matches(self.expr, expr, scope, found):
            return None
        return Match(expr, {name: found[name] for name in self.holes})


def _matches(template: Expr, expr: Expr, scope: Scope, found: dict[str, Expr]) -> bool:
    """Compare two expressions, part by part; fills in what holes stand for.

    Not recursive, so that no depth of nesting asks for a deep stack.
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

    The names of a rule's arguments are no expressions.
    """
    left = [expr]
    while left:
        node = left.pop()
        yield node
        if isinstance(node, Application):
            parts = Shape.of(node, scope).operands.values()
            left += sorted(parts, key=lambda part: part.span.start, reverse=True)
