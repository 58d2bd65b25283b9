"""Pieces of AZee that an edit brings in: an expression, rows of operands, items."""

from __future__ import annotations

from dataclasses import dataclass

from azee.blocks.fault import cannot_edit
from azee.blocks.tree import Operand
from azee_grammar.diagnostic import AZeeError
from azee_grammar.parser import Parsed, parse
from azee_grammar.source import Source
from azee_grammar.syntax import Application, Expr, Item, Utterance

NAME = "the inserted text"


@dataclass(frozen=True, slots=True)
class Fragment:
    """A piece that was read, with its source, in which its comments are."""

    source: Source
    items: tuple[Item, ...]

    @property
    def expression(self) -> Expr:
        """The one expression that it is. Raises: AZeeError: it is something else."""
        if len(self.items) == 1 and isinstance(self.items[0], Utterance):
            return self.items[0].expr
        raise AZeeError(cannot_edit("one expression is expected here", self.source.text.strip()))


def read_fragment(text: str, *, template: bool = False) -> Fragment:
    """Read items, or an expression, with any margin. Raises: AZeeError: it has mistakes."""
    source = Source(NAME, _unindented(text))
    return Fragment(source, _sound(parse(source, template=template)))


def read_operands(text: str) -> tuple[Source, tuple[Operand, ...]]:
    """Read rows of operands, one a line, as they would stand below a head.

    Raises: AZeeError: they have mistakes, or there are none.
    """
    lines = _unindented(text).splitlines(keepends=True)
    source = Source(NAME, "list\n" + "".join(f"    {line}" for line in lines))
    (item,) = _sound(parse(source))
    assert isinstance(item, Utterance)
    assert isinstance(item.expr, Application)
    if not item.expr.operands:
        raise AZeeError(cannot_edit("there is nothing to insert", text))
    return source, item.expr.operands


def _sound(parsed: Parsed) -> tuple[Item, ...]:
    if parsed.diagnostics:
        raise AZeeError(*parsed.diagnostics)
    return parsed.file.items


def _unindented(text: str) -> str:
    """Take the margin of the first line away from all lines."""
    lines = text.strip("\r\n").splitlines(keepends=True)
    first = lines[0] if lines else ""
    margin = first[: len(first) - len(first.lstrip(" \t"))]
    return "".join(line.removeprefix(margin) for line in lines)
