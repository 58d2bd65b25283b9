"""Renames a thing everywhere."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator

from lsprotocol import types

from azee.lsp.document import Document
from azee.lsp.occurrences import Occurrence, Target, What
from azee.lsp.texts import Texts
from azee_grammar.parser import parse, parse_expression
from azee_grammar.source import Source, Span
from azee_grammar.syntax import (
    Application,
    Hole,
    Number,
    Parameter,
    RuleName,
    SideWord,
    Symbol,
    Text,
)


class CannotRename(Exception):  # noqa: N818 - its message is for the person who asks
    """The reason why something cannot be renamed, in the user's words."""


def places(texts: Texts, target: Target) -> Iterator[tuple[Document, Occurrence]]:
    """Yield every place in every known text that names a thing."""
    if target.what is What.BLOCK:
        documents = filter(None, [texts.named(target.place.source.name)])
    else:
        documents = filter(None, texts.all())
    for document in documents:
        for found in texts.analysis(document).occurrences:
            if found.target == target:
                yield document, found


def renamed(texts: Texts, target: Target, name: str) -> dict[str, list[types.TextEdit]]:
    """Return the edits, by text, that give a thing another name.

    Raises: CannotRename: with the reason.
    """
    name = unicodedata.normalize("NFC", name.strip().lstrip(":#.'^"))
    if target.shipped or not _is_here(texts, target):
        raise CannotRename(f"`{target.name}` ships with azee: it is not this text's to rename")
    if not _may_be_called(target.what, name):
        raise CannotRename(f"`{name}` cannot be the name of a {target.what.value}")
    _require_free(texts, target, name)
    _require_readable(texts, target.name)
    edits: dict[str, list[types.TextEdit]] = {}
    for document, found in places(texts, target):
        text = name
        if target.what is What.RULE and not found.sigil and not found.declares and " " in name:
            text = f":{name}"  # `tree()` names a rule by one bare word
        edits.setdefault(document.uri, []).append(types.TextEdit(document.range(found.span), text))
    return edits


def _is_here(texts: Texts, target: Target) -> bool:
    return texts.named(target.place.source.name) is not None


def _may_be_called(what: What, name: str) -> bool:
    """Whether the parser reads the name back unchanged."""
    sigil = {What.RULE: ":", What.LOCAL: "^", What.BLOCK: "'"}[what]
    expr, problems = parse_expression(Source("name", sigil + name))
    if problems or expr is None or (what is What.BLOCK and {":", "/"} & set(name)):
        return False
    match expr:
        case Application(head=RuleName(name=read), operands=()):
            return read == name and what is What.RULE
        case Parameter(name=read) | Symbol(name=read):
            return read == name
        case Application() | Number() | Text() | Hole() | SideWord():
            return False


def _require_free(texts: Texts, target: Target, name: str) -> None:
    document = texts.named(target.place.source.name)
    assert document is not None
    analysis = texts.analysis(document)
    if target.what is What.RULE:
        taken = name in analysis.program.scope.own.rules
    else:
        home = next(i.span for i in analysis.program.file.items if _lies_in(target.place, i.span))
        taken = any(
            found.declares
            and (found.target.what, found.target.name) == (target.what, name)
            and _lies_in(found.span, home)
            for found in analysis.occurrences
        )
    if taken and name != target.name:
        raise CannotRename(f"there is a {target.what.value} `{name}` already")


def _require_readable(texts: Texts, name: str) -> None:
    """Refuse if text that the parser skipped may have the name: it would not be renamed."""
    for document in texts.all():
        if name in document.text and parse(document.source).diagnostics:
            where = document.path.name if document.path else document.uri
            raise CannotRename(f"`{where}` has mistakes of form: mend them first")


def _lies_in(inner: Span, outer: Span) -> bool:
    return outer.start <= inner.start and inner.end <= outer.end
