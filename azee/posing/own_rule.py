"""Rules of libraries, copied into a text so that the text can have them otherwise."""

from __future__ import annotations

from collections.abc import Sequence

from azee.blocks.document import Document
from azee.blocks.edits import Insert, Replace
from azee.blocks.tree import Path, children, content
from azee.lang.program import Program
from azee.lang.rule import Rule
from azee.lang.scope import AmbiguousRule
from azee_grammar.syntax import Application, Definition
from azee_solver.constraint import Origin


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
    at = next((i for i, n in enumerate(document.nodes) if not isinstance(n, Definition)), 0)
    at = max(at, sum(_is_use(n) for n in document.nodes))
    for text, _ in reversed(copies):
        document = document.apply(Insert((), at, text)).document
    return document


def _is_use(node: object) -> bool:
    from azee_grammar.syntax import Use

    return isinstance(node, Use)


def _copy(rule: Rule, origin: Origin, constraint: str) -> tuple[str, bool]:
    """Return the text of a rule, and whether the constraint was in it and is replaced."""
    source = rule.definition.span.source
    start = rule.definition.span.start
    document = Document(source)
    i = next(
        i for i, n in enumerate(document.nodes) if n is not None and content(n).span.start == start
    )
    changed = False
    if source.name == origin.file and (path := _path_at(document, i, origin)) is not None:
        document = document.apply(Replace(path, constraint)).document
        changed = True
    return document.items[i].span.text, changed


def _path_at(document: Document, i: int, origin: Origin) -> Path | None:
    item = document.nodes[i]
    assert item is not None
    left: list[tuple[Path, object]] = [((i,), content(item))]
    while left:
        path, node = left.pop()
        if isinstance(node, Application):
            head = node.head.span
            if (head.line, head.column) == (origin.line, origin.column):
                return path
        left += [((*path, k), child) for k, child in enumerate(children(node))]  # type: ignore[arg-type]
    return None
