"""`azee check`: what is wrong with texts, without a body and without solving."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, FAULT, as_json, has_errors, news, show, show_json
from azee.cli.text import (
    Text,
    expression_option,
    library_option,
    recordings_option,
    shortcuts_option,
)
from azee.compilation import lacks
from azee.wording import counted
from azee_grammar.diagnostic import AZeeError, Severity

if TYPE_CHECKING:
    from azee.lang.written import Written
    from azee_grammar.diagnostic import Diagnostic
    from azee_rig.rig import Rig


@click.command(short_help="What is wrong with texts.")
@click.argument("files", nargs=-1, metavar="[FILE…]")
@expression_option
@library_option
@click.option("--rig", metavar="R", help="Also look whether this body has all that is named.")
@recordings_option
@shortcuts_option
@click.option("--strict-body", is_flag=True, help="What the body lacks is an error, not a warning.")
@click.option(
    "--trust", is_flag=True, help="Also count how far the forms of the rules applied are known."
)
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
@click.option("--quiet", is_flag=True, help="Only the exit code and the errors.")
def check(
    files: Sequence[str],
    expression: str | None,
    libraries: Sequence[Path],
    rig: str | None,
    strict_body: bool,
    trust: bool,
    form: str,
    quiet: bool,
) -> int:
    """Check syntax and evaluation of each FILE (`-` is standard input), or of an expression.

    Exit codes: 0 no errors (warnings are none), 1 errors, 2 wrong use.
    """
    if expression is not None and len(files) > 1:
        raise click.UsageError("-e sees the rules of one FILE")
    body = None if rig is None else load_body(rig)
    texts: Sequence[str | None] = files or [None]
    applications: list[Written] = []
    from azee.lang.library_folder import Shelf

    found: list[Diagnostic] = []
    shelf = Shelf()
    for file in texts:
        try:
            text = Text.read(file, expression, None, libraries, shelf)
        except AZeeError as error:
            found += error.diagnostics
            continue
        found += _checked(text, body, strict_body)
        applications += text.applications if trust else ()
    shelf.keep()
    if form == "json":
        known = {"provenance": _as_json(applications)} if trust else {}
        show_json({"diagnostics": as_json(found), **known})
    else:
        if trust:
            click.echo("\n".join(_trusted(applications)))
        show(found)
        news(_summary(len(files), expression is not None, found), quiet=quiet)
    return FAULT if has_errors(found) else DONE


def _checked(text: Text, body: Rig | None, strict_body: bool) -> Sequence[Diagnostic]:
    """Return what is wrong with a text, then what is wrong with an expression that sees it."""
    found: Sequence[Diagnostic] = ()
    try:
        program, expression = text.program, text.expression
        found = program.check()
        if has_errors(found) or (expression is None and body is None):
            return found
        scores = program.utterances if expression is None else [program.evaluate(expression)]
        found = [*found, *chain.from_iterable(score.warnings for score in scores)]
        if body is None:
            return found
        lacking = (lacks(score.score, body, strict=strict_body) for score in scores)
        return [*found, *chain.from_iterable(lacking)]
    except AZeeError as error:
        return [*found, *error.diagnostics]


def _trusted(applications: Sequence[Written]) -> list[str]:
    """Return the counts of statuses, the rules of each, and the libraries they are in."""
    from azee.lang.provenance import names_by_status, provenance_of

    provenance = provenance_of(applications)
    names = names_by_status(applications)
    lines = [f"  {status}: {', '.join(found)}" for status, found in names.items()]
    for library in provenance.libraries:
        changed = ", ".join(library.changed)
        lines.append(f"  library {library.text}{' with changes in ' if changed else ''}{changed}")
    return [provenance.text, *lines]


def _as_json(applications: Sequence[Written]) -> dict[str, Any]:
    from azee.lang.provenance import names_by_status, provenance_of

    return {**provenance_of(applications).as_json(), "rules": names_by_status(applications)}


def _summary(files: int, expression: bool, found: Sequence[Diagnostic]) -> str:
    errors = sum(d.severity is Severity.ERROR for d in found)
    warnings = len(found) - errors
    parts = [counted(n, word) for n, word in ((errors, "error"), (warnings, "warning")) if n]
    read = ((files, "file"), (int(expression), "expression"))
    texts = " and ".join(counted(n, word) for n, word in read if n)
    return f"{texts}: {', '.join(parts) or 'no errors'}"
