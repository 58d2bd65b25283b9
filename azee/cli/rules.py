"""`azee rules`: the rules at hand, and what one of them means and takes."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.console import DONE, FAULT, as_json, show, show_json
from azee.cli.rules_difference import show_difference
from azee.cli.text import library_option
from azee_grammar.diagnostic import Diagnostic, Severity

if TYPE_CHECKING:
    from azee.lang.rule import Rule
    from azee_grammar.source import Span


INDENT = 12


@click.command(short_help="The rules that ship, and yours.")
@click.argument("name", required=False)
@click.option(
    "--search",
    metavar="TEXT",
    help="Only rules with TEXT in their name, meaning, source or arguments.",
)
@click.option(
    "--status",
    metavar="STATUS",
    help="Only rules whose form is published, read-off, inferred, placeholder or judged.",
)
@click.option(
    "--diff",
    nargs=2,
    metavar="A B",
    help="Instead, how the rules of B differ from those of A; each is a library that ships, a "
    "folder of rules or a manifest.",
)
@library_option
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
def rules(
    name: str | None,
    search: str | None,
    status: str | None,
    diff: tuple[str, str] | None,
    libraries: Sequence[Path],
    form: str,
) -> int:
    """List the rules that ship, or show NAME: meaning, arguments, source, an example.

    With --library the rules of the libraries in a folder too: those that can be read, then what is
    wrong with the others.

    Exit codes: 0 done, 1 no such rule or mistakes in a library, 2 wrong use.
    """
    if diff is not None:
        if name is not None or search is not None or status is not None or libraries:
            raise click.UsageError("--diff compares two libraries and takes nothing beside it")
        show_difference(*diff, form=form)
        return DONE
    if name is not None and (search is not None or status is not None):
        raise click.UsageError("NAME shows one rule; --search and --status list some")
    _known_status(status)
    added, mistakes = _added(libraries)
    from azee.lang.rule_table import rule_as_json, shipped_rules

    known = {**shipped_rules(), **added}
    chosen = _of_status(_chosen(known, name, search), status)
    if not any(chosen.values()):
        mistakes = [_none(known, name, search, status), *mistakes]
    if form == "json":
        found = [rule_as_json(rule) for rules in chosen.values() for rule in rules]
        show_json({"diagnostics": as_json(mistakes), "rules": found})
    else:
        shown = {library: rules for library, rules in chosen.items() if rules}
        if name is None:
            texts = [_listed(library, rules) for library, rules in shown.items()]
        else:
            texts = [
                "\n".join(_shown(rule, libraries)) for rules in shown.values() for rule in rules
            ]
        if texts:
            click.echo("\n\n".join(texts))
        show(mistakes)
    return FAULT if mistakes else DONE


def _chosen(
    known: Mapping[str, list[Rule]], name: str | None, search: str | None
) -> dict[str, list[Rule]]:
    """Return the rules of a name, or those that speak of something, by library."""
    from azee.lang.rule_table import speaks_of

    plain = None if name is None else name.removeprefix(":")
    return {
        library: [
            rule
            for rule in found
            if (speaks_of(rule, search or "") if plain is None else rule.name == plain)
        ]
        for library, found in known.items()
    }


def _known_status(status: str | None) -> None:
    from azee.lang.rule import STATUSES

    if status is not None and status not in STATUSES:
        raise click.UsageError(f"`{status}` is no status; there are {', '.join(STATUSES)}")


def _of_status(found: Mapping[str, list[Rule]], status: str | None) -> dict[str, list[Rule]]:
    return {
        library: [r for r in rules if status is None or r.status == status]
        for library, rules in found.items()
    }


def _none(
    known: Mapping[str, list[Rule]], name: str | None, search: str | None, status: str | None
) -> Diagnostic:
    """Say that nothing was found."""
    if name is None:
        spoken = "" if search is None else f" speaks of `{search}`"
        told = "" if status is None else f"{' and' if spoken else ''} has the status {status}"
        return Diagnostic("unknown-rule", f"no rule{spoken}{told}", None)
    return _unknown(name.removeprefix(":"), [r.name for found in known.values() for r in found])


def _added(folders: Sequence[Path]) -> tuple[dict[str, list[Rule]], list[Diagnostic]]:
    """Return the rules without mistakes of the libraries in some folders, and all mistakes."""
    from azee.lang.library import names_in
    from azee.lang.program import load
    from azee.lang.rule_table import by_name
    from azee_grammar.source import Source

    out: dict[str, list[Rule]] = {}
    mistakes: dict[tuple[str, str, Span | None], Diagnostic] = {}
    for folder in folders:
        try:
            names = names_in(folder)
        except OSError as problem:
            reason = (problem.strerror or "it cannot be listed").lower()
            message = f"cannot read the folder `{folder}`: {reason}"
            mistakes[message, "", None] = Diagnostic("cannot-read", message, None)
            continue
        for library in names:
            program = load(Source("<none>", f"use '{library}\n"), [folder])
            for found in program.check():
                if found.severity is Severity.ERROR:
                    mistakes.setdefault((found.code, found.message, found.span), found)
            for used in program.librarian.libraries:
                if used.namespace.name == library:
                    out[library] = [rule for rule in by_name(used.namespace) if _is_sound(rule)]
    return out, list(mistakes.values())


def _is_sound(rule: Rule) -> bool:
    """Whether a rule that was resolved has a body without mistakes; warnings are none."""
    mistakes = any(found.severity is Severity.ERROR for found in rule.diagnostics)
    return rule.definition.body is not None and not mistakes


def _listed(library: str, found: Sequence[Rule]) -> str:
    width = max(len(rule.name) for rule in found) + 2
    lines = (f"  {rule.name:<{width}}{rule.entry('meaning') or ''}".rstrip() for rule in found)
    return "\n".join([library, *lines])


def _shown(rule: Rule, libraries: Sequence[Path]) -> Iterator[str]:
    from azee.lang.rule_example import example_of

    yield f":{rule.name}"
    yield from _field("library", rule.library or "")
    for entry in ("meaning", "source", "status"):
        if text := rule.entry(entry):
            yield from _field(entry, text)
    for i, parameter in enumerate(rule.defaults):
        default = "mandatory"
        if parameter.default is not None:
            default = f"by default {' '.join(parameter.default.span.text.split())}"
        yield from _field("" if i else "arguments", f"'{parameter.name}  {default}")
    yield from _field("example", example_of(rule, libraries))


def _field(name: str, text: str) -> Sequence[str]:
    """Return a text beside its name, wrapped to the terminal."""
    width = min(shutil.get_terminal_size().columns, 100)
    lead = f"  {name:<{INDENT - 2}}"
    return textwrap.wrap(text, width, initial_indent=lead, subsequent_indent=" " * INDENT)


def _unknown(name: str, known: Sequence[str]) -> Diagnostic:
    from azee_grammar.nearest import nearest

    close = [f"`{other}`" for other in nearest(name, known)]
    hint = f"did you mean {' or '.join(close)}?" if close else "`azee rules` lists them all"
    return Diagnostic("unknown-rule", f"there is no rule `{name}`", None, help=hint)
