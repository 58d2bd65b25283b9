"""Properties of the parser that no single case shows."""

from __future__ import annotations

from pathlib import Path

import case_notation as notation
import pytest

from azee_grammar import tables, words
from azee_grammar.layout import DEEPEST
from azee_grammar.parser import MOST_MISTAKES, parse, parse_expression
from azee_grammar.source import Source
from azee_grammar.syntax import Application, Definition, Expr, Named, Utterance


def codes(text: str) -> list[tuple[str, str]]:
    return [
        (d.code, f"{d.span.line}:{d.span.column}")
        for d in parse(Source("t", text)).diagnostics
        if d.span
    ]


def utterance(text: str) -> Expr:
    parsed = parse(Source("t", text))
    assert not parsed.diagnostics
    (item,) = parsed.file.items
    assert isinstance(item, Utterance)
    return item.expr


def test_the_committed_tables_are_those_of_the_grammar() -> None:
    grammar = tables.GRAMMAR.read_text(encoding="utf-8")
    assert tables.serialized(tables.generate(grammar)) == tables.TABLES.read_text(encoding="utf-8")


def test_a_changed_grammar_is_read_anew(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    changed = tmp_path / "azee.lark"
    text = tables.GRAMMAR.read_text(encoding="utf-8")
    changed.write_text(text.replace("use: USE SYMBOL _NEWLINE", "use: USE TEXT _NEWLINE"))
    monkeypatch.setattr(tables, "GRAMMAR", changed)
    tables.tables.cache_clear()
    try:
        read = tables.tables()
        after_use = read.states[read.states[read.starts["item"]]["USE"]]
        assert after_use.keys() == {"TEXT"}
    finally:
        tables.tables.cache_clear()


def test_spans_cover_what_a_node_is_made_of() -> None:
    text = "key .2 (rotate !head ^right 10)\n    :mois sgn1\n        'a   # comment\n"
    key = utterance(text)
    assert isinstance(key, Application)
    assert key.span.text == text[: text.index("'a") + 2]
    duration, rotate, month = key.operands
    assert duration.span.text == ".2"
    assert rotate.span.text == "rotate !head ^right 10"
    assert isinstance(month, Application)
    assert month.head.span.text == ":mois sgn1"
    call = utterance("f( 'a = g(1) )")
    assert isinstance(call, Application)
    assert call.span.text == "f( 'a = g(1) )"
    (named,) = call.operands
    assert isinstance(named, Named)
    assert named.span.text == "'a = g(1)"


def test_positions_are_those_of_the_text_as_written() -> None:
    call = utterance("f(:e\u0301te\u0301, 1)")
    assert isinstance(call, Application)
    assert [operand.span.column for operand in call.operands] == [3, 11]


def test_layout_makes_no_difference_to_equality() -> None:
    assert utterance(":a 'b 1") == utterance(":a\n\n    'b  # one\n    1\n")
    assert utterance(":a 'b 1") != utterance(":a('b, 1)")


@pytest.mark.parametrize(
    "text",
    [
        "(" * 10_000,
        "f(" * 10_000,
        "f('a = " * (DEEPEST // 2 + 1) + "1" + ")" * (DEEPEST // 2 + 1),
        "f('a = " * 10_000 + "1" + ")" * 10_000,
        "".join(f"{' ' * level}f\n" for level in range(1000)),
        "".join(f"{' ' * level}f((\n" for level in range(1000)),
        "f(" * 10_000 + "1" + ")" * 10_000,
    ],
)
def test_deep_nesting_is_one_diagnostic(text: str) -> None:
    found = parse(Source("t", text + "\n:after\n")).diagnostics
    assert [d.code for d in found] == ["recursion-limit"]


@pytest.mark.parametrize(
    "text",
    [
        "f(" * DEEPEST + ")" * DEEPEST,
        "f('a = " * (DEEPEST // 2) + "1" + ")" * (DEEPEST // 2),
        "".join(f"{' ' * level}f\n" for level in range(DEEPEST + 1)),
    ],
)
def test_the_deepest_trees_can_be_compared_and_shown(text: str) -> None:
    one, other = parse(Source("t", text)), parse(Source("u", text))
    assert one.file == other.file
    assert one.file.items
    assert len(repr(one.file)) > DEEPEST


def test_what_comes_after_a_nesting_too_deep_is_read() -> None:
    deep = "def a\n" + "".join(f"{' ' * level}f\n" for level in range(1, 300))
    parsed = parse(Source("t", f"{deep}:b\n"))
    assert [type(item) for item in parsed.file.items] == [Definition, Utterance]
    assert isinstance(parsed.file.items[0], Definition)
    assert parsed.file.items[0].body is None


def test_parsing_takes_a_number_of_steps_proportional_to_the_text(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from azee_grammar.automaton import Automaton

    steps = 0
    reduce = Automaton._reduce

    def counted(self: Automaton, *arguments: object) -> object:
        nonlocal steps
        steps += 1
        return reduce(self, *arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(Automaton, "_reduce", counted)

    def measured(applications: int) -> int:
        nonlocal steps
        steps = 0
        text = "seq\n    list\n" + "        :a\n            'x :b\n            1 2\n" * applications
        parse(Source("t", text))
        return steps

    assert measured(400) - measured(300) == measured(200) - measured(100)


def test_holes_are_read_in_templates() -> None:
    source = Source("t", ":info-about(:âge, ?info)")
    assert not parse(source, template=True).diagnostics
    expression, found = parse_expression(source, template=True)
    assert expression is not None
    assert not found
    expression, found = parse_expression(source)
    assert expression is None
    assert [d.code for d in found] == ["template-hole"]


@pytest.mark.parametrize(
    "text", [":a", "  :a\n    'x 1\n", "\t:a\n\t\t'x", "'a", "1", "\n\n  # c\n  f(\n1)\n"]
)
def test_an_expression_may_be_indented_as_a_whole(text: str) -> None:
    expression, found = parse_expression(Source("-e", text))
    assert not found
    assert expression is not None


@pytest.mark.parametrize(
    ("text", "code", "place"),
    [
        ("", "syntax", "1:1"),
        (" # nothing", "syntax", "1:1"),
        (":a\n:b", "syntax", "2:1"),
        ("  :a\n:b", "bad-indent", "2:1"),
        ("def a\n  :b", "syntax", "1:1"),
        ("use 'a", "syntax", "1:1"),
        (":a )", "syntax", "1:4"),
    ],
)
def test_what_is_no_expression(text: str, code: str, place: str) -> None:
    expression, (found,) = parse_expression(Source("-e", text))
    assert expression is None
    assert found.code == code
    assert found.span is not None
    assert f"{found.span.line}:{found.span.column}" == place


def test_comments_are_kept_with_their_places() -> None:
    text = "# one\n:a  # two\n    # three\n    f(  # four\n    1)\ndef b # five\n    :c#no\n"
    comments = parse(Source("t", text)).comments
    assert [comment.text for comment in comments] == [
        "# one",
        "# two",
        "# three",
        "# four",
        "# five",
    ]


def test_many_mistakes_are_each_reported_once() -> None:
    text = ":a\n    .5 6\n    'x (\n" * 100
    assert codes(text) == [
        place
        for line in range(0, 300, 3)
        for place in (
            ("takes-no-operands", f"{line + 2}:8"),
            ("unclosed-paren", f"{line + 3}:8"),
        )
    ]


def test_a_text_of_too_many_words_is_not_read_to_its_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(words, "MOST_WORDS", 1000)
    text = f":first\n:second {'1 ' * 1000}\n:third\n"
    parsed = parse(Source("t", text))
    assert [notation.item(item) for item in parsed.file.items] == ["(:first)"]
    assert [d.code for d in parsed.diagnostics] == ["size-limit"]
    assert not parse(Source("t", f":first {'1 ' * 998} # one")).diagnostics
    comments = parse(Source("t", "# a\n" * 1001)).diagnostics
    assert [d.code for d in comments] == ["size-limit"]


def test_a_text_of_too_many_mistakes_is_not_read_to_its_end() -> None:
    text = ":a )\n" * MOST_MISTAKES
    assert len(parse(Source("t", text)).diagnostics) == MOST_MISTAKES
    found = parse(Source("t", text * 3 + ":b\n")).diagnostics
    assert [d.code for d in found] == ["syntax"] * MOST_MISTAKES + ["size-limit"]
