"""Which operands of an application share a line in canonical form."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from azee_grammar.syntax import Application, Expr, Named, OperatorName, RuleName, Symbol

_PAIRED = frozenset({"azop", "let", "apply"})
"""Operators that take `'name value` pairs, as rules do; a last operand without name is a body."""

_SYNC_RULES = {"start/end": 2, "start/dur": 2, "end/dur": 2, "start": 1, "end": 1, "with": 1}
"""Operands of each sync rule. Layout follows them; what they mean is settled elsewhere."""


def rows(node: Application) -> Iterator[Sequence[Expr]]:
    """Yield the operands of an application in prefix form, those of one line together.

    Only the last of a row may need further lines.
    """
    operands = [operand for operand in node.operands if not isinstance(operand, Named)]
    head = node.head
    if isinstance(head, OperatorName) and head.name == "sync":
        return _sync(operands)
    if isinstance(head, RuleName) or (isinstance(head, OperatorName) and head.name in _PAIRED):
        return _pairs(operands)
    return _runs(operands)


def _pairs(operands: Sequence[Expr]) -> Iterator[Sequence[Expr]]:
    """Join a symbol with the operand behind it; leave others alone."""
    at = 0
    while at < len(operands):
        size = 2 if isinstance(operands[at], Symbol) else 1
        yield operands[at : at + size]
        at += size


def _runs(operands: Sequence[Expr]) -> Iterator[Sequence[Expr]]:
    """Join a symbol with the words behind it, or with the one application behind it."""
    at = 0
    while at < len(operands):
        end = at + 1
        if isinstance(operands[at], Symbol):
            while end < len(operands) and not _needs_lines(operands[end]):
                if isinstance(operands[end], Symbol):
                    break
                end += 1
            if end == at + 1 and end < len(operands) and _needs_lines(operands[end]):
                end += 1
        yield operands[at:end]
        at = end


def _sync(operands: Sequence[Expr]) -> Iterator[Sequence[Expr]]:
    """Join the name of a block with its score, its rule with the operands of the rule."""
    at = 0
    while at < len(operands):
        first = operands[at]
        size = 1
        if isinstance(first, Symbol):
            size = 2 if at + 1 < len(operands) else 1
            if at >= 2 and first.name in _SYNC_RULES:
                size = 1 + _SYNC_RULES[first.name]
        yield operands[at : at + size]
        at += size


def _needs_lines(node: Expr) -> bool:
    return isinstance(node, Application) and not node.called and bool(node.operands)
