"""Formatting changes the layout and nothing else, and formatting again changes nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from case_files import Case, read_cases
from hypothesis import assume, given
from programs_azee import programs
from texts import texts

from azee_grammar.diagnostic import AZeeError
from azee_grammar.format import WIDTH, format_file
from azee_grammar.layout import DEEPEST
from azee_grammar.library import shipped
from azee_grammar.parser import Parsed, parse
from azee_grammar.source import Source
from azee_grammar.syntax import Application, Definition, Expr, Named, Utterance

FORMATS = Path(__file__).parent / "formats"


def formatted(text: str, *, published: bool = False) -> str:
    return format_file(Source("a.azee", text), published=published)


def read(text: str) -> Parsed:
    return parse(Source("a.azee", text), template=True)


def lines_form(node: Expr) -> Expr:
    """The tree without what the published form cannot show: calls where lines say the same."""
    if not isinstance(node, Application):
        return node
    operands: list[Expr | Named] = []
    for operand in node.operands:
        if isinstance(operand, Named):
            operands += (operand.name, lines_form(operand.value))
        else:
            operands.append(lines_form(operand))
    return Application(node.span, node.head, tuple(operands), called=False)


@pytest.mark.parametrize("case", read_cases(FORMATS / "canonical.txt"))
def test_canonical_form(case: Case) -> None:
    assert formatted(case.text) == case.expected
    assert formatted(case.expected) == case.expected


@pytest.mark.parametrize("case", read_cases(FORMATS / "published.txt"))
def test_published_form(case: Case) -> None:
    assert formatted(case.text, published=True) == case.expected
    assert formatted(case.expected, published=True) == case.expected


def test_a_tree_can_be_formatted() -> None:
    source = Source("a", ":a\n 1 # b\n")
    assert format_file(parse(source).file) == format_file(source) == ":a 1  # b\n"


def test_a_text_with_mistakes_is_not_formatted() -> None:
    with pytest.raises(AZeeError) as caught:
        formatted(":a )\n(")
    assert [d.code for d in caught.value.diagnostics] == ["syntax", "unclosed-paren"]


@pytest.mark.long
@pytest.mark.parametrize("file", sorted(shipped().rglob("*.azee")), ids=lambda file: file.name)
def test_shipped_rules_keep_their_meaning(file: Path) -> None:
    check(file.read_text(encoding="utf-8"))


@pytest.mark.long
@given(programs)
def test_generated_programs_keep_their_meaning(text: str) -> None:
    assume(not read(text).diagnostics)
    check(text)


@given(texts)
def test_any_text_without_mistakes_keeps_its_meaning(text: str) -> None:
    assume(not read(text).diagnostics)
    check(text)


def check(text: str) -> None:
    before = read(text)
    canonical = formatted(text)
    after = read(canonical)
    assert not after.diagnostics
    assert after.file == before.file
    assert comments(after) == comments(before)
    assert formatted(canonical) == canonical
    assert "\n\n\n" not in canonical

    published = formatted(text, published=True)
    again = read(published)
    assert not again.diagnostics
    assert [(type(i), lines_form(e) if (e := expression(i)) else i) for i in again.file.items] == [
        (type(i), lines_form(e) if (e := expression(i)) else i) for i in before.file.items
    ]
    assert comments(again) == comments(before)
    assert formatted(published, published=True) == published


def expression(item: object) -> Expr | None:
    if isinstance(item, Utterance):
        return item.expr
    return item.body if isinstance(item, Definition) else None


def comments(parsed: Parsed) -> list[str]:
    return [comment.text.rstrip() for comment in parsed.comments]


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("list ", ""),
        ("list 1 !palm(s) ", ""),
        ("f(1, ", ")"),
        (":a 'x ", ""),
        ("a\n    'x (b ", " 1)\n    (c (d e) 1)"),
        ("f('c = g 1 ", ")"),
        ("f(\n    g(1, ", "),\n    # it stays a line\n    2\n)"),
    ],
)
def test_a_line_is_broken_where_it_would_be_too_wide(before: str, after: str) -> None:
    last = before.rsplit("\n", 1)[-1] + after.split("\n", 1)[0]
    room = WIDTH - len(last)
    fits = f"{before}^{'n' * (room - 1)}{after}"
    assert max(map(len, formatted(fits).splitlines())) == WIDTH
    too_wide = f"{before}^{'n' * room}{after}"
    assert len(formatted(too_wide).splitlines()) > len(formatted(fits).splitlines())


@pytest.mark.parametrize(
    "text",
    [
        "f(" * DEEPEST + ")" * DEEPEST,
        "f('a = " * (DEEPEST // 2) + "1" + ")" * (DEEPEST // 2),
        "f\n" + "".join(f"{' ' * level}'a f\n" for level in range(1, DEEPEST + 1)),
        "(f 1 " * DEEPEST + ")" * DEEPEST,
    ],
)
def test_the_deepest_trees_can_be_formatted(text: str) -> None:
    """In lines the canonical form of a tree is as deep as the tree, not deeper."""
    canonical = formatted(text)
    assert read(canonical).file == read(text).file
    assert formatted(canonical) == canonical
