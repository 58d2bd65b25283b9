"""`azee rules`: the rules at hand, and what one of them means and takes."""

from __future__ import annotations

import shutil
import textwrap
import unicodedata
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.text import library_option
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity

if TYPE_CHECKING:
    from azee.lang.rule import Rule
    from azee.lang.scope import Namespace


INDENT = 12


@click.command(short_help="The rules that ship, and yours.")
@click.argument("name", required=False)
@click.option(
    "--search",
    metavar="TEXT",
    help="Only rules with TEXT in their name, meaning, source or arguments.",
)
@library_option
def rules(name: str | None, search: str | None, libraries: Sequence[Path]) -> None:
    """List the rules that ship, or show NAME: meaning, arguments, source, an example.

    With --library the rules of the libraries in a folder too.
    """
    known = {**_shipped(), **_added(libraries)}
    if name is None:
        wanted = "" if search is None else _plain(search)
        matching = {
            library: [rule for rule in found if wanted in _searched(rule)]
            for library, found in known.items()
        }
        lists = [_listed(library, found) for library, found in matching.items() if found]
        if search is not None and not lists:
            raise AZeeError(Diagnostic("unknown-rule", f"no rule speaks of `{search}`", None))
        click.echo("\n\n".join(lists))
        return
    if search is not None:
        raise click.UsageError("NAME shows one rule; --search lists some")
    plain = name.removeprefix(":")
    chosen = [rule for found in known.values() for rule in found if rule.name == plain]
    if not chosen:
        raise AZeeError(_unknown(plain, [r.name for found in known.values() for r in found]))
    click.echo("\n\n".join("\n".join(_shown(rule, libraries)) for rule in chosen))


def _shipped() -> dict[str, list[Rule]]:
    """Return the rules of every library that ships, by name."""
    from azee.lang.library import shipped_library
    from azee_grammar.library import shipped_names

    return {library: _by_name(shipped_library(library).namespace) for library in shipped_names()}


def _added(folders: Sequence[Path]) -> dict[str, list[Rule]]:
    """Return the rules of the libraries in some folders. Raises: AZeeError: one has a mistake."""
    from azee.lang.library import names_in
    from azee.lang.program import load
    from azee_grammar.source import Source

    out = {}
    for folder in folders:
        for library in names_in(folder):
            program = load(Source("<none>", f"use '{library}\n"), [folder])
            if mistakes := [d for d in program.check() if d.severity is Severity.ERROR]:
                raise AZeeError(*mistakes)
            for used in program.librarian.libraries:
                if used.namespace.name == library:
                    out[library] = _by_name(used.namespace)
    return out


def _by_name(namespace: Namespace) -> list[Rule]:
    return sorted(namespace.rules.values(), key=lambda rule: rule.name)


def _searched(rule: Rule) -> str:
    entries = (rule.entry("meaning") or "", rule.entry("source") or "")
    return _plain(" ".join((rule.name, *entries, *(name for name, _ in rule.parameters))))


def _plain(text: str) -> str:
    """Without case and accents, so that `age` finds `âge`."""
    apart = unicodedata.normalize("NFKD", text.casefold())
    return "".join(c for c in apart if not unicodedata.combining(c))


def _listed(library: str, found: Sequence[Rule]) -> str:
    width = max(len(rule.name) for rule in found) + 2
    lines = (f"  {rule.name:<{width}}{rule.entry('meaning') or ''}".rstrip() for rule in found)
    return "\n".join([library, *lines])


def _shown(rule: Rule, libraries: Sequence[Path]) -> Iterator[str]:
    from azee.lang.rule_example import example_of

    yield f":{rule.name}"
    yield from _field("library", rule.library or "")
    for entry in ("meaning", "source"):
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
