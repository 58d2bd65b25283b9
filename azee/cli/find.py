"""`azee find`: where in a corpus a template matches, and what its holes stand for there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from azee.cli.console import DONE, FAULT, MISSED, as_json, has_errors, news, show, show_json
from azee.cli.text import library_option
from azee_grammar.diagnostic import AZeeError

if TYPE_CHECKING:
    from azee.lang.template import Match, Template
    from azee_grammar.diagnostic import Diagnostic
    from azee_grammar.source import Span


@click.command(short_help="Where a corpus has an expression.")
@click.argument("template")
@click.argument("files", nargs=-1, required=True, metavar="FILE…")
@library_option
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
@click.option("--count", is_flag=True, help="Only how often: in each FILE, then in all.")
@click.option("--quiet", is_flag=True, help="Do not tell how much was found.")
def find(
    template: str,
    files: Sequence[str],
    libraries: Sequence[Path],
    form: str,
    count: bool,
    quiet: bool,
) -> int:
    """Print the expressions in each FILE (`-` is standard input) that TEMPLATE matches.

    TEMPLATE is an expression in which `?name` stands for any expression, such as
    `:info-about(?topic, :bien)`. Rules are searched like utterances. Nothing is evaluated, and
    what can be read of a FILE with mistakes is searched too.

    Exit codes: 0 found, 1 mistakes in TEMPLATE or a FILE, 2 wrong use, 3 nothing found.
    """
    from azee.lang.template import Template

    wanted = Template.read(template)
    matches: list[Match] = []
    counts: dict[str, int] = {}
    problems: list[Diagnostic] = []
    for file in files:
        found, wrong = _searched(wanted, file, libraries)
        matches += found
        counts[file] = counts.get(file, 0) + len(found)
        problems += (problem for problem in wrong if problem not in problems)
    if form == "json":
        listed = {"counts": counts} if count else {"matches": [_as_json(m) for m in matches]}
        show_json({"diagnostics": as_json(problems), **listed})
    elif count:
        click.echo("".join(f"{n}\t{file}\n" for file, n in counts.items()), nl=False)
        show(problems)
        news(f"{len(matches)} found", quiet=quiet)
    else:
        click.echo("".join(f"{line}\n" for match in matches for line in _lines(match)), nl=False)
        show(problems)
        news(f"{len(matches)} found", quiet=quiet)
    if has_errors(problems):
        return FAULT
    return DONE if matches else MISSED


def _searched(
    template: Template, file: str, libraries: Sequence[Path]
) -> tuple[Sequence[Match], Sequence[Diagnostic]]:
    """Return the matches in a file, and what is wrong with it or with the template there."""
    from azee.lang.program import load
    from azee_grammar.files import read_source

    try:
        program = load(read_source(file), libraries)
    except AZeeError as error:
        return (), error.diagnostics
    return list(template.search(program)), (*template.problems(program), *program.found)


def _lines(match: Match) -> Iterator[str]:
    from azee_grammar.format import one_line

    yield f"{match.expr.span}: {one_line(match.expr)}"
    for name, expr in match.bindings.items():
        yield f"    ?{name} = {one_line(expr)}"


def _as_json(match: Match) -> dict[str, Any]:
    from azee_grammar.format import one_line

    bindings = {
        name: {"text": one_line(expr), **_place(expr.span)} for name, expr in match.bindings.items()
    }
    expr = match.expr
    file = expr.span.source.name
    return {"file": file, "text": one_line(expr), **_place(expr.span), "bindings": bindings}


def _place(span: Span) -> dict[str, int]:
    end_line, end_column = span.source.position(span.end)
    return {
        "line": span.line,
        "column": span.column,
        "end_line": end_line,
        "end_column": end_column,
    }
