"""Any text gives a tree or diagnostics, and nothing else."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from itertools import pairwise
from unicodedata import category

import pytest
from hypothesis import given
from hypothesis import strategies as st
from texts import texts

from azee_grammar.diagnostic import Diagnostic
from azee_grammar.parser import parse, parse_expression
from azee_grammar.render import render, to_json
from azee_grammar.source import Source, Span
from azee_grammar.syntax import Application, Definition, Expr, Item, Named, Use, Utterance

STEERING = ("Cc", "Cf", "Cs", "Zl", "Zp")
JOINERS = "\u200c\u200d"


def spans(node: object) -> Iterator[Span]:
    if isinstance(node, Span):
        yield node
    elif isinstance(node, tuple):
        for part in node:
            yield from spans(part)
    elif is_dataclass(node):
        for field in fields(node):
            if field.name != "source":
                yield from spans(getattr(node, field.name))


def inside(node: Item | Expr | Named) -> Iterator[tuple[Span, Span]]:
    """Spans with those of their parts."""
    match node:
        case Utterance(expr=expr):
            parts: tuple[Expr | Named, ...] = (expr,)
        case Definition(body=body):
            parts = () if body is None else (body,)
        case Application(operands=operands):
            yield node.span, node.head.span
            parts = operands
        case Named(name=name, value=value):
            parts = (name, value)
        case Use(library=library):
            parts = (library,)
        case _:
            parts = ()
    for part in parts:
        yield node.span, part.span
        yield from inside(part)


@pytest.mark.long
@given(texts)
def test_any_text_gives_a_tree_or_diagnostics(text: str) -> None:
    parsed = parse(Source("any.azee", text))
    for span in spans((parsed.file, parsed.diagnostics, parsed.comments)):
        assert 0 <= span.start <= span.end <= len(text)
    if not parsed.diagnostics:
        assert all(not isinstance(i, Definition) or i.body is not None for i in parsed.file.items)


@given(texts)
def test_parts_lie_in_their_whole(text: str) -> None:
    for item in parse(Source("any.azee", text)).file.items:
        for whole, part in inside(item):
            assert whole.start <= part.start <= part.end <= whole.end


@given(texts)
def test_items_stand_in_order_and_apart(text: str) -> None:
    items = parse(Source("any.azee", text)).file.items
    for before, after in pairwise(items):
        assert before.span.end < after.span.start


@given(texts)
def test_no_place_is_reported_twice(text: str) -> None:
    found = [(d.code, d.message, d.span) for d in parse(Source("any.azee", text)).diagnostics]
    assert len(set(found)) == len(found)


@given(texts)
def test_every_diagnostic_can_be_shown(text: str) -> None:
    for diagnostic in parse(Source("any.azee", text)).diagnostics:
        for line in render(diagnostic).split("\n"):
            assert not any(category(c) in STEERING for c in line if c not in JOINERS)
        json.dumps(to_json(diagnostic))


@given(texts)
def test_any_text_is_an_expression_or_has_diagnostics(text: str) -> None:
    expression, found = parse_expression(Source("-e", text))
    assert (expression is None) == bool(found)


@given(st.lists(texts, max_size=4))
def test_an_item_after_any_text_is_still_read(parts: list[str]) -> None:
    """Unless an open parenthesis takes it in, which a definition ends."""
    text = "\n".join(parts)
    parsed = parse(Source("any.azee", f"{text}\ndef last one\n    :x\n"))
    last = parsed.file.items[-1]
    assert isinstance(last, Definition)
    assert last.name == "last one"
    assert last.body is not None


@given(texts, texts)
def test_one_items_mistakes_do_not_reach_another(first: str, second: str) -> None:
    """What is said of a text is also said of it below another one."""
    second = f"def between\n    :x\n:second\n{second}"
    alone = parse(Source("b", second)).diagnostics
    together = parse(Source("ab", f"{first}\n{second}")).diagnostics
    before = parse(Source("a", first)).diagnostics

    def shown(found: tuple[Diagnostic, ...]) -> list[tuple[str, str]]:
        return [(d.code, d.message) for d in found]

    assert shown(together) == shown(before) + shown(alone)
