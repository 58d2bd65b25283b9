"""`azee lsp`: the language server that editors start."""

from __future__ import annotations

import signal
from collections.abc import Sequence
from pathlib import Path

import click

from azee.cli.console import DONE, FAULT, show
from azee.cli.text import library_option
from azee_grammar.diagnostic import Diagnostic


@click.command(short_help="The language server that editors start.")
@library_option
@click.option(
    "--port",
    metavar="N",
    type=click.IntRange(1, 65535),
    help="Listen on this port of this machine instead of standard input.",
)
def lsp(libraries: Sequence[Path], port: int | None) -> int:
    """Serve an editor over the Language Server Protocol, on standard input and output.

    Nobody types this: an editor starts it for `.azee` files. docs/editors.md says how.
    """
    try:
        from azee.lsp.server import make_server
    except ModuleNotFoundError as missing:
        if missing.name is None or missing.name.split(".")[0] not in ("pygls", "lsprotocol"):
            raise
        show(
            [
                Diagnostic(
                    "not-installed",
                    "the language server is not installed",
                    None,
                    help="install it with: pip install 'azee[lsp]'",
                )
            ]
        )
        return FAULT
    # Reading standard input cannot be left in an orderly way, and no file is half-written.
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, signal.SIG_DFL)
    server = make_server(libraries)
    if port is None:
        server.start_io()
    else:
        server.start_tcp("127.0.0.1", port)
    return DONE
