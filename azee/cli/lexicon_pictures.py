"""`azee lexicon show` and `sheet`: signs of a lexicon as pictures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.console import DONE, news
from azee.cli.outputs import check_outputs, size_of, with_suffix
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.compilation import Compilation
    from azee.export.pictures.sheet import Shown

MOST_ON_SHEET = 60


@click.command("show", short_help="A sign: its rule, or a picture.")
@click.argument("folder", metavar="DIR")
@click.argument("name")
@click.option(
    "-o",
    "output",
    metavar="PNG",
    type=click.Path(dir_okay=False, path_type=Path),
    callback=with_suffix(".png"),
    help="Draw its key postures instead of printing the rule.",
)
@click.option("--rig", default="signer", show_default=True, metavar="R", help="Who signs it.")
def show_sign(folder: str, name: str, output: Path | None, rig: str) -> int:
    """Print the rule of a sign, by its name or gloss, or draw it.

    Exit codes: 0 done, 1 no such sign, 2 wrong use.
    """
    from azee.lexicon.installed import lexicon_folder

    path = lexicon_folder(folder)
    rule = _rule_of(path, name)
    if output is None:
        click.echo((path / f"{rule}.azee").read_text(encoding="utf-8"), nl=False)
        return DONE
    check_outputs([output])
    _compiled(path, rule, rig).save(output)
    news(f"wrote {output} ({size_of(output)})")
    return DONE


@click.command("sheet", short_help="Many signs on one picture.")
@click.argument("folder", metavar="DIR")
@click.argument("names", nargs=-1, metavar="[NAME…]")
@click.option(
    "-o",
    "output",
    required=True,
    metavar="PNG",
    type=click.Path(dir_okay=False, path_type=Path),
    callback=with_suffix(".png"),
)
@click.option(
    "--sample",
    type=click.IntRange(1, MOST_ON_SHEET),
    default=12,
    show_default=True,
    help="How many signs, chosen by a hash of their names, where none are named.",
)
@click.option("--rig", default="signer", show_default=True, metavar="R", help="Who signs them.")
def sheet(folder: str, names: Sequence[str], output: Path, sample: int, rig: str) -> int:
    """Draw the middle of each sign: those that are named, or a sample.

    Exit codes: 0 done, 1 a sign is missing or cannot be compiled, 2 wrong use.
    """
    from azee.lexicon.installed import lexicon_folder
    from azee.lexicon.record import Record
    from azee.lexicon.sample import sample_of

    check_outputs([output])
    path = lexicon_folder(folder)
    known = Record.read(path).entries
    rules = [_rule_of(path, name) for name in names] or sample_of(known, sample)
    if not rules:
        message = f"`{folder}` has no imported signs"
        raise AZeeError(Diagnostic("cannot-read", message, None))
    problems: list[Diagnostic] = []
    shown: list[Shown] = []
    for rule in rules:
        news(rule)
        try:
            shown.append(_shown(_compiled(path, rule, rig), rule))
        except AZeeError as problem:
            problems += problem.diagnostics
    if shown:
        from azee.export.pictures.sheet import write_sheet

        write_sheet(shown, output)
        news(f"wrote {output} ({size_of(output)})")
    if problems:
        raise AZeeError(*problems)
    return DONE


def _rule_of(folder: Path, name: str) -> str:
    """Return the name of a rule from its name or gloss. Raises: AZeeError: there is none."""
    from azee.lexicon.glosses import rule_of
    from azee.lexicon.importing import plain_name
    from azee.lexicon.record import Record
    from azee_grammar.nearest import nearest

    record = Record.read(folder)
    found = rule_of(name.removeprefix(":"), record)
    if found is None:
        likely = f"{record.language}-{plain_name(name)}"
        close = [f"`:{other}`" for other in nearest(likely, list(record.entries))]
        hint = f"did you mean {' or '.join(close)}?" if close else "`azee lexicon list` has them"
        message = f"the lexicon `{folder.name}` has no sign `{name}`"
        raise AZeeError(Diagnostic("unknown-rule", message, None, help=hint))
    return found


def _compiled(folder: Path, rule: str, rig: str) -> Compilation:
    import azee
    from azee.cli.body import load_body

    return azee.compile(
        f"use '{folder.name}\n:{rule}\n", load_body(rig), libraries=[folder.parent], life=False
    )


def _shown(compilation: Compilation, rule: str) -> Shown:
    """Show a sign in the middle of what is signed."""
    from azee.export.pictures.sheet import Shown

    report = compilation.report
    middle_s = report.lead_s + report.score_s / 2
    return Shown(f":{rule}", compilation.clip, compilation.rig, middle_s)
