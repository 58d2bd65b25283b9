"""`azee check`: what is wrong with texts, without a body and without solving."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, FAULT, as_json, has_errors, news, show, show_json
from azee.cli.text import library_option
from azee.compilation import lacks
from azee.wording import counted
from azee_grammar.diagnostic import AZeeError, Severity

if TYPE_CHECKING:
    from azee_grammar.diagnostic import Diagnostic
    from azee_rig.rig import Rig


@click.command(short_help="What is wrong with texts.")
@click.argument("files", nargs=-1, required=True, metavar="FILE…")
@library_option
@click.option("--rig", metavar="R", help="Also look whether this body has all that is named.")
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
@click.option("--quiet", is_flag=True, help="Only the exit code and the errors.")
def check(
    files: Sequence[str], libraries: Sequence[Path], rig: str | None, form: str, quiet: bool
) -> int:
    """Check syntax and evaluation of each FILE (`-` is standard input).

    Exit codes: 0 no errors (warnings are none), 1 errors, 2 wrong use.
    """
    body = None if rig is None else load_body(rig)
    found = [diagnostic for file in files for diagnostic in _checked(file, libraries, body)]
    if form == "json":
        show_json({"diagnostics": as_json(found)})
    else:
        show(found)
        news(_summary(len(files), found), quiet=quiet)
    return FAULT if has_errors(found) else DONE


def _checked(file: str, libraries: Sequence[Path], body: Rig | None) -> Sequence[Diagnostic]:
    from azee.lang.program import load
    from azee_grammar.files import read_source

    try:
        program = load(read_source(file), libraries)
        found = program.check()
        if body is None or has_errors(found):
            return found
        bound = (lacks(utterance.score, body) for utterance in program.utterances)
        return [*found, *(diagnostic for lacking in bound for diagnostic in lacking)]
    except AZeeError as error:
        return error.diagnostics


def _summary(files: int, found: Sequence[Diagnostic]) -> str:
    errors = sum(d.severity is Severity.ERROR for d in found)
    warnings = len(found) - errors
    parts = [counted(n, word) for n, word in ((errors, "error"), (warnings, "warning")) if n]
    return f"{counted(files, 'file')}: {', '.join(parts) or 'no errors'}"
