"""Diagnostics in the form of the protocol."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from lsprotocol import types

from azee.lsp.document import Document
from azee_grammar.diagnostic import Diagnostic, Severity
from azee_grammar.source import Span
from azee_grammar.syntax import File, Use

Locate = Callable[[Span], types.Location | None]

_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
}


def messages(
    document: Document, file: File, found: Iterable[Diagnostic], locate: Locate
) -> list[types.Diagnostic]:
    """Return the messages on one text.

    A mistake in a library that it uses is reported at its first `use`, with the place as related.
    """
    answers = []
    for diagnostic in found:
        span = diagnostic.span
        related = [(r.message, r.span) for r in diagnostic.related]
        if span is None or span.source.name != document.source.name:
            if span is not None:
                related.insert(0, ("it stands here", span))
            span = _first_use(document, file)
        answers.append(
            types.Diagnostic(
                range=document.range(span),
                message=_words(diagnostic),
                severity=_SEVERITIES[diagnostic.severity],
                code=diagnostic.code,
                source="azee",
                related_information=[
                    types.DiagnosticRelatedInformation(location, message)
                    for message, place in related
                    if (location := locate(place)) is not None
                ],
            )
        )
    return answers


def _first_use(document: Document, file: File) -> Span:
    for item in file.items:
        if isinstance(item, Use):
            return item.span
    return Span(document.source, 0, 0)


def _words(diagnostic: Diagnostic) -> str:
    """Join message, label, notes and help, as the command line shows them, in lines."""
    lines = [diagnostic.message]
    if diagnostic.label:
        lines[0] += f" ({diagnostic.label})"
    lines += diagnostic.notes
    if diagnostic.help:
        lines.append(f"help: {diagnostic.help}")
    return "\n".join(lines)
