"""Decides which operands of an application share a line in canonical layout."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from azee_grammar.syntax import Application, Expr, Named, OperatorName, RuleName, Symbol

_PAIRED = frozenset({"azop", "let", "apply"})
"""Operators that take `'name value` pairs, as rules do; a last operand without name is a body."""

_FRAMES = frozenset({"azop", "let", "sync"})
"""Operators that always have several lines, however short they are, because that is clearer."""

_SYNC_RULES = {"start/end": 2, "start/dur": 2, "end/dur": 2, "start": 1, "end": 1, "with": 1}
"""Operands of each sync rule, for the layout; azee.lang gives their meaning."""


def is_word(node: Expr | Named) -> bool:
    """Whether a node is written without parentheses around it: a word, a bare head or a call."""
    return not isinstance(node, Application) or node.called or not node.operands


def fits_behind_symbol(node: Expr | Named) -> bool:
    """Whether a node may follow a symbol on its line, in parentheses if it has operands.

    An operator applied to words may. A rule applied to operands gets lines, which are easier to
    read.
    """
    if is_word(node):
        return True
    assert isinstance(node, Application)
    if isinstance(node.head, RuleName) or _operator(node) in _FRAMES:
        return False
    return all(map(is_word, node.operands))


def fits_line(node: Expr | Named) -> bool:
    """Whether the structure of a node allows one line for all of it, if that is not too wide."""
    if is_word(node):
        return True
    assert isinstance(node, Application)
    operands = node.operands
    return _operator(node) not in _FRAMES and all(
        is_word(operand)
        or (i > 0 and isinstance(operands[i - 1], Symbol) and fits_behind_symbol(operand))
        for i, operand in enumerate(operands)
    )


def beside_head(node: Application) -> int:
    """Count the operands that stay on the line of their head while the others get lines.

    These are all except the last, if they are words without symbols and the last has operands of
    its own. Of a `let`, they are the name with its value.
    """
    operands = node.operands
    if _operator(node) == "let":
        return 2 if len(operands) == 3 and isinstance(operands[0], Symbol) else 0
    if _operator(node) in _FRAMES or not operands:
        return 0
    *others, last = operands
    if not isinstance(last, Application) or not last.operands:
        return 0
    if any(isinstance(operand, Symbol) or not is_word(operand) for operand in others):
        return 0
    return len(others)


def rows(node: Application, operands: Sequence[Expr]) -> Iterator[Sequence[Expr]]:
    """Yield the operands of an application in prefix form, those of one line together.

    Only the last of a row may need further lines.
    """
    if _operator(node) == "sync":
        return _sync(operands)
    if isinstance(node.head, RuleName) or _operator(node) in _PAIRED:
        return _pairs(operands)
    return _runs(operands)


def _operator(node: Application) -> str | None:
    return node.head.name if isinstance(node.head, OperatorName) else None


def _pairs(operands: Sequence[Expr]) -> Iterator[Sequence[Expr]]:
    """Join a symbol with the operand after it; return other operands unchanged."""
    at = 0
    while at < len(operands):
        size = 2 if isinstance(operands[at], Symbol) else 1
        yield operands[at : at + size]
        at += size


def _runs(operands: Sequence[Expr]) -> Iterator[Sequence[Expr]]:
    """Join a symbol with the words after it, or with the one application after it."""
    at = 0
    while at < len(operands):
        end = at + 1
        if isinstance(operands[at], Symbol):
            while end < len(operands) and is_word(operands[end]):
                if isinstance(operands[end], Symbol):
                    break
                end += 1
            if end == at + 1 and end < len(operands) and not is_word(operands[end]):
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
