"""Parses texts. Any text gives a tree, diagnostics, or both; never another exception."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from azee_grammar.automaton import Automaton, UnparsableError
from azee_grammar.builder import Builder
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.layout import Item as Layout
from azee_grammar.layout import LayoutReader
from azee_grammar.mistakes import (
    Mistakes,
    hole_outside_template,
    more_than_one,
    no_expression,
    nothing_here,
    too_many,
)
from azee_grammar.source import Source, Span
from azee_grammar.syntax import Definition, Expr, File, Item
from azee_grammar.tables import State
from azee_grammar.token import Token

MOST_MISTAKES = 1000
"""Parsing stops at this many mistakes: what follows is unlikely to be AZee."""


@dataclass(frozen=True, slots=True)
class Parsed:
    """The tree of a text and all its mistakes, in the order of the text.

    An item with a mistake is not in the tree. A definition with a mistake stays with its name and
    without its body, so that the places that use it are not reported too.
    """

    file: File
    diagnostics: tuple[Diagnostic, ...]
    comments: tuple[Span, ...] = ()


def parse(source: Source, *, template: bool = False) -> Parsed:
    """Parse a text. Holes (`?name`) are mistakes unless it is a template."""
    reader = LayoutReader(source)
    return parse_layouts(source, reader.items(), reader, template=template)


def parse_layouts(
    source: Source, layouts: Iterable[Layout], reader: LayoutReader, *, template: bool = False
) -> Parsed:
    """Parse a text of which the layout is read: its items, and the reader that read them."""
    items: list[Item] = []
    diagnostics: list[Diagnostic] = []
    for layout in layouts:
        item, found = _read(source, layout, "item", template=template)
        diagnostics += found
        if item is not None:
            items.append(item)
        if len(diagnostics) > MOST_MISTAKES:
            next_one = diagnostics[MOST_MISTAKES].span or Span(source, 0, 0)
            diagnostics[MOST_MISTAKES:] = [too_many(next_one, MOST_MISTAKES)]
            break
    whole = Span(source, 0, len(source.text))
    comments = tuple(Span(source, start, end) for start, end in reader.comments)
    return Parsed(File(whole, tuple(items)), tuple(diagnostics), comments)


def parse_expression(
    source: Source, *, template: bool = False
) -> tuple[Expr | None, tuple[Diagnostic, ...]]:
    """Parse a text that is one expression, as the operand of `-e`, with any margin."""
    layouts = list(LayoutReader(source, indented=True).items())
    if not layouts:
        return None, (nothing_here(Span(source, 0, 0)),)
    first = layouts[0].tokens
    if first and first[0].kind in ("DEF", "USE"):
        named = Span(source, first[1].start, first[1].end).text.strip() if first[1:] else ""
        return None, (no_expression(Span(source, first[0].start, first[0].end), named),)
    expression, diagnostics = _read(source, layouts[0], "standalone", template=template)
    if len(layouts) > 1:
        extra = layouts[1].tokens[0]
        diagnostics.append(more_than_one(Span(source, extra.start, extra.end)))
    return (None if diagnostics else expression), tuple(diagnostics)


def _read(
    source: Source, layout: Layout, start: str, *, template: bool
) -> tuple[Any, list[Diagnostic]]:
    """Return the node of one item, and all its mistakes."""
    tokens, diagnostics = layout.tokens, layout.diagnostics
    if not tokens:
        return None, diagnostics
    builder = Builder(source, diagnostics.append)
    mistakes = Mistakes(source, tokens)

    def mistaken(at: int, state: State) -> None:
        if found := mistakes.at(at, state):
            diagnostics.append(found)

    try:
        value = Automaton(tokens, builder, mistaken).run(start)
    except UnparsableError:
        value = None
    if not template:
        holes = (token for token in tokens if token.kind == "HOLE")
        diagnostics += (hole_outside_template(Span(source, t.start, t.end)) for t in holes)
    diagnostics.sort(key=_place)
    return (_unusable(source, tokens) if diagnostics else value), diagnostics


def _unusable(source: Source, tokens: list[Token]) -> Definition | None:
    """Return what remains of an item with mistakes: the name of a definition."""
    if tokens[0].kind != "DEF" or tokens[1].kind != "NAME":
        return None
    name = tokens[1]
    span = Span(source, name.start, name.end)
    return Definition(Span(source, tokens[0].start, name.end), name.text, span, (), None)


def _place(diagnostic: Diagnostic) -> int:
    return diagnostic.span.start if diagnostic.span else 0
