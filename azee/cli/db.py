"""`azee db`: a database of signs is made, searched, changed, copied and checked."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, FAULT, MISSED, bar, news, show, show_json
from azee.cli.db_add import add
from azee.cli.db_place import (
    as_diagnostic,
    db_option,
    in_words,
    opened,
    sign_options,
    usual_place,
)
from azee.cli.db_record import record
from azee.cli.db_reposition import reposition
from azee.cli.outputs import check_outputs, size_of, with_suffix
from azee.formats import CLIP_WRITERS, writing
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.signs.sign import Sign

quiet_option = click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
form_option = click.option(
    "--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True
)


@click.group(short_help="Keep signs in a database.")
def db() -> None:
    """Keep signs with their motion, names, tags and sources in a database."""


db.add_command(add)
db.add_command(record)
db.add_command(reposition)


@db.command(short_help="Make a database, or bring an older one up to date.")
@db_option
@quiet_option
def create(place: str | None, quiet: bool) -> int:
    """Make a database for signs; one of an older azee is brought up to date, with all its signs."""
    with in_words():
        from azee.signs.database import SignDatabase
        from azee.signs.tables import VERSION

        if place is None:
            place = usual_place()
            with writing(place):
                Path(place).parent.mkdir(parents=True, exist_ok=True)
        database, before = SignDatabase.create(place)
        with database:
            name = database.store.name
    if before is None:
        news(f"made {name}", quiet=quiet)
    elif before == VERSION:
        news(f"{name} is there already, and up to date", quiet=quiet)
    else:
        news(f"brought {name} from version {before} to {VERSION}", quiet=quiet)
    return DONE


@db.command("list", short_help="All signs, or those of a kind.")
@click.option("--language", metavar="L", help="Only signs of this language.")
@click.option("--kind", type=click.Choice(["recorded", "azee", "spelled"]), help="Only this kind.")
@form_option
@db_option
def list_(language: str | None, kind: str | None, form: str, place: str | None) -> int:
    """List signs: name, seconds, frames, kind, skeleton, tags."""
    with opened(place) as database:
        from azee.signs.query import Query

        _print(database.find(Query(language=language, kind=kind)), form)
    return DONE


@db.command(short_help="Signs by the beginning of their name, or by tag.")
@click.argument("word", metavar="WORD", required=False)
@click.option("--tag", metavar="T", help="Only signs with this tag.")
@click.option("--language", metavar="L", help="Only signs of this language.")
@form_option
@db_option
def search(
    word: str | None, tag: str | None, language: str | None, form: str, place: str | None
) -> int:
    """Find the signs whose name begins with WORD, or that have WORD as a tag."""
    if not (word or tag):
        raise click.UsageError("give a WORD, or a --tag")
    with opened(place) as database:
        from azee.signs.query import Query

        found = database.find(Query(word=word, tag=tag, language=language))
        _print(found, form)
    return DONE if found else MISSED


@db.command("show", short_help="All that is known of a sign.")
@click.argument("name", metavar="NAME")
@sign_options
@db_option
def show_(name: str, language: str | None, variant: str | None, place: str | None) -> int:
    """Print all that is known of the sign NAME, as JSON."""
    with opened(place) as database:
        show_json(database.one(name, language=language, variant=variant).document())
    return DONE


@db.command(short_help="Give a sign tags, or take them away.")
@click.argument("name", metavar="NAME")
@click.argument("tags", metavar="TAG…", nargs=-1)
@click.option("--remove", "gone", metavar="T", multiple=True, help="Take a tag away. Repeatable.")
@sign_options
@db_option
@quiet_option
def tag(
    name: str,
    tags: Sequence[str],
    gone: Sequence[str],
    language: str | None,
    variant: str | None,
    place: str | None,
    quiet: bool,
) -> int:
    """Give the sign NAME tags."""
    if not (tags or gone):
        raise click.UsageError("give a TAG, or one to --remove")
    with opened(place) as database:
        sign = database.one(name, language=language, variant=variant)
        tagged = database.tag(sign, tags, gone)
    news(f"{tagged.identity}: {', '.join(tagged.facts.tags) or 'no tags'}", quiet=quiet)
    return DONE


@db.command(short_help="Give a sign another name.")
@click.argument("name", metavar="NAME")
@click.argument("new", metavar="NEW")
@click.option("--new-language", metavar="L", help="Its language from now on.")
@click.option("--new-variant", metavar="V", help="Its variant from now on.")
@sign_options
@db_option
@quiet_option
def rename(
    name: str,
    new: str,
    new_language: str | None,
    new_variant: str | None,
    language: str | None,
    variant: str | None,
    place: str | None,
    quiet: bool,
) -> int:
    """Call the sign NAME NEW."""
    with opened(place) as database:
        from azee.signs.sign import Identity

        sign = database.one(name, language=language, variant=variant)
        old = sign.identity
        identity = Identity(
            new,
            old.language if new_language is None else new_language,
            old.variant if new_variant is None else new_variant,
        )
        renamed = database.rename(sign, identity)
    news(f"{old} is now {renamed.identity}", quiet=quiet)
    return DONE


@db.command(short_help="Remove signs.")
@click.argument("names", metavar="NAME…", nargs=-1, required=True)
@sign_options
@db_option
@quiet_option
def remove(
    names: Sequence[str],
    language: str | None,
    variant: str | None,
    place: str | None,
    quiet: bool,
) -> int:
    """Remove the signs NAME with their motion; nothing is removed if one of them is not there."""
    with opened(place) as database:
        signs = [database.one(name, language=language, variant=variant) for name in names]
        for sign in signs:
            database.remove(sign)
            news(f"removed {sign.identity}", quiet=quiet)
    return DONE


@db.command(short_help="A sign as a file.")
@click.argument("name", metavar="NAME")
@click.option(
    "-o",
    "outputs",
    metavar="OUT",
    multiple=True,
    type=click.Path(path_type=Path),
    callback=with_suffix(*CLIP_WRITERS),
    help=f"A file to write: {' '.join(CLIP_WRITERS)}. Repeatable.",
)
@click.option(
    "--original",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Write the file that the sign came from, byte by byte.",
)
@click.option("--rig", metavar="R", help="The body; by default the one it was stored for.")
@sign_options
@db_option
@quiet_option
def export(
    name: str,
    outputs: Sequence[Path],
    original: Path | None,
    rig: str | None,
    language: str | None,
    variant: str | None,
    place: str | None,
    quiet: bool,
) -> int:
    """Write the sign NAME in other formats, or the file that it came from."""
    from azee.export.files import replace_file

    written = [*outputs, *([original] if original else [])]
    if not written:
        raise click.UsageError("name a file with -o or --original")
    check_outputs(written)
    with opened(place) as database:
        sign = database.one(name, language=language, variant=variant)
        if outputs:
            from azee.clips import save_clip

            body = load_body(rig or _shipped(sign))
            clip = database.clip(sign, body)
            for path in outputs:
                save_clip(clip, body, path)
        if original is not None:
            _, data = database.original(sign)
            with writing(original), replace_file(original) as file:
                file.write(data)
    news("\n".join(f"wrote {path} ({size_of(path)})" for path in written), quiet=quiet)
    return DONE


@db.command(short_help="Signs into another database.")
@click.argument("names", metavar="NAME…", nargs=-1)
@click.option("--all", "everything", is_flag=True, help="All signs.")
@click.option("--to", "target", metavar="DB", required=True, help="The other database.")
@sign_options
@db_option
@quiet_option
def copy(
    names: Sequence[str],
    everything: bool,
    target: str,
    language: str | None,
    variant: str | None,
    place: str | None,
    quiet: bool,
) -> int:
    """Copy the signs NAME into another database; those that are there already stay."""
    if bool(names) == everything:
        raise click.UsageError("give either names or --all")
    with opened(place) as database, opened(target) as other:
        from azee.signs.copying import copy_all
        from azee.signs.query import Query

        if everything:
            signs = database.find(Query(language=language, variant=variant))
        else:
            signs = [database.one(name, language=language, variant=variant) for name in names]
        with bar("Copying", quiet=quiet) as progress:
            done = copy_all(database, signs, other, progress)
    show(map(as_diagnostic, done.failed))
    there = f"; {done.there} there already" if done.there else ""
    news(f"{done.copied} of {len(signs)} signs copied{there}", quiet=quiet)
    return FAULT if done.failed else DONE


@db.command("check", short_help="Look for damage.")
@db_option
@quiet_option
def check(place: str | None, quiet: bool) -> int:
    """Check the file, every reference, and the bytes of every motion and original file."""
    with opened(place) as database:
        from azee.signs.integrity import problems

        with bar("Checking", quiet=quiet) as progress:
            found = list(problems(database, progress))
        count = len(database.find())
    show(map(as_diagnostic, found))
    told = f"{len(found)} problems" if len(found) > 1 else "1 problem" if found else "no damage"
    news(f"{count} sign{'' if count == 1 else 's'}: {told}", quiet=quiet)
    return FAULT if found else DONE


def _print(signs: Sequence[Sign], form: str) -> None:
    if form == "json":
        show_json({"signs": [sign.document() for sign in signs]})
        return
    for sign in signs:
        timing, facts = sign.facts.timing, sign.facts
        cells = [f"{timing.duration_s:.2f} s", f"{timing.frames} frames", facts.kind, sign.skeleton]
        if facts.tags:
            cells.append(", ".join(facts.tags))
        click.echo("\t".join([str(sign.identity), *cells]))


def _shipped(sign: Sign) -> str:
    """Return the body of a sign, if it ships: folders that a database names are not opened."""
    from azee_rig.load import shipped_rigs

    if sign.skeleton in shipped_rigs():
        return sign.skeleton
    message = f"`{sign.identity}` moves the body `{sign.skeleton}`, which does not ship"
    help_ = "name the body's folder with --rig"
    raise AZeeError(Diagnostic("other-skeleton", message, None, help=help_))
