"""Rules of libraries, copied into a text so that the text can have them otherwise."""

from __future__ import annotations

from collections.abc import Sequence

from azee.blocks.document import Document
from azee.blocks.edits import Insert, Replace
from azee.blocks.tree import content
from azee.lang.program import Program
from azee.lang.rule import Rule
from azee.lang.scope import AmbiguousRule
from azee.posing.text import PosedText
from azee_grammar.syntax import Definition, Use
from azee_solver.constraint import Origin

_ENTRIES = {
    "status": "placeholder",
    "source": "changed by hand from {library}, where it says: {text}",
}
"""Entries of a rule that is no longer as its library has it: nobody's testimony."""


def with_own_rules(
    document: Document, program: Program, names: Sequence[str], origin: Origin, constraint: str
) -> Document | None:
    """Return a text with copies of rules, one of them with another constraint.

    A text's own rules come before those of libraries, but a library's rules go on to call their
    own; so all rules on the way to the constraint are copied.

    Args: names: of the rules, from the one that the text applies to the one that has the
        constraint. origin: of the constraint that is replaced.
    Returns: None if a rule is not to be found, or is the text's own already.
    """
    copies = []
    scope = program.scope
    for name in dict.fromkeys(names):
        try:
            rule = scope.find(name)
        except AmbiguousRule:
            return None
        if rule is None or name in program.scope.own.rules:
            return None
        copies.append(_copy(rule, origin, constraint))
        scope = rule.scope
    if not any(changed for _, changed in copies):
        return None
    rules = (Use, Definition)
    at = next((i for i, n in enumerate(document.nodes) if not isinstance(n, rules)), 0)
    for text, _ in reversed(copies):
        document = document.apply(Insert((), at, text)).document
    return document


def _copy(rule: Rule, origin: Origin, constraint: str) -> tuple[str, bool]:
    """Return the text of a rule, and whether the constraint was in it and is replaced."""
    source = rule.definition.span.source
    start = rule.definition.span.start
    document = Document(source)
    i = next(
        i for i, n in enumerate(document.nodes) if n is not None and content(n).span.start == start
    )
    path = PosedText(document).path_of(origin)
    if path is None or path[0] != i:
        return document.items[i].span.text, False
    document = document.apply(Replace(path, constraint)).document
    for n, (name, text) in enumerate(rule.definition.entries):
        if name.name in _ENTRIES:
            entry = _ENTRIES[name.name].format(library=rule.library, text=text.text)
            document = document.apply(Replace((i, n), f'"{entry}"')).document
    return document.items[i].span.text, True
