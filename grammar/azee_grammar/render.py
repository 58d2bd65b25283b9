"""Diagnostics for people and for programs.

error[unknown-site]: AZee has no site `@CHIN_TIP`
 --> hello.azee:4:11
  |
4 |     place @CHIN_TIP ^Mssp
  |           ^^^^^^^^^ no such site
note: while evaluating `:dog`, called at hello.azee:9:1
help: did you mean `@CH`?
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from azee_grammar.diagnostic import Diagnostic, Related, Severity
from azee_grammar.excerpt import Excerpt, printable
from azee_grammar.fixes import fixes
from azee_grammar.source import Span

CALLS_SHOWN = 8
"""Calls of a long rule call stack that are shown; those in the middle are only counted."""

_RED, _YELLOW, _BLUE, _CYAN = "31", "33", "34", "36"


def render(diagnostic: Diagnostic, *, colour: bool = False) -> str:
    """Return a diagnostic as lines for a terminal, without a line end after the last."""
    severe = diagnostic.severity is Severity.ERROR
    paint = _painter(colour)
    strong = _RED if severe else _YELLOW
    head = paint(f"{diagnostic.severity.value}[{diagnostic.code}]", strong)
    lines = [f"{head}{paint(f': {printable(diagnostic.message)}', '')}"]
    if diagnostic.span is not None:
        lines += _excerpt(diagnostic.span, diagnostic.label, strong, paint)
    lines += [f"{paint('note', _CYAN)}: {printable(note)}" for note in _notes(diagnostic)]
    if diagnostic.help is not None:
        lines.append(f"{paint('help', _CYAN)}: {printable(diagnostic.help)}")
    return "\n".join(lines)


def to_json(diagnostic: Diagnostic) -> dict[str, Any]:
    """Return a diagnostic as JSON data.

    Lines and columns count from 1, columns in code points of the text as written; ends are
    exclusive. `fixes` are texts for the marked place. `related` holds the rule call stack,
    innermost first.
    """
    return {
        "code": diagnostic.code,
        "severity": diagnostic.severity.value,
        "message": diagnostic.message,
        **_place(diagnostic.span),
        "label": diagnostic.label,
        "notes": list(diagnostic.notes),
        "help": diagnostic.help,
        "fixes": list(fixes(diagnostic)),
        "related": [{"message": r.message, **_place(r.span)} for r in diagnostic.related],
    }


def _painter(colour: bool) -> Callable[[str, str], str]:
    """Return a function that makes text bold, and gives it an ANSI colour if it names one."""

    def paint(text: str, code: str) -> str:
        return f"\033[{';'.join(filter(None, ('1', code)))}m{text}\033[0m" if colour else text

    return paint


def _excerpt(span: Span, label: str, strong: str, paint: Callable[[str, str], str]) -> list[str]:
    excerpt = Excerpt.of(span)
    number = str(span.line)
    margin = " " * len(number)
    bar = paint(f"{margin} |", _BLUE)
    carets = f"{excerpt.carets} {printable(label)}".rstrip()
    return [
        f"{margin}{paint('-->', _BLUE)} {printable(str(span))}",
        bar,
        f"{paint(f'{number} |', _BLUE)} {excerpt.line}".rstrip(),
        f"{bar} {excerpt.indent}{paint(carets, strong)}",
    ]


def _notes(diagnostic: Diagnostic) -> list[str]:
    calls = [_related(related) for related in diagnostic.related]
    if len(calls) > CALLS_SHOWN:
        first = CALLS_SHOWN // 2
        hidden = len(calls) - CALLS_SHOWN
        calls[first : first + hidden] = [f"… {hidden} more …"]
    return [*calls, *diagnostic.notes]


def _related(related: Related) -> str:
    return f"{related.message} at {related.span}"


def _place(span: Span | None) -> dict[str, Any]:
    if span is None:
        keys = ("file", "line", "column", "end_line", "end_column")
        return dict.fromkeys(keys)
    end_line, end_column = span.source.position(span.end)
    return {
        "file": span.source.name,
        "line": span.line,
        "column": span.column,
        "end_line": end_line,
        "end_column": end_column,
    }
