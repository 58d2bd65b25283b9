"""How a diagnostic looks, and what programs get of it."""

from __future__ import annotations

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from azee_grammar.diagnostic import Diagnostic, Related, Severity
from azee_grammar.excerpt import WIDEST, Excerpt
from azee_grammar.render import CALLS_SHOWN, render, to_json
from azee_grammar.source import Source, Span

HELLO = Source(
    "hello.azee", "key\n    .2\n    cstr\n    place @CHIN_TIP ^Mssp\n\n\n\n\n:dog\n" + ":a\n" * 3
)


def span(source: Source, part: str) -> Span:
    start = source.text.index(part)
    return Span(source, start, start + len(part))


UNKNOWN = Diagnostic(
    "unknown-site",
    "AZee has no site `@CHIN_TIP`",
    span(HELLO, "@CHIN_TIP"),
    label="no such site",
    notes=("sites are named in capitals",),
    help="did you mean `@CH`?",
    related=(Related("while evaluating `:dog`, called", span(HELLO, ":dog")),),
)


def test_the_layout() -> None:
    assert render(UNKNOWN) == (
        "error[unknown-site]: AZee has no site `@CHIN_TIP`\n"
        " --> hello.azee:4:11\n"
        "  |\n"
        "4 |     place @CHIN_TIP ^Mssp\n"
        "  |           ^^^^^^^^^ no such site\n"
        "note: while evaluating `:dog`, called at hello.azee:9:1\n"
        "note: sites are named in capitals\n"
        "help: did you mean `@CH`?"
    )


def test_wider_line_numbers_move_the_margin() -> None:
    found = Diagnostic("syntax", "x", Span(HELLO, HELLO.text.rindex(":a"), len(HELLO.text) - 1))
    assert render(found).split("\n")[1:] == [
        "  --> hello.azee:12:1",
        "   |",
        "12 | :a",
        "   | ^^",
    ]


def test_without_a_place() -> None:
    found = Diagnostic("cannot-read", "there is no file `a`", None, help="look again")
    assert render(found) == "error[cannot-read]: there is no file `a`\nhelp: look again"


def test_a_warning() -> None:
    found = Diagnostic("x", "y", None, severity=Severity.WARNING)
    assert render(found) == "warning[x]: y"


def test_colour_only_adds_escapes() -> None:
    painted = render(UNKNOWN, colour=True)
    assert painted.startswith("\033[1;31merror[unknown-site]\033[0m")
    plain = ""
    for i, part in enumerate(painted.split("\033[")):
        plain += part if i == 0 else part.partition("m")[2]
    assert plain == render(UNKNOWN)


def test_a_long_call_stack_is_counted() -> None:
    calls = tuple(Related(f"call {n}", span(HELLO, ":dog")) for n in range(100))
    notes = render(Diagnostic("a", "b", None, related=calls)).split("\n")[1:]
    assert len(notes) == CALLS_SHOWN + 1
    assert notes[0].startswith("note: call 0 at")
    assert notes[CALLS_SHOWN // 2] == f"note: … {100 - CALLS_SHOWN} more …"
    assert notes[-1].startswith("note: call 99 at")


def test_json() -> None:
    assert to_json(UNKNOWN) == {
        "code": "unknown-site",
        "severity": "error",
        "message": "AZee has no site `@CHIN_TIP`",
        "file": "hello.azee",
        "line": 4,
        "column": 11,
        "end_line": 4,
        "end_column": 20,
        "label": "no such site",
        "notes": ["sites are named in capitals"],
        "help": "did you mean `@CH`?",
        "fixes": ["@CH"],
        "related": [
            {
                "message": "while evaluating `:dog`, called",
                "file": "hello.azee",
                "line": 9,
                "column": 1,
                "end_line": 9,
                "end_column": 5,
            }
        ],
    }


def test_json_without_a_place() -> None:
    data = to_json(Diagnostic("a", "b", None))
    assert data["file"] is data["line"] is data["end_column"] is None


def test_json_counts_a_tab_as_one_column_and_crlf_as_one_line_end() -> None:
    source = Source("a", ":a\r\n\tf(\r\n:b)")
    data = to_json(Diagnostic("a", "b", span(source, "f(\r\n:b)")))
    assert (data["line"], data["column"]) == (2, 2)
    assert (data["end_line"], data["end_column"]) == (3, 4)


@pytest.mark.parametrize(
    ("text", "part", "line", "carets"),
    [
        ("\t:a", ":a", "    :a", "    ^^"),
        ("a\t:b", ":b", "a   :b", "    ^^"),
        ("a\tb", "\t", "a   b", " ^^^"),
        ("日本 :語", ":語", "日本 :語", "     ^^^"),
        ("e\u0301e\u0301 :a\u0301b", ":a\u0301b", "e\u0301e\u0301 :a\u0301b", "   ^^^"),
        ("a\x1bb :c", ":c", "a\\x1bb :c", "       ^^"),
        ("a\x1bb", "\x1b", "a\\x1bb", " ^^^^"),
        ("f(\n:b)", "f(\n:b)", "f(", "^^"),
        ("(a\r\n", "\r\n", "(a", "  ^"),
    ],
)
def test_carets_line_up(text: str, part: str, line: str, carets: str) -> None:
    shown = Excerpt.of(span(Source("a", text), part))
    assert (shown.line, shown.indent + shown.carets) == (line, carets)


@pytest.mark.parametrize("text", ["", ":a", ":a\n"])
def test_an_empty_span_at_the_end_has_a_caret(text: str) -> None:
    shown = Excerpt.of(Span(Source("a", text), len(text), len(text)))
    assert shown.carets == "^"


@pytest.mark.parametrize("place", [0, 5, 90, 98, 100, 150, 5000, 100_000])
def test_a_long_line_is_cut_around_the_carets(place: int) -> None:
    text = "x" * place + ":mark" + "y" * 300_000
    shown = Excerpt.of(span(Source("a", text), ":mark"))
    assert len(shown.line) <= WIDEST + 2
    assert shown.line[len(shown.indent) :].startswith(":mark")
    assert shown.carets == "^^^^^"


@given(st.text(max_size=300), st.data())
def test_carets_are_as_wide_as_what_they_mark(text: str, data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, len(text)))
    source = Source("a", text)
    shown = Excerpt.of(Span(source, start, end))
    assert shown.carets
    assert len(shown.indent) + len(shown.carets) <= _columns(shown.line) + len("\\U0010ffff ")
    assert "\n" not in shown.line


def _columns(line: str) -> int:
    wide = sum(unicodedata.east_asian_width(c) in ("W", "F") for c in line)
    return len(line) + wide
