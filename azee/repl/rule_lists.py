"""Searches for rules and other names at the prompt."""

from __future__ import annotations

import textwrap
import unicodedata
from collections.abc import Iterator

from azee.assist.description import Description, describe
from azee.assist.knowledge import Knowledge
from azee.lang.registry import NATIVES
from azee.lang.rule import Rule
from azee.repl.ink import Ink, Line, cut
from azee.repl.refusal import Refusal
from azee_grammar import vocabulary
from azee_grammar.nearest import nearest

HERE = "here"
"""Heading of the rules that were typed or loaded."""


def listed(knowledge: Knowledge, words: str, columns: int) -> Iterator[Line]:
    """List the rules in scope that have all words, by library: name and meaning."""
    wanted = _plain(words).split()
    by_library: dict[str, list[Rule]] = {}
    for rule in knowledge.rules():
        if all(word in _searched(rule) for word in wanted):
            by_library.setdefault(rule.library or HERE, []).append(rule)
    wide = max((len(r.name) for rules in by_library.values() for r in rules), default=0) + 2
    for library in sorted(by_library, key=lambda name: (name != HERE, name)):
        yield ((Ink.FAINT, library),)
        for rule in sorted(by_library[library], key=lambda rule: rule.name):
            meaning = cut(rule.entry("meaning") or "", columns - wide - 4)
            yield ((Ink.NAME, f"  :{rule.name:<{wide}}"), (Ink.PLAIN, meaning))


def described(knowledge: Knowledge, name: str, columns: int) -> Iterator[Line]:
    """Explain a name. Raises: Refusal: nothing has this name."""
    found = describe(name, knowledge)
    if not found:
        bare = name.lstrip(":#.!@^'")
        known = (*knowledge.scope.names(), *NATIVES, *vocabulary.site_names())
        near = [f"`{other}`" for other in nearest(bare, known)]
        hint = f"did you mean {' or '.join(near)}?" if near else None
        raise Refusal(f"nothing is called `{name}`", hint)
    for i, description in enumerate(found):
        if i:
            yield ()
        yield from _lines(description, columns)


def _lines(description: Description, columns: int) -> Iterator[Line]:
    yield ((Ink.NAME, description.signature), (Ink.FAINT, f"  {description.what.value}"))
    for line in textwrap.wrap(description.meaning, columns - 2):
        yield ((Ink.PLAIN, f"  {line}"),)
    for label, text in description.facts:
        lead = f"  {label:<10}"
        wrapped = textwrap.wrap(text, max(20, columns - len(lead))) or [""]
        yield ((Ink.FAINT, lead), (Ink.PLAIN, wrapped[0]))
        for line in wrapped[1:]:
            yield ((Ink.PLAIN, f"{' ' * len(lead)}{line}"),)


def _searched(rule: Rule) -> str:
    entries = (rule.entry("meaning") or "", rule.entry("source") or "")
    return _plain(" ".join((rule.name, *entries, *(name for name, _ in rule.parameters))))


def _plain(text: str) -> str:
    """Return a text without case and accents, so that `age` finds `âge`."""
    apart = unicodedata.normalize("NFKD", text.casefold())
    return "".join(c for c in apart if not unicodedata.combining(c))
