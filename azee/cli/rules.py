"""`azee rules`: the rules that ship, and what one of them means and takes."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import click

from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.lang.rule import Rule


INDENT = 12


@click.command(short_help="The rules that ship.")
@click.argument("name", required=False)
def rules(name: str | None) -> None:
    """List the rules that ship, or show NAME: meaning, arguments, source, an example."""
    shipped = _shipped()
    if name is None:
        click.echo(
            "\n\n".join(_listed(library, found) for library, found in shipped.items() if found)
        )
        return
    plain = name.removeprefix(":")
    chosen = [rule for found in shipped.values() for rule in found if rule.name == plain]
    if not chosen:
        raise AZeeError(_unknown(plain, [r.name for found in shipped.values() for r in found]))
    click.echo("\n\n".join("\n".join(_shown(rule)) for rule in chosen))


def _shipped() -> dict[str, list[Rule]]:
    """Return the rules of every library that ships, by name."""
    from azee.lang.library import shipped_library
    from azee_grammar.library import shipped_names

    return {
        library: sorted(
            shipped_library(library).namespace.rules.values(), key=lambda rule: rule.name
        )
        for library in shipped_names()
    }


def _listed(library: str, found: Sequence[Rule]) -> str:
    width = max(len(rule.name) for rule in found) + 2
    lines = (f"  {rule.name:<{width}}{rule.entry('meaning') or ''}".rstrip() for rule in found)
    return "\n".join([library, *lines])


def _shown(rule: Rule) -> Iterator[str]:
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
    yield from _field("example", _example(rule))


def _example(rule: Rule) -> str:
    """Return the rule's own example, else its application, which needs no argument."""
    if own := rule.entry("example"):
        return own
    given = ", ".join(f"'{name} = …" for name, mandatory in rule.parameters if mandatory)
    if given:
        return f":{rule.name}({given})"
    return f"key(1, :#{rule.name})" if _is_posture(rule) else f":{rule.name}"


def _is_posture(rule: Rule) -> bool:
    """Whether the rule's result is a set of constraints, which a key makes a score of."""
    from azee.lang.program import load
    from azee.lang.values import Kind
    from azee_grammar.source import Source

    return load(Source("<none>", "")).value(f":{rule.name}").kind is Kind.CONSTRAINTS


def _field(name: str, text: str) -> Sequence[str]:
    """Return a text beside its name, wrapped to the terminal."""
    width = min(shutil.get_terminal_size().columns, 100)
    lead = f"  {name:<{INDENT - 2}}"
    return textwrap.wrap(text, width, initial_indent=lead, subsequent_indent=" " * INDENT)


def _unknown(name: str, known: Sequence[str]) -> Diagnostic:
    from azee_grammar.nearest import nearest

    close = [f"`{other}`" for other in nearest(name, known)]
    hint = f"did you mean {' or '.join(close)}?" if close else "`azee rules` lists them all"
    return Diagnostic("unknown-rule", f"no rule `{name}` ships", None, help=hint)
