"""`azee mcp`: tools for language models, over the Model Context Protocol."""

from __future__ import annotations

import signal
from collections.abc import Sequence
from pathlib import Path

import click

from azee.cli.console import DONE, FAULT, show
from azee.cli.text import library_option
from azee_grammar.diagnostic import Diagnostic


@click.command(short_help="Tools for language models, by the Model Context Protocol.")
@library_option
def mcp(libraries: Sequence[Path]) -> int:
    """Serve the tools rules, check, score, compile and render, on standard input and output.

    Nobody types this: a client of the Model Context Protocol starts it. Files are written inside
    the folder in which it is started, and nowhere else. docs/for-machines.md has the tools.
    """
    try:
        from azee.mcp.server import make_server
    except ModuleNotFoundError as missing:
        if missing.name is None or missing.name.split(".")[0] != "mcp":
            raise
        show(
            [
                Diagnostic(
                    "not-installed",
                    "the server for language models is not installed",
                    None,
                    help="install it with: pip install 'azee[mcp]'",
                )
            ]
        )
        return FAULT
    # Reading standard input cannot be left in an orderly way; files are written beside and renamed.
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, signal.SIG_DFL)
    make_server(Path.cwd(), libraries).run("stdio")
    return DONE
