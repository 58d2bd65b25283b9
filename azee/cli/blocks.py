"""`azee blocks`: the nested blocks of a text, and edits of them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from azee.cli.console import DONE, FAULT, news, show
from azee.formats import writing
from azee_grammar.diagnostic import AZeeError

if TYPE_CHECKING:
    from azee.blocks.document import Document


@click.command(short_help="The blocks of a text, and edits of them.")
@click.argument("file", metavar="FILE")
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json"]),
    default="text",
    show_default=True,
    help="An outline with the paths of the blocks, or all that is known of them.",
)
@click.option(
    "--edit",
    "edits",
    metavar="JSON",
    multiple=True,
    help="An edit of the blocks, such as "
    '\'{"edit": "wrap", "path": [0], "text": ":negation \'"\'sig ?it"}\'. '
    "Repeatable: each counts from the text that the one before has made.",
)
@click.option("--write", is_flag=True, help="Write the edited text into FILE instead.")
@click.option("--quiet", is_flag=True, help="Do not tell which comments an edit took away.")
def blocks(file: str, form: str, edits: tuple[str, ...], write: bool, quiet: bool) -> int:
    """Print the blocks of FILE (`-` is standard input), or FILE's text after edits of them.

    Exit codes: 0 done, 1 mistakes or an edit that is impossible, 2 wrong use.
    """
    from azee.blocks.document import Document
    from azee.blocks.outline import outline
    from azee.blocks.view import as_json, blocks_of
    from azee_grammar.files import STANDARD_INPUT, read_source

    document = Document(read_source(file))
    if write and (not edits or file == STANDARD_INPUT):
        raise click.UsageError("--write needs a FILE and an --edit")
    if edits:
        text = _edited(document, edits, quiet=quiet).text
        if write:
            _write(file, text)
        else:
            click.echo(text, nl=False)
        return DONE
    if form == "json":
        click.echo(json.dumps(as_json(document), ensure_ascii=False, indent=2))
    else:
        click.echo(outline(blocks_of(document)), nl=False)
    show(document.diagnostics)
    return FAULT if document.diagnostics else DONE


def _edited(document: Document, edits: tuple[str, ...], *, quiet: bool) -> Document:
    """Return the document after edits, each given as JSON. Raises: AZeeError: one is impossible."""
    from azee.blocks.edits import edit_from_json
    from azee.blocks.fault import cannot_edit

    for edit in edits:
        try:
            read = edit_from_json(json.loads(edit))
        except ValueError as error:  # a mistake of JSON is one
            raise AZeeError(cannot_edit(f"no edit: {error}")) from error
        done = document.apply(read)
        for comment in done.gone:
            news(f"went with it: {comment}", quiet=quiet)
        document = done.document
    return document


def _write(file: str, text: str) -> None:
    from azee.export.files import replace_file

    with writing(file), replace_file(file) as output:
        output.write(text.encode("utf-8"))
