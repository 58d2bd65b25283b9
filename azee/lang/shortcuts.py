"""Shortcuts: expressions of a text for which a recorded sign is played instead.

Filhol and McDonald (2018, section 5) let an animator's own movement replace what a part of an AZee
expression would be synthesised to. A file of shortcuts has a line for each: a template, `=>`, and
what `recorded` plays:

    :bonjour => 'BONJOUR_03
    :info-about(?topic, :bien) => 'GOOD_NEWS 'language 'lsf

The syntax tree of an utterance is searched from its top down. The first line whose template matches
an expression replaces it, and nothing inside it is searched. What holes stand for cannot change a
recording.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from azee.lang.program import Program
from azee.lang.scope import Scope
from azee.lang.template import Template
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.format import one_line
from azee_grammar.parser import parse_expression
from azee_grammar.source import Source, Span
from azee_grammar.syntax import Application, Expr, Named

ARROW = "=>"


@dataclass(frozen=True, slots=True)
class Shortcut:
    """A line of a file of shortcuts: the template, and the application of `recorded`."""

    template: Template
    recording: Application

    @classmethod
    def read(cls, line: str, where: str) -> Shortcut:
        """Read a line. Raises: AZeeError: bad-shortcut, or a mistake in one of its sides."""
        left, arrow, right = line.rpartition(ARROW)
        if not (arrow and left.strip() and right.strip()):
            message = f"{where}: `{line.strip()}` is no shortcut"
            help_ = f"a line is a template, `{ARROW}` and a sign: `:bonjour {ARROW} 'BONJOUR`"
            raise AZeeError(Diagnostic("bad-shortcut", message, None, help=help_))
        expr, found = parse_expression(Source(where, f"recorded {right.strip()}"))
        if not isinstance(expr, Application):
            raise AZeeError(*found)
        return cls(Template.read(left.strip(), where), expr)


@dataclass(frozen=True, slots=True)
class Taken:
    """A shortcut that was taken: the expression, what its holes stand for, and the recording."""

    span: Span
    text: str
    template: str
    recording: str
    bindings: Mapping[str, str]

    def as_json(self) -> dict[str, object]:
        """Return it as the report's JSON has it."""
        return {
            "file": self.span.source.name,
            "line": self.span.line,
            "text": self.text,
            "template": self.template,
            "recording": self.recording,
            "bindings": dict(self.bindings),
        }


@dataclass(slots=True)
class Shortcuts:
    """Shortcuts in the order in which they are tried, and those that were taken so far."""

    shortcuts: Sequence[Shortcut]
    _taken: dict[Span, Taken] = field(init=False, default_factory=dict)

    @classmethod
    def read(cls, source: Source) -> Shortcuts:
        """Read a file of shortcuts; lines that begin with `#` are comments.

        Raises: AZeeError: all that is wrong with it.
        """
        found: list[Shortcut] = []
        wrong: list[Diagnostic] = []
        for number, line in enumerate(source.text.splitlines(), 1):
            if line.strip() and not line.lstrip().startswith("#"):
                try:
                    found.append(Shortcut.read(line, f"{source.name}:{number}"))
                except AZeeError as error:
                    wrong += error.diagnostics
        if wrong:
            raise AZeeError(*wrong)
        return cls(found)

    @property
    def taken(self) -> tuple[Taken, ...]:
        """Those that were taken, in the order of the text."""
        return tuple(sorted(self._taken.values(), key=lambda t: (t.span.source.name, t.span.start)))

    def on(self, program: Program) -> Program:
        """Return a program that takes these shortcuts wherever it evaluates an expression."""
        return replace(program, rewrite=self.applied)

    def applied(self, expr: Expr, scope: Scope) -> Expr:
        """Return an expression with recordings in place of what templates match."""
        for shortcut in self.shortcuts:
            match = shortcut.template.match(expr, scope)
            if match is not None:
                self._taken[expr.span] = Taken(
                    expr.span,
                    one_line(expr),
                    one_line(shortcut.template.expr),
                    one_line(shortcut.recording),
                    {name: one_line(bound) for name, bound in match.bindings.items()},
                )
                return _at(shortcut.recording, expr.span)
        if not isinstance(expr, Application):
            return expr
        operands = tuple(
            replace(part, value=self.applied(part.value, scope))
            if isinstance(part, Named)
            else self.applied(part, scope)
            for part in expr.operands
        )
        return replace(expr, operands=operands)


def _at(expr: Application, span: Span) -> Application:
    """Return a recording at the place of what it replaces, where mistakes are shown."""
    operands = tuple(replace(part, span=span) for part in expr.operands)
    return replace(expr, span=span, head=replace(expr.head, span=span), operands=operands)
