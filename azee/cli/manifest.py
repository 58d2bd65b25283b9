"""`azee manifest`: writes the manifest of a library of rules, or verifies it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.console import DONE, FAULT, news, show
from azee.wording import counted

if TYPE_CHECKING:
    from azee.lang.manifest import Manifest
    from azee_grammar.diagnostic import Diagnostic


@click.command(short_help="What a library of rules is, and its state.")
@click.argument(
    "folders",
    nargs=-1,
    required=True,
    metavar="FOLDER…",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
)
@click.option("--check", is_flag=True, help="Write nothing; fail where a manifest is not current.")
@click.option("--version", metavar="TEXT", help="Such as 1.2.0.")
@click.option("--licence", metavar="TEXT", help="Its SPDX identifier, such as CC-BY-4.0.")
@click.option("--language", metavar="TEXT", help="ISO 639-3 code of the sign language, or `mul`.")
@click.option("--citation", metavar="TEXT", help="How to cite the library.")
@click.option("--quiet", is_flag=True, help="Only errors.")
def manifest(folders: Sequence[Path], check: bool, quiet: bool, **said: str | None) -> int:
    """Write `library.json` into each FOLDER of rules: what the library is, and its rules' hashes.

    What is not given stays as the manifest has it; a new manifest needs all four texts.

    Exit codes: 0 done, 1 not current, or mistakes in the library, 2 wrong use.
    """
    from azee.lang.manifest import FILE

    given = {key: text for key, text in said.items() if text is not None}
    if check and given:
        raise click.UsageError("--check writes nothing, so it takes no texts")
    stale: list[Diagnostic] = []
    for folder in folders:
        if check:
            stale += _stale(folder)
            continue
        found = _current(folder, given)
        _write(found, folder / FILE)
        news(f"wrote {folder / FILE}: {counted(len(found.rules), 'rule')}", quiet=quiet)
    if check:
        show(stale)
        if not stale:
            news(f"{counted(len(folders), 'manifest')}: current", quiet=quiet)
    return FAULT if stale else DONE


def _current(folder: Path, given: dict[str, str]) -> Manifest:
    """Return the manifest that a folder should have."""
    from azee.lang.manifest import FIELDS, Manifest, read_beside
    from azee.lang.stocktaking import namespace_of

    recorded = read_beside(folder)
    said = {**(recorded.said if recorded else {}), **given}
    lacking = [f"--{key}" for key in FIELDS if not said.get(key)]
    if lacking:
        raise click.UsageError(f"`{folder}` has no manifest yet: give {', '.join(lacking)} too")
    return Manifest.of(namespace_of(folder), said)


def _stale(folder: Path) -> Iterator[Diagnostic]:
    """Yield why the manifest of a folder is not current."""
    from azee.lang.manifest import FILE, changes, read_beside
    from azee.lang.stocktaking import library_now
    from azee_grammar.diagnostic import Diagnostic

    hint = "`azee manifest` writes it again"
    recorded = read_beside(folder)
    if recorded is None:
        message = f"`{folder}` has no manifest"
        yield Diagnostic("stale-manifest", message, None, help="`azee manifest` writes it")
        return
    now = library_now(str(folder))
    if changed := changes(recorded, now):
        names = ", ".join(f"`{change.name}`" for change in changed)
        message = f"`{folder / FILE}` is not current: {names}"
        yield Diagnostic("stale-manifest", message, None, help=hint)
    elif recorded != now:
        message = f"`{folder / FILE}` names another library: `{recorded.name}`"
        yield Diagnostic("stale-manifest", message, None, help=hint)


def _write(found: Manifest, path: Path) -> None:
    from azee.export.files import replace_file
    from azee.formats import writing

    with writing(path), replace_file(path) as file:
        file.write(found.text.encode())
