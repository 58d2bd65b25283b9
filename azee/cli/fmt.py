"""`azee fmt`: texts in the one canonical form, or in that of the publications."""

from __future__ import annotations

from collections.abc import Sequence

import click

from azee.cli.console import DONE, FAULT, news, show
from azee.formats import writing
from azee_grammar.diagnostic import AZeeError


@click.command(short_help="Lay texts out in the one canonical form.")
@click.argument("files", nargs=-1, required=True, metavar="FILE…")
@click.option("--check", is_flag=True, help="Change nothing; list the files that would change.")
@click.option("--published", is_flag=True, help="One token on each line, as in the publications.")
@click.option("--quiet", is_flag=True, help="Do not tell which files were changed.")
def fmt(files: Sequence[str], check: bool, published: bool, quiet: bool) -> int:
    """Lay each FILE out anew (`-` reads standard input and writes standard output).

    The meaning does not change, comments stay, and a file that is in this form already is not
    touched. A file with mistakes is left as it is, and its mistakes are told.

    Exit codes: 0 done, 1 mistakes or, with --check, files that would change, 2 wrong use.
    """
    from azee_grammar.files import STANDARD_INPUT, read_source
    from azee_grammar.format import format_file

    code = DONE
    for file in files:
        try:
            source = read_source(file)
            text = format_file(source, published=published)
            if check:
                if text != source.text:
                    click.echo(source.name)
                    code = FAULT
            elif file == STANDARD_INPUT:
                click.echo(text, nl=False)
            elif text != source.text:
                _write(file, text)
                news(f"formatted {file}", quiet=quiet)
        except AZeeError as error:
            show(error.diagnostics)
            code = FAULT
    return code


def _write(file: str, text: str) -> None:
    """Put a text in the place of a file, whole or not at all. Raises: AZeeError: cannot-write."""
    from azee.export.files import replace_file

    with writing(file), replace_file(file) as output:
        output.write(text.encode("utf-8"))
