"""`azee score`: the nested score of a text, as a tree or as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from azee.cli.outputs import check_outputs, with_suffix
from azee.cli.text import Text, text_options
from azee.formats import writing


@click.command(short_help="The nested score of a text.")
@text_options
@click.option(
    "-o",
    "output",
    metavar="OUT.svg",
    type=click.Path(path_type=Path),
    callback=with_suffix(".svg"),
    help="Draw it into a file instead, nested and flattened.",
)
def score(
    file: str | None,
    expression: str | None,
    utterance: int | None,
    libraries: Sequence[Path],
    output: Path | None,
) -> None:
    """Print the score of FILE (`-` is standard input): times, blocks and constraints."""
    from azee.export.score_svg import write_svg
    from azee.export.score_text import tree

    if output:
        check_outputs([output])
    found = Text.read(file, expression, utterance, libraries).score()
    if output:
        with writing(output):
            write_svg(found, output)
    else:
        click.echo(tree(found), nl=False)
