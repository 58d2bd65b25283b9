"""Decides whether a text typed at a prompt is complete, or whether more must or may follow."""

from __future__ import annotations

from enum import Enum

from azee.assist.knowledge import Knowledge
from azee.assist.lines import Line, read_lines
from azee.lang.registry import NATIVES
from azee.lang.resolve import Resolving
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.parser import parse
from azee_grammar.source import Source
from azee_grammar.syntax import Utterance
from azee_grammar.token import HEADS

_MISSING = frozenset({"missing-argument", "missing-value"})


class Completeness(Enum):
    """What a prompt does at the end of a line."""

    WHOLE = "whole"
    """Nothing can follow: the input is evaluated."""
    OPEN = "open"
    """It may be complete, but deeper lines may follow: an empty line ends it."""
    LACKING = "lacking"
    """Something is missing: a parenthesis, a body, operands."""


def completeness(text: str, knowledge: Knowledge) -> Completeness:
    """Judge a text by its last item.

    A single line is complete unless its head lacks mandatory operands. A line with another kind of
    mistake is complete too, since more lines would not correct it.
    """
    lines = read_lines(text).lines
    if not lines:
        return Completeness.WHOLE
    if _open(lines):
        return Completeness.LACKING
    item = _last_item(lines)
    if item[0].tokens[0].kind == "DEF" and len(item) == 1:
        return Completeness.LACKING
    if _logical(item) > 1:
        return Completeness.OPEN
    return Completeness.LACKING if _lacks_operands(text, knowledge) else Completeness.WHOLE


def unclosed(text: str) -> bool:
    """Whether a text ends inside parentheses."""
    return _open(read_lines(text).lines)


def wants_deeper(line: str, knowledge: Knowledge) -> bool:
    """Whether the operands of a line's head are expected on deeper lines.

    This is so if some are missing, or if an operator that takes any number has none yet.
    """
    lines = read_lines(line.strip()).lines
    if not lines or _open(lines):
        return False
    tokens = lines[0].tokens
    head = tokens[-1] if tokens[0].kind == "SYMBOL" else tokens[0]
    if head.kind not in HEADS:
        return head.kind == "DEF"
    if len(tokens) == 1 or tokens[0].kind == "SYMBOL":
        native = NATIVES.get(head.text) if head.kind == "OPERATOR" else None
        if native is not None and (native.operands or native.pattern):
            return True
    return completeness(line.strip()[head.start :], knowledge) is Completeness.LACKING


def _open(lines: tuple[Line, ...]) -> bool:
    """Whether a parenthesis is still open. `def` and `use` at the margin close all of them."""
    depth = 0
    for line in lines:
        if not line.prefix and line.tokens[0].kind in ("DEF", "USE"):
            depth = 0
        for token in line.tokens:
            if token.kind in ("_OPEN", "_CALL"):
                depth += 1
            elif token.kind == "CLOSE":
                depth = max(0, depth - 1)
    return depth > 0


def _last_item(lines: tuple[Line, ...]) -> tuple[Line, ...]:
    """Return the lines from the last line at the margin on that is outside of parentheses."""
    depth = first = 0
    margin = lines[0].prefix
    for number, line in enumerate(lines):
        if depth == 0 and line.prefix == margin:
            first = number
        depth += _balance(line)
    return lines[first:]


def _logical(lines: tuple[Line, ...]) -> int:
    """Count lines; lines that continue inside parentheses are one."""
    count = depth = 0
    for line in lines:
        count += depth == 0
        depth += _balance(line)
    return count


def _balance(line: Line) -> int:
    kinds = [token.kind for token in line.tokens]
    return kinds.count("_OPEN") + kinds.count("_CALL") - kinds.count("CLOSE")


def _lacks_operands(text: str, knowledge: Knowledge) -> bool:
    """Whether it is the head of the last utterance itself that lacks something."""
    parsed = parse(Source("", text))
    items = parsed.file.items
    if parsed.diagnostics or not items or not isinstance(last := items[-1], Utterance):
        return False
    found: list[Diagnostic] = []
    Resolving().resolver(knowledge.scope, None, found).resolve(last.expr)
    return any(d.code in _MISSING and d.span and d.span.start == last.span.start for d in found)
