"""`azee lexicon`: notated signs as rules, and what a folder of them holds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from azee.cli.console import DONE, FAULT, MISSED, as_json, has_errors, news, show, show_json
from azee.cli.lexicon_pictures import sheet, show_sign
from azee.wording import counted
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.lexicon.importing import Summary
    from azee.lexicon.record import Entry, Record

KINDS = ("hands", "handshape", "place", "movement", "face")
_MOST_KINDS = 12


@click.group()
def lexicon() -> None:
    """Import notated signs as rules, and look through them."""


lexicon.add_command(show_sign)
lexicon.add_command(sheet)


@lexicon.command("import", short_help="SiGML or HamNoSys into rules.")
@click.argument(
    "files",
    nargs=-1,
    required=True,
    metavar="FILE…",
    type=click.Path(exists=True, path_type=Path),
)
@click.option(
    "-o",
    "--output",
    "folder",
    required=True,
    metavar="DIR",
    type=click.Path(file_okay=False, path_type=Path),
    help="The folder of rules; it is made if need be.",
)
@click.option(
    "--language", metavar="NAME", help="Names of rules begin with it; as DIR if not said."
)
@click.option(
    "--source",
    metavar="TEXT",
    default="an imported lexicon",
    show_default=True,
    help="What rules say of where they are from: name, owner, licence.",
)
@click.option("--force", is_flag=True, help="Overwrite rules that were edited by hand.")
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
@click.option("--quiet", is_flag=True, help="Only errors.")
def import_(
    files: Sequence[Path],
    folder: Path,
    language: str | None,
    source: str,
    force: bool,
    form: str,
    quiet: bool,
) -> int:
    """Write a rule for each sign in FILEs: SiGML, folders or archives of it, tables with HamNoSys.

    A rule is named after its file. What its notation says and AZee does not is a comment in it.
    Importing the same again changes nothing, and rules that were edited by hand stay.

    Exit codes: 0 done, 1 a file cannot be read (the others are imported), 2 wrong use.
    """
    from azee.lexicon.importing import import_signs, plain_name

    name = plain_name(language or folder.resolve().name)
    try:
        summary = import_signs(files, folder, name, source, force=force)
    except OSError as problem:
        reason = (problem.strerror or "it is no folder").lower()
        message = f"cannot write into `{folder}`: {reason}"
        raise AZeeError(Diagnostic("cannot-write", message, None)) from None
    problems = summary.diagnostics
    if form == "json":
        show_json({"diagnostics": as_json(problems), **summary.as_json()})
    else:
        show(problems)
        if not quiet:
            click.echo("\n".join(_told(summary)))
    return FAULT if has_errors(problems) else DONE


def _told(summary: Summary) -> Iterator[str]:
    counts = (
        (summary.written, "written"),
        (summary.unchanged, "unchanged"),
        (summary.kept, "edited by hand and kept"),
        (summary.failed, "not read"),
    )
    parts = [f"{len(found)} {word}" for found, word in counts if found]
    total = sum(len(found) for found, _ in counts)
    yield f"{counted(total, 'sign')}: {', '.join(parts) or 'none found'}"
    for title, kinds in (
        ("approximated", summary.approximations),
        ("faults of the notation, read all the same", summary.faults),
    ):
        if kinds:
            yield f"{title}:"
        most = sorted(kinds.items(), key=lambda item: (-len(item[1]), item[0]))
        for kind, names in most[:_MOST_KINDS]:
            yield f"  {len(names):5}  {kind}: {summary.details[kind]}"
        if len(most) > _MOST_KINDS:
            yield f"         and {counted(len(most) - _MOST_KINDS, 'kind')} more, in --format json"


# What a folder holds ----------------------------------------------------------------------------

folder_argument = click.argument("folder", metavar="DIR")


@lexicon.command("list", short_help="The signs of a lexicon.")
@folder_argument
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
def list_(folder: str, form: str) -> int:
    """List the rules of a lexicon with their glosses: a folder, or the name of an installed one."""
    return _shown(_record(folder).entries, form)


@lexicon.command(short_help="Signs by gloss, handshape, place …")
@folder_argument
@click.argument("text", required=False)
@click.option("--hands", metavar="WORD", help="one, two, mirrored, parallel, alternating, weak.")
@click.option("--handshape", metavar="WORD", help="Such as flat, fist, finger2, pinch12.")
@click.option("--place", metavar="WORD", help="Such as chin, shoulders, palm.")
@click.option("--movement", metavar="WORD", help="Such as straight, arc, circle, repeated.")
@click.option("--face", metavar="WORD", help="Such as mouthing, brows, head.")
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
def search(folder: str, text: str | None, form: str, **wanted: str | None) -> int:
    """List signs with TEXT in their gloss and with all that is asked of their form.

    Exit codes: 0 found, 1 no such lexicon, 2 wrong use, 3 nothing found.
    """
    record = _record(folder)
    for kind, value in wanted.items():
        _require_known(record, kind, value)
    found = {
        name: entry
        for name, entry in record.entries.items()
        if (text is None or text.casefold() in f"{entry.gloss} {name}".casefold())
        and all(v is None or v in entry.features.get(k, ()) for k, v in wanted.items())
    }
    _shown(found, form)
    return DONE if found else MISSED


@lexicon.command(short_help="What a lexicon is made of.")
@folder_argument
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
def stats(folder: str, form: str) -> int:
    """Count hands, handshapes, places, movements, approximations and faults of a lexicon."""
    record = _record(folder)
    counts = {kind: _counted_values(record, kind) for kind in KINDS}
    losses: dict[str, Counter[str]] = {"approximated": Counter(), "faults": Counter()}
    for entry in record.entries.values():
        losses["approximated"].update(entry.notes)
        losses["faults"].update(entry.faults)
    whole = sum(not entry.notes for entry in record.entries.values())
    if form == "json":
        tables = {name: dict(table) for name, table in (counts | losses).items()}
        show_json({"signs": len(record.entries), "without_approximation": whole, **tables})
        return DONE
    click.echo(f"{counted(len(record.entries), 'sign')}, {whole} without approximation")
    for name, table in (counts | losses).items():
        if table:
            listed = ", ".join(f"{value} {n}" for value, n in table.most_common())
            click.echo(f"{name}: {listed}")
    return DONE


def _counted_values(record: Record, kind: str) -> Counter[str]:
    return Counter(v for entry in record.entries.values() for v in entry.features.get(kind, ()))


def _record(folder: str) -> Record:
    """Read the record of a lexicon. Raises: AZeeError: there is none."""
    from azee.lexicon.installed import lexicon_folder
    from azee.lexicon.record import FILE, Record

    path = lexicon_folder(folder)
    record = Record.read(path)
    if not record.entries:
        message = f"`{folder}` is no imported lexicon: it has no `{FILE}`"
        hint = f"`azee lexicon import FILE… -o {folder}` makes one"
        raise AZeeError(Diagnostic("cannot-read", message, None, help=hint))
    return record


def _require_known(record: Record, kind: str, value: str | None) -> None:
    known = _counted_values(record, kind)
    if value is not None and value not in known:
        listed = ", ".join(sorted(known)) or "nothing"
        raise click.UsageError(f"no sign has the {kind} `{value}`; there are {listed}")


def _shown(entries: Mapping[str, Entry], form: str) -> int:
    if form == "json":
        show_json({"signs": [_as_json(name, entries[name]) for name in sorted(entries)]})
        return DONE
    width = max((len(name) for name in entries), default=0) + 2
    for name in sorted(entries):
        click.echo(f":{name:<{width}}{entries[name].gloss}")
    news(counted(len(entries), "sign"))
    return DONE


def _as_json(name: str, entry: Entry) -> dict[str, Any]:
    return {
        "name": name,
        "gloss": entry.gloss,
        "file": entry.origin,
        "features": {kind: list(values) for kind, values in entry.features.items()},
        "approximations": list(entry.notes),
        "faults": list(entry.faults),
    }
