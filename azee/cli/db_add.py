"""`azee db add`: files of motion become signs; a run that was stopped goes on where it was."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, FAULT, bar, news, show
from azee.cli.db_place import as_diagnostic, db_option, opened
from azee.cli.number import Seconds
from azee.cli.retarget import UNITS
from azee.clips import CLIP_SUFFIXES, carry_over, open_clip, reading
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.clip.retarget import Retargeted
    from azee.signs.database import SignDatabase
    from azee.signs.skeleton import StoredSkeleton
    from azee_rig.rig import Rig


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is to be said of all signs of a run."""

    language: str
    variant: str
    kind: str
    tags: tuple[str, ...]
    licence: str
    attack_s: float | None
    decay_s: float | None
    unit: str | None


@dataclass(slots=True)
class Outcome:
    """What became of the files of a run so far."""

    added: int = 0
    there: int = 0
    told: list[str] = field(default_factory=list)
    failed: list[Diagnostic] = field(default_factory=list)


@click.command(short_help="Add BVH files and clips.")
@click.argument(
    "places", metavar="FILE|DIR…", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@click.option(
    "--rig", metavar="R", default="signer", show_default=True, help="The body that is to sign."
)
@click.option("--language", metavar="L", default="", help="Their language, such as lsf.")
@click.option("--variant", metavar="V", default="", help="What tells signs of one name apart.")
@click.option(
    "--kind",
    type=click.Choice(["recorded", "azee", "spelled"]),
    default="recorded",
    show_default=True,
)
@click.option("--tag", "tags", metavar="T", multiple=True, help="A tag for all. Repeatable.")
@click.option("--licence", metavar="L", default="", help="The licence of the files.")
@click.option("--attack", "attack_s", type=Seconds(min=0), help="Seconds that lead in; default 1.")
@click.option("--decay", "decay_s", type=Seconds(min=0), help="Seconds that lead out; default 1.")
@click.option(
    "--unit", type=click.Choice(UNITS), help="Of a BVH's lengths; by default it is guessed."
)
@db_option
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def add(
    places: Sequence[Path],
    rig: str,
    place: str | None,
    quiet: bool,
    **said: Any,
) -> int:
    """Store each FILE, a BVH of any skeleton with arms or a clip (.npz), as a sign.

    The file's name is that of the sign. A DIR is searched with all folders in it. A file that is
    stored already is passed over, so a run that was stopped goes on with the same command.
    """
    body = load_body(rig)
    wanted, outcome = Wanted(**said), Outcome()
    with opened(place) as database:
        from azee.signs.skeleton import StoredSkeleton

        skeleton = StoredSkeleton.of(body)
        files = [path for each in places for path in _files(each)]
        try:
            with bar("Adding", quiet=quiet) as progress:
                for number, path in enumerate(files, 1):
                    _try(path, database, body, skeleton, wanted, outcome)
                    if progress:
                        progress(number, len(files))
        finally:
            news("\n".join([*outcome.told, _sum(outcome)]), quiet=quiet)
            show(outcome.failed)
    return FAULT if outcome.failed else DONE


def _files(place: Path) -> Iterator[Path]:
    """Yield a file, or all of a folder that can be signs. Raises: AZeeError: cannot-read."""
    if not place.is_dir():
        yield place
        return
    found = sorted(p for p in place.rglob("*") if p.suffix.lower() in CLIP_SUFFIXES)
    if not found:
        message = f"no file of motion is in the folder `{place}`"
        hint = f"they have the suffix {' or '.join(CLIP_SUFFIXES)}"
        raise AZeeError(Diagnostic("cannot-read", message, None, help=hint))
    yield from found


def _try(
    path: Path,
    database: SignDatabase,
    body: Rig,
    skeleton: StoredSkeleton,
    wanted: Wanted,
    outcome: Outcome,
) -> None:
    """Store a file, or note why not. Raises: SignsError: sign-database: no other can be stored."""
    from azee.signs.fault import SignsError

    try:
        with reading(path):
            original = path.read_bytes()
        if database.made_from(original, skeleton):
            outcome.there += 1
            return
        outcome.told += _store(path, original, database, body, skeleton, wanted)
        outcome.added += 1
    except AZeeError as error:
        outcome.failed += error.diagnostics
    except SignsError as error:
        if error.code == "sign-database":
            raise
        told = as_diagnostic(error)
        outcome.failed.append(
            Diagnostic(told.code, f"`{path}`: {told.message}", None, help=told.help)
        )


def _store(
    path: Path,
    original: bytes,
    database: SignDatabase,
    body: Rig,
    skeleton: StoredSkeleton,
    wanted: Wanted,
) -> list[str]:
    """Store one file; returns what its user should know. Raises: AZeeError, SignsError."""
    from azee.signs.packing import packed, timing_of
    from azee.signs.sign import Identity, Motion, SignFacts

    identity = Identity(path.stem, wanted.language, wanted.variant)
    made, notes = _moved(path, body, wanted.unit)
    provenance: dict[str, Any] = {"file": path.name}
    if notes:
        provenance["notes"] = list(notes)
    if not made.is_as_it_was:
        notes = [*notes, made.kept(body)]
        provenance["retargeted"] = made.report(body)
    facts = SignFacts(
        identity,
        timing_of(made.clip, wanted.attack_s, wanted.decay_s),
        wanted.kind,
        wanted.tags,
        wanted.licence,
        provenance,
    )
    database.add(facts, Motion(packed(made.clip, body), original, path.name), skeleton)
    return [f"{path}: {note}" for note in notes]


def _moved(path: Path, body: Rig, unit: str | None) -> tuple[Retargeted, list[str]]:
    """Return the motion of a file on a body; a clip of the body is taken as it is."""
    from azee.clip.archive import ClipFileError, rig_of
    from azee.clip.file_kind import motion_kind
    from azee.clip.retarget import as_it_was

    with reading(path):
        try:
            own = motion_kind(path) == "clip" and rig_of(path) == body.name
        except ClipFileError:
            own = False
    if own:
        opened_clip = open_clip(path, body)
        return as_it_was(opened_clip.clip), [*opened_clip.notes]
    return carry_over(path, body, unit)


def _sum(outcome: Outcome) -> str:
    parts = [f"{outcome.added} sign{'' if outcome.added == 1 else 's'} added"]
    if outcome.there:
        parts.append(f"{outcome.there} there already")
    if outcome.failed:
        parts.append(f"{len(outcome.failed)} failed")
    return ", ".join(parts)
