"""Special forms: operators whose operands are not simply evaluated in order."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias

from azee.lang.code import Code
from azee.lang.resolution import Steps, Visible
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.syntax import Application, Expr

if TYPE_CHECKING:
    from azee.lang.resolve import Resolver

Resolve: TypeAlias = "Callable[[Resolver, Application, tuple[Expr, ...], Visible], Steps[Code]]"
"""Makes the steps of an application's code from its operands and the names visible to it."""


def exactly(
    count: int, resolver: Resolver, expr: Application, operands: tuple[Expr, ...], pattern: str
) -> bool:
    """Report `missing-argument` or `too-many-arguments` unless there are `count` operands."""
    if len(operands) == count:
        return True
    hint = f"it is written `{pattern}`"
    name = pattern.partition(" ")[0]
    message = f"`{name}` takes {count} operands, and here are {len(operands)}"
    if len(operands) < count:
        resolver.report(Diagnostic("missing-argument", message, expr.head.span, help=hint))
    else:
        span = operands[count].span
        resolver.report(Diagnostic("too-many-arguments", message, span, help=hint))
    return False
