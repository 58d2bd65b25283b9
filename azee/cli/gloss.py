"""`azee gloss`: glosses as an AZee text."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from azee.cli.console import DONE, MISSED, news, show
from azee.wording import counted
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity


@click.command(short_help="Glosses as an AZee text.")
@click.argument("glosses", nargs=-1, required=True, metavar="GLOSS…")
@click.option(
    "--language",
    required=True,
    metavar="NAME",
    help="The lexicon: a folder, or the name of an installed one, such as ngt.",
)
@click.option("--quiet", is_flag=True, help="Do not tell what is unknown.")
def gloss(glosses: Sequence[str], language: str, quiet: bool) -> int:
    """Print an AZee text that signs GLOSSes, such as "ik huis gaan", one after the other.

    Glosses that the lexicon does not have are told, and stand in the text as comments.

    Exit codes: 0 done, 1 no such lexicon, 2 wrong use, 3 no gloss is known.
    """
    from azee.lexicon.glosses import glossed
    from azee.lexicon.installed import lexicon_folder
    from azee.lexicon.record import Record

    words = [word for text in glosses for word in text.split()]
    if not words:
        raise click.UsageError("give at least one gloss")
    folder: Path = lexicon_folder(language)
    record = Record.read(folder)
    if not record.entries:
        message = f"`{language}` is no imported lexicon"
        hint = f"`azee lexicon import FILE… -o {language}` makes one"
        raise AZeeError(Diagnostic("cannot-read", message, None, help=hint))
    found = glossed(words, record, folder.name)
    click.echo(found.text, nl=False)
    if not quiet:
        show(_unknown(word, folder.name) for word in found.unknown)
        known = len(words) - len(found.unknown)
        news(f"{counted(known, 'sign')}, {len(found.unknown)} to be spelled")
    return DONE if len(found.unknown) < len(words) else MISSED


def _unknown(word: str, lexicon: str) -> Diagnostic:
    return Diagnostic(
        "unknown-gloss",
        f"the lexicon `{lexicon}` has no sign `{word}`",
        None,
        help=f"`azee lexicon search {lexicon} {word[:4].lower()}` lists similar ones",
        severity=Severity.WARNING,
    )
