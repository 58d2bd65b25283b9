"""`azee score`: the nested score of a text, as a tree, a picture or an ELAN file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.console import working
from azee.cli.outputs import check_media, check_outputs, with_suffix
from azee.cli.text import Text, dominant_option, text_options
from azee.formats import SCORE_WRITERS, save_score

if TYPE_CHECKING:
    from azee.compilation import Hand
    from azee.motion.tasks.key_selection import Mode
    from azee.motion.tasks.tracks import Track
    from azee.score.score import Score


@click.command(short_help="The nested score of a text.")
@text_options
@click.option(
    "-o",
    "outputs",
    metavar="OUT",
    multiple=True,
    type=click.Path(path_type=Path),
    callback=with_suffix(*SCORE_WRITERS),
    help="A file to write instead: a drawing, nested and flattened, or a file for ELAN; "
    f"{' '.join(SCORE_WRITERS)}. Repeatable.",
)
@click.option(
    "--tracks",
    is_flag=True,
    help="Solve it, and show which block keys which part of the body, and when.",
)
@click.option(
    "--mode",
    type=click.Choice(["tracks", "flat"]),
    default="tracks",
    show_default=True,
    help="What --tracks shows: each block keys what it needs, or all are flattened.",
)
@click.option(
    "--media",
    metavar="FILM",
    type=click.Path(path_type=Path),
    help="The video that an .eaf shows beside the score.",
)
@click.option(
    "--rig", metavar="R", default="signer", show_default=True, help="The body of --tracks."
)
@dominant_option
def score(
    file: str | None,
    expression: str | None,
    utterance: int | None,
    libraries: Sequence[Path],
    outputs: Sequence[Path],
    tracks: bool,
    mode: Mode,
    media: Path | None,
    rig: str,
    dominant: Hand,
) -> None:
    """Print the score of FILE (`-` is standard input): times, blocks and constraints."""
    from azee.export.score_text import tree

    if tracks and not outputs:
        raise click.UsageError("--tracks is drawn: name a file with -o")
    check_media(media, outputs)
    check_outputs(outputs)
    text = Text.read(file, expression, utterance, libraries)
    found = text.score(dominant)
    if not outputs:
        click.echo(tree(found), nl=False)
        return
    keyed = _tracks(found, rig, dominant, mode) if tracks else ()
    for path in outputs:
        save_score(found, path, keyed, media, text.provenance)


def _tracks(found: Score, rig: str, dominant: Hand, mode: Mode) -> Sequence[Track]:
    from azee.cli.body import load_body
    from azee.compilation import perform

    body = load_body(rig)
    with working("Solving …"):
        made = perform(found, body, dominant=dominant, mode=mode, life=False, timing="exact")
    return made.animation.tracks
