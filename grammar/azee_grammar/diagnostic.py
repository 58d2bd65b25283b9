"""Mistakes in a text, as plain data; `render` (render.py) makes them readable."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from azee_grammar.source import Span


class Severity(Enum):
    """How bad it is: an error stops the text from being used, a warning does not."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, slots=True)
class Related:
    """A further place that explains a mistake, such as a call on the rule call stack."""

    message: str
    span: Span


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One mistake: a stable kebab-case code, a message in the user's words, place and remedy.

    `span` is None if there is no text, as for a file that cannot be read. `label` follows the
    carets; `related` holds the rule call stack, innermost first.
    """

    code: str
    message: str
    span: Span | None
    label: str = ""
    notes: tuple[str, ...] = ()
    help: str | None = None
    related: tuple[Related, ...] = ()
    severity: Severity = field(default=Severity.ERROR)


class AZeeError(Exception):
    """The input has mistakes. Carries the diagnostics, which only the outermost caller prints."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__("; ".join(f"{d.code}: {d.message}" for d in diagnostics))
        self.diagnostics = diagnostics

    def __reduce__(self) -> tuple[type[AZeeError], tuple[Diagnostic, ...]]:
        """Pickle the diagnostics, from which the error is made again."""
        return type(self), self.diagnostics

    def _render_traceback_(self) -> list[str]:
        """Show the diagnostics in the place of a traceback; notebooks ask for this by its name."""
        from azee_grammar.render import render

        return [line for d in self.diagnostics for line in (*render(d).splitlines(), "")]
