"""`azee db reposition`: signs whose trunk and head are to face the viewer."""

from __future__ import annotations

from collections.abc import Sequence

import click

from azee.cli.console import DONE, news
from azee.cli.db_place import db_option, opened, sign_options


@click.command(short_help="Turn head and trunk to the viewer.")
@click.argument("names", metavar="NAME…", nargs=-1)
@click.option("--all", "everything", is_flag=True, help="All signs.")
@click.option("--undo", is_flag=True, help="As recorded again.")
@sign_options
@db_option
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def reposition(
    names: Sequence[str],
    everything: bool,
    undo: bool,
    language: str | None,
    variant: str | None,
    place: str | None,
    quiet: bool,
) -> int:
    """Have the signs NAME face the viewer, with trunk and head, from now on.

    The mean turn of trunk and head in what the sign means is taken away wherever it is played or
    exported; movements about it stay. What is stored does not change.
    """
    if bool(names) == everything:
        raise click.UsageError("give either names or --all")
    with opened(place) as database:
        from azee.signs.query import Query

        if everything:
            signs = database.find(Query(language=language, variant=variant))
        else:
            signs = [database.one(name, language=language, variant=variant) for name in names]
        for sign in signs:
            database.reposition(sign, turned=not undo)
            to = "is as recorded" if undo else "faces the viewer"
            news(f"{sign.identity} {to}", quiet=quiet)
    return DONE
