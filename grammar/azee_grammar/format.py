"""Formats a text in the canonical layout, or in the published layout with one token per line.

The tree does not change, only its layout. In the canonical layout, an application stays on one line
of at most 80 columns if its operands need no lines of their own. Otherwise each operand has a line,
a symbol together with its value. Comments stay at their lines.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence

from azee_grammar.diagnostic import AZeeError
from azee_grammar.leaves import head_text, leaf_text
from azee_grammar.misspelt import looks_like_number
from azee_grammar.parser import parse
from azee_grammar.rows import beside_head, fits_behind_symbol, fits_line, rows
from azee_grammar.source import Source, Span
from azee_grammar.syntax import (
    Application,
    BoneName,
    Definition,
    Expr,
    File,
    Head,
    Hole,
    Named,
    Number,
    OperatorName,
    Parameter,
    RuleName,
    SideWord,
    SiteName,
    Symbol,
    Text,
    Use,
)
from azee_grammar.weave import Line, weave

WIDTH = 80
INDENT = "    "


def format_file(text: File | Source, *, published: bool = False) -> str:
    """Return a text in canonical layout, or with `published` in the layout of the publications.

    In the published layout, each line has one token. Calls of bones and sites become lines, and so
    do calls of rules whose operands are all named. Other calls stay, because only the declaration
    of a rule gives the names of its operands.

    Raises: AZeeError: the text has mistakes.
    """
    source = text if isinstance(text, Source) else text.span.source
    parsed = parse(source, template=True)
    if parsed.diagnostics:
        raise AZeeError(*parsed.diagnostics)
    items = parsed.file.items if isinstance(text, Source) else text.items
    printer = _Printer(parsed.comments, published=published)
    for item in items:
        if isinstance(item, Use):
            printer.line(0, f"use '{item.library.name}", item.span)
        elif isinstance(item, Definition):
            printer.definition(item)
        else:
            printer.expression(item.expr, 0)
    return weave(printer.lines, source, parsed.comments, INDENT)


def one_line(expr: Expr) -> str:
    """Return an expression in canonical layout but on one line, without comments."""
    return _flat(expr)


class _Printer:
    """Lays expressions out as lines, each with the range of the text it comes from."""

    def __init__(self, comments: Sequence[Span], *, published: bool) -> None:
        self.lines: list[Line] = []
        self._comments = [comment.start for comment in comments]
        self._published = published

    def line(self, depth: int, text: str, span: Span) -> None:
        """Add a line."""
        self.lines.append(Line(depth, text, span.start, span.end))

    def definition(self, node: Definition) -> None:
        """Lay out a definition: name, entries, body."""
        if node.body is None:
            raise ValueError(f"the body of {node.name} was left out by a mistake")
        self.line(
            0, f"def {node.name}", Span(node.span.source, node.span.start, node.name_span.end)
        )
        for name, text in node.entries:
            if self._published:
                self.line(1, _flat(name), name.span)
                self.line(1, _flat(text), text.span)
            else:
                self.line(1, f"{_flat(name)} {_flat(text)}", name.span.to(text.span))
        if isinstance(node.body, Symbol):
            # After `def`, a symbol would be read as the name of an entry.
            self.line(1, f"({_flat(node.body)})", node.body.span)
        else:
            self.expression(node.body, 1)

    def expression(self, node: Expr, depth: int, lead: Symbol | None = None) -> None:
        """Lay out an expression at a depth, after a symbol on the same line if one precedes it."""
        if self._published:
            node = _uncalled(node)
        span = node.span if lead is None else lead.span.to(node.span)
        prefix = "" if lead is None else f"{_flat(lead)} "
        if not isinstance(node, Application):
            self.line(depth, prefix + _flat(node), span)
        elif node.called:
            self._call(node, depth, prefix, span)
        else:
            self._application(node, depth, lead, prefix)

    def _application(self, node: Application, depth: int, lead: Symbol | None, prefix: str) -> None:
        span = node.span if lead is None else lead.span.to(node.span)
        operands = [operand for operand in node.operands if not isinstance(operand, Named)]
        shape = fits_line(node) if lead is None else fits_behind_symbol(node)
        if not operands or (shape and not self._published):
            flat = prefix + _flat(node, nested=lead is not None)
            if not operands or self._fits(depth, flat, node.span):
                self.line(depth, flat, span)
                return
        beside = self._beside(node, depth)
        if beside:
            # After a symbol they would be words of the symbol's row.
            if lead is not None:
                self.line(depth, _flat(lead), lead.span)
            self.line(depth, *beside)
            operands = operands[beside_head(node) :]
        else:
            self.line(
                depth,
                prefix + head_text(node.head),
                Span(span.source, span.start, node.head.span.end),
            )
        if self._published:
            for operand in operands:
                self.expression(operand, depth + 1)
            return
        for row in rows(node, operands):
            self._row(row, depth + 1)

    def _beside(self, node: Application, depth: int) -> tuple[str, Span] | None:
        """Return the head with the operands that stay on its line, if that is possible."""
        count = 0 if self._published else beside_head(node)
        if not count:
            return None
        words = [_bare(node.head), *node.operands[:count]]
        span = node.head.span.to(words[-1].span)
        text = _joined([_flat(word, nested=True) for word in words], words)
        shape = all(map(fits_behind_symbol, words))
        return (text, span) if shape and self._fits(depth, text, span) else None

    def _row(self, row: Sequence[Expr], depth: int) -> None:
        first = row[0]
        if len(row) > 1 and all(map(fits_behind_symbol, row)):
            span = first.span.to(row[-1].span)
            flat = _joined([_flat(part, nested=True) for part in row], row)
            if self._fits(depth, flat, span):
                self.line(depth, flat, span)
                return
        if len(row) == 2 and isinstance(first, Symbol):
            self.expression(row[1], depth, lead=first)
            return
        for part in row:
            self.expression(part, depth)

    def _call(
        self, node: Application, depth: int, prefix: str, span: Span, after: str = ""
    ) -> None:
        """Lay out a call, with `after` following its parenthesis."""
        flat = f"{prefix}{_flat(node)}{after}"
        if not node.operands or self._fits(depth, flat, node.span):
            self.line(depth, flat, span)
            return
        opened = Span(span.source, span.start, node.head.span.end + 1)
        self.line(depth, f"{prefix}{head_text(node.head)}(", opened)
        for operand in node.operands[:-1]:
            self._argument(operand, depth + 1, ",")
        self._argument(node.operands[-1], depth + 1, "")
        closed = Span(span.source, node.span.end - 1, node.span.end)
        self.line(depth, f"){after}", closed)

    def _argument(self, node: Expr | Named, depth: int, after: str) -> None:
        prefix, value = ("", node)
        if isinstance(node, Named):
            prefix, value = f"{_flat(node.name)} = ", node.value
        if isinstance(value, Application) and value.called:
            self._call(value, depth, prefix, node.span, after)
        else:
            self.line(depth, f"{prefix}{_flat(value)}{after}", node.span)

    def _fits(self, depth: int, text: str, span: Span) -> bool:
        """Whether a part of the text may become one line: not too wide, no comment inside."""
        at = bisect_left(self._comments, span.start)
        if at < len(self._comments) and self._comments[at] < span.end:
            return False
        return len(INDENT) * depth + len(text) <= WIDTH


def _flat(node: Expr | Named, *, nested: bool = False) -> str:
    """Return an expression as one line; `nested` adds parentheses if it has operands."""
    match node:
        case Named(name=symbol, value=value):
            return f"'{symbol.name} = {_flat(value)}"
        case Application(head=head, operands=operands, called=True):
            return f"{head_text(head)}({', '.join([_flat(operand) for operand in operands])})"
        case Application(head=head, operands=operands):
            parts = [head_text(head), *[_flat(operand, nested=True) for operand in operands]]
            text = _joined(parts, [_bare(head), *operands])
            return f"({text})" if nested and operands else text
        case Number() | Text() | Symbol() | Parameter() | Hole() | SideWord():
            return leaf_text(node)


def _joined(parts: Sequence[str], nodes: Sequence[Expr | Named]) -> str:
    """Join words with spaces.

    The name of a rule would include a following word that begins with a letter. Parentheses around
    that word keep it apart.
    """
    text = parts[0]
    for i in range(1, len(parts)):
        before = nodes[i - 1]
        open_name = (
            isinstance(before, Application)
            and isinstance(before.head, RuleName)
            and not before.called
            and not before.operands
        )
        text += f" ({parts[i]})" if open_name and parts[i][0].isalpha() else f" {parts[i]}"
    return text


def _bare(head: Head) -> Application:
    return Application(head.span, head, (), called=False)


def _uncalled(node: Expr) -> Expr:
    """Return a call as an application with lines for its operands, if that has the same meaning."""
    if not isinstance(node, Application) or not node.called:
        return node
    operands: list[Expr] = []
    for operand in node.operands:
        if isinstance(operand, Named):
            operands += (operand.name, operand.value)
        elif isinstance(node.head, BoneName | SiteName):
            operands.append(operand)
        else:
            return node
    if isinstance(node.head, OperatorName) or looks_like_number(head_text(node.head)):
        return node
    return Application(node.span, node.head, tuple(operands), called=False)
