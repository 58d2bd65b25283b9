"""`azee play`: a page on which a signer plays what one types."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.db_place import db_option
from azee.cli.play_page import export, page_options, show_page
from azee.cli.text import library_option

if TYPE_CHECKING:
    from azee.spelling.text import Language


@click.command(short_help="A page on which a signer plays what one types.")
@click.argument("text", nargs=-1)
@page_options
@db_option
@click.option("--language", metavar="L", help="Only signs of this language.")
@library_option
@click.option(
    "--rig", metavar="R", default="signer", show_default=True, help="A body by name, or its folder."
)
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def play(
    text: Sequence[str],
    page: bool,
    folder: Path | None,
    letters: Sequence[Language],
    texts: Sequence[Path],
    port: int,
    opens: bool,
    place: str | None,
    language: str | None,
    libraries: Sequence[Path],
    rig: str,
    quiet: bool,
) -> int:
    """Show a page on which a signer plays TEXT, and whatever else one types."""
    if not page:
        raise click.UsageError("give --page")
    typed = " ".join(text)
    if folder is not None:
        return export(
            folder, typed, rig, letters, texts, libraries, place, language, quiet=quiet
        )  # fmt: skip
    return show_page(typed, rig, port, libraries, opens=opens)
