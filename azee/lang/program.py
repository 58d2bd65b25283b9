"""Programs: a text with its libraries, checked and evaluated."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path

from azee.lang.audit import audit
from azee.lang.discourse import unintroduced_places
from azee.lang.fault import Fault
from azee.lang.library import (
    CORE,
    SHIPPED_RESOLVING,
    Librarian,
    define,
    mistakes_in_shipped,
    shipped_library,
)
from azee.lang.library_folder import Shelf, definitions, own_name
from azee.lang.machine import DEFAULT_LIMITS, Limits, Machine
from azee.lang.places import declare_places, utterances
from azee.lang.recordings import Recordings
from azee.lang.resolve import Resolving
from azee.lang.rule import Rule
from azee.lang.scope import Namespace, Scope
from azee.lang.values import Kind, ScoreValue, Value
from azee.score.layout import in_sequence
from azee.score.score import Score
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity
from azee_grammar.files import is_file, read_source
from azee_grammar.parser import parse, parse_expression
from azee_grammar.source import Source, Span
from azee_grammar.syntax import Application, Expr, File, Item, RuleName, Utterance
from azee_solver.constraint import Origin
from azee_solver.geometry import Side

BETWEEN_UTTERANCES_S = Fraction(1)
NO_NAMES: Mapping[str, Value] = {}
_MOST_CALLS = 12
"""How many calls of a long rule call stack are kept: the innermost and the outermost half."""


@dataclass(frozen=True, slots=True)
class UtteranceScore:
    """An utterance of a text, or an expression, evaluated.

    warnings: of an expression; those of utterances are among what `Program.check` returns.
    """

    label: str
    score: Score
    span: Span
    warnings: tuple[Diagnostic, ...] = ()


@dataclass(frozen=True, eq=False)
class Program:
    """A text with the libraries it uses."""

    source: Source
    file: File
    scope: Scope
    librarian: Librarian
    resolving: Resolving
    limits: Limits
    found: tuple[Diagnostic, ...]
    """Mistakes in the text and its libraries that were found before resolving."""
    beside: Librarian
    """Has the library that the text is a file of; its mistakes count where its rules are used."""
    shelf: Shelf = field(default_factory=Shelf)
    shares_shelf: bool = False
    """Whether who loaded it keeps the indices of libraries, after several texts."""
    recordings: Recordings | None = None
    rewrite: Callable[[Expr, Scope], Expr] | None = None
    """What is done to an expression before it is resolved: shortcuts."""

    @property
    def utterances(self) -> tuple[UtteranceScore, ...]:
        """All utterances of the text, evaluated. Raises: AZeeError: all its mistakes."""
        self._require_sound(self.check())
        return self._evaluated

    def score(self, utterance: int | None = None, dominant: Side = Side.RIGHT) -> Score:
        """Return the score of one utterance, by its number from 1, or of all in sequence.

        Raises: AZeeError: all mistakes in the text, or `no-utterance`.
        """
        self._require_sound(self.check(dominant))
        scores = [u.score for u in self._evaluated]
        if utterance is not None:
            if not 1 <= utterance <= len(scores):
                raise AZeeError(self._no_utterance(utterance, len(scores)))
            return scores[utterance - 1]
        if not scores:
            raise AZeeError(self._no_utterance(None, 0))
        return scores[0] if len(scores) == 1 else in_sequence(scores, BETWEEN_UTTERANCES_S)

    def score_alone(self, utterance: int, dominant: Side = Side.RIGHT) -> Score:
        """Return the score of one utterance, by its number; mistakes in others do not matter.

        Raises: AZeeError: the mistakes in it and in all that it may use, or `no-utterance`.
        """
        items = [*self.utterance_items()]
        if not 1 <= utterance <= len(items):
            raise AZeeError(self._no_utterance(utterance, len(items)))
        wanted = items[utterance - 1]
        self._require_sound(self.check(dominant, sound=[x for x in items if x is not wanted]))
        found, _ = self._judged(wanted)
        assert found is not None, "nothing was reported, so there is a score"
        return found.score

    def check(
        self, dominant: Side = Side.RIGHT, *, sound: Container[Item] = ()
    ) -> tuple[Diagnostic, ...]:
        """Return all mistakes in the text, also in rules that nobody calls.

        Args: dominant: the hand with which orientations that exclude each other are searched.
            sound: definitions and utterances that are skipped. They had no mistake, and no rule
            that they depend on has changed since.
        """
        for rule in [*self._own_rules()]:
            if rule.definition not in sound:
                _ = rule.procedure
        items = [item for item in self.utterance_items() if item not in sound]
        found = [d for item in items for d in self.problems(item, dominant)]
        found += unintroduced_places(self.file, self.scope, self.resolving)
        tidy = _tidy((*self.found, *found, *self._rule_diagnostics()), self.source)
        self._note_sound(tidy)
        return tidy

    def _note_sound(self, found: Sequence[Diagnostic]) -> None:
        """Note which files of libraries have no mistake, so that they need not be checked again."""
        for library in (*self.librarian.libraries, *self.beside.libraries):
            library.note_sound()
        if not found and self.scope.siblings is not None:
            for library in self.beside.libraries:
                if library.namespace is self.scope.siblings and library.index is not None:
                    library.index.found_sound([Path(self.source.name).name])
        if not self.shares_shelf:
            self.shelf.keep()

    def problems(self, item: Utterance, dominant: Side = Side.RIGHT) -> tuple[Diagnostic, ...]:
        """Return the mistakes in one utterance of the text, in the order of discovery."""
        utterance, found = self._judged(item)
        if utterance is None:
            return found
        key = id(item), dominant
        if key not in self._audits:
            problems = audit(utterance.score, dominant, self._span_of, utterance.span)
            self._audits[key] = tuple(problems)
        return (*found, *self._audits[key])

    def evaluate(self, text: str, name: str = "<expression>") -> UtteranceScore:
        """Evaluate one expression, with the rules of the text in scope, to a score.

        Raises: AZeeError: all mistakes in the expression, or in rules that it uses.
        """
        expr, value = self._expression(Source(name, text))
        if not isinstance(value, ScoreValue):
            raise AZeeError(_not_a_score(value, expr))
        problems = audit(value.content, Side.RIGHT, self._span_of, expr.span)
        found = _tidy(problems, expr.span.source)
        self._require_sound(found)
        return UtteranceScore(_label(expr), value.content, expr.span, found)

    def value(self, text: str, name: str = "<expression>") -> Value:
        """Evaluate one expression, with the rules of the text in scope, to a value of any kind.

        Raises: AZeeError: all mistakes in the expression, or in rules that it uses.
        """
        return self._expression(Source(name, text))[1]

    def result(self, expr: Expr, names: Mapping[str, Value]) -> Value:
        """Evaluate a parsed expression, which may use the given values as `^name`.

        Mistakes in rules that it does not use do not matter.

        Raises: AZeeError: all mistakes in it, or in the rules that it uses.
        """
        found: list[Diagnostic] = []
        value = self._value(expr, found, names)
        if isinstance(value, ScoreValue):
            found += audit(value.content, Side.RIGHT, self._span_of, expr.span)
        if value is None and not found:  # it found a mistake in a rule
            found += self._rule_diagnostics()
        self._require_sound(_tidy(found, expr.span.source))
        assert value is not None, "nothing was reported, so there is a value"
        return value

    def _expression(self, source: Source) -> tuple[Expr, Value]:
        expr, diagnostics = parse_expression(source)
        found = list(diagnostics)
        value = None if expr is None else self._value(expr, found)
        found += self._rule_diagnostics()
        self._require_sound(_tidy(found, source))
        assert expr is not None
        assert value is not None, "nothing was reported, so there is a value"
        return expr, value

    @property
    def _evaluated(self) -> tuple[UtteranceScore, ...]:
        """The utterances that have a score."""
        judged = (self._judged(item) for item in self.utterance_items())
        return tuple(score for score, _ in judged if score is not None)

    def _judged(self, item: Utterance) -> tuple[UtteranceScore | None, tuple[Diagnostic, ...]]:
        """Evaluate an utterance, once."""
        if id(item) not in self._scores:
            found: list[Diagnostic] = []
            score = self._utterance(item.expr, found)
            self._scores[id(item)] = score, tuple(found)
        return self._scores[id(item)]

    @cached_property
    def _scores(self) -> dict[int, tuple[UtteranceScore | None, tuple[Diagnostic, ...]]]:
        return {}

    @cached_property
    def _audits(self) -> dict[tuple[int, Side], tuple[Diagnostic, ...]]:
        return {}

    def utterance_items(self) -> Iterator[Utterance]:
        """Yield the utterances of the text as they are written, in order."""
        if own_name(self.file) is None:
            yield from utterances(self.file)

    def _own_rules(self) -> Iterator[Rule]:
        for namespace in (self.scope.own, *(x.namespace for x in self.librarian.libraries)):
            yield from namespace.read.values()

    def _rule_diagnostics(self) -> Iterator[Diagnostic]:
        """Yield the mistakes in rules, also in shipped rules if they were used."""
        for rule in self._own_rules():
            yield from rule.diagnostics
        beside = (library.namespace for library in self.beside.libraries)
        for namespace in (*beside, self.scope.core, *self.scope.libraries):
            for rule in namespace.read.values():
                yield from rule.diagnostics

    def _utterance(self, expr: Expr, diagnostics: list[Diagnostic]) -> UtteranceScore | None:
        value = self._value(expr, diagnostics)
        if isinstance(value, ScoreValue):
            return UtteranceScore(_label(expr), value.content, expr.span)
        if value is not None:
            diagnostics.append(_not_a_score(value, expr))
        return None

    def _value(
        self, expr: Expr, diagnostics: list[Diagnostic], names: Mapping[str, Value] = NO_NAMES
    ) -> Value | None:
        """Resolve and evaluate; None after a mistake, which is then reported."""
        resolver = self.resolving.resolver(self.scope, None, diagnostics)
        if self.rewrite is not None:
            expr = self.rewrite(expr, self.scope)
        code = resolver.resolve(expr, frozenset(names))
        try:
            return code.evaluate(Machine(self.limits, self.scope.libraries, self.recordings), names)
        except Fault as problem:
            diagnostics += problem.diagnostics
            diagnostics += mistakes_in_shipped()
            return None

    def _span_of(self, origin: Origin) -> Span | None:
        return self.resolving.spans.get(origin) or SHIPPED_RESOLVING.spans.get(origin)

    def _require_sound(self, diagnostics: Sequence[Diagnostic]) -> None:
        errors = [d for d in diagnostics if d.severity is Severity.ERROR]
        if errors:
            raise AZeeError(*errors)

    def _no_utterance(self, wanted: int | None, count: int) -> Diagnostic:
        if wanted is None:
            message = f"`{self.source.name}` has no utterance, only definitions"
            hint = "an utterance is an expression without indentation, such as `:arbre`"
            if not self.file.items:
                message = f"`{self.source.name}` has no utterance: it is empty"
        else:
            message = f"`{self.source.name}` has no utterance {wanted}"
            hint = f"it has {count}" if count else "it has only definitions"
        return Diagnostic("no-utterance", message, None, help=hint)


def load(
    source: Source,
    libraries: Sequence[Path] = (),
    limits: Limits = DEFAULT_LIMITS,
    read: Callable[[Path], Source] = read_source,
    place: Path | None = None,
    shelf: Shelf | None = None,
    recordings: Recordings | None = None,
) -> Program:
    """Parse a text and the libraries it uses; nothing is evaluated yet.

    `Program.check` returns the mistakes.

    Args: libraries: folders in which `use` looks, after the folder of the text.
        read: reads the texts of libraries; an editor has newer versions than the disk.
        place: the file of the text, by default the one of the source's name, if it exists.
        shelf: the indices of libraries, if several texts are read while no file changes.
        recordings: where `recorded` finds signs.
    """
    parsed = parse(source)
    shared = shelf is not None
    shelf = shelf or Shelf()
    resolving = Resolving(Machine(limits, recordings=recordings))
    core = shipped_library(CORE).namespace
    librarian = Librarian(tuple(libraries), resolving, core, read, shelf)
    namespace = Namespace(None)
    path = place
    if path is None and is_file(named := Path(source.name)):
        path = named
    scope, problems = librarian.scope(namespace, parsed.file, path and path.parent)
    beside = Librarian(tuple(libraries), resolving, core, read, shelf)
    if path is not None:
        scope.siblings = beside.siblings(parsed.file, path)
    duplicates = list(define(namespace, definitions(parsed.file), scope, resolving))
    misplaced = declare_places(parsed.file, scope, resolving)
    found = (*parsed.diagnostics, *problems, *duplicates, *misplaced)
    in_libraries = tuple(d for library in librarian.libraries for d in library.diagnostics)
    if not shared:
        shelf.keep()
    return Program(
        source,
        parsed.file,
        scope,
        librarian,
        resolving,
        limits,
        (*found, *in_libraries),
        beside,
        shelf,
        shared,
        recordings,
    )


def evaluate_expression(
    text: str, libraries: Sequence[Path] = (), name: str = "<expression>"
) -> UtteranceScore:
    """Evaluate one expression with the core and the default library in scope.

    Raises: AZeeError: all its mistakes.
    """
    return load(Source("<none>", ""), libraries).evaluate(text, name)


def _label(expr: Expr) -> str:
    """Return the name of an utterance for pictures and reports."""
    if isinstance(expr, Application):
        head = expr.head
        return f":{head.name}" if isinstance(head, RuleName) else head.name
    return expr.span.text.split("\n")[0][:40]


def _not_a_score(value: Value, expr: Expr) -> Diagnostic:
    hints = {
        Kind.CONSTRAINTS: "`key D CSTR` makes a score of them",
        Kind.OPERATOR: "`:name` applies a rule, `.name` only hands it over",
        Kind.LIST: "`seq` plays a list of scores",
    }
    span = expr.head.span if isinstance(expr, Application) else expr.span
    message = f"an utterance is a score, and this is {value.kind.value}"
    return Diagnostic("not-a-score", message, span, help=hints.get(value.kind))


def _tidy(diagnostics: Iterable[Diagnostic], first: Source) -> tuple[Diagnostic, ...]:
    """Drop repetitions, shorten long call stacks, and sort by place, the text itself first."""
    distinct: dict[tuple[str, str, Span | None], Diagnostic] = {}
    for diagnostic in diagnostics:
        key = (diagnostic.code, diagnostic.message, diagnostic.span)
        distinct.setdefault(key, _shortened(diagnostic))
    return tuple(sorted(distinct.values(), key=lambda d: _place(d, first)))


def _place(diagnostic: Diagnostic, first: Source) -> tuple[bool, str, int]:
    span = diagnostic.span
    if span is None:
        return (False, "", 0)
    return (span.source.name != first.name, span.source.name, span.start)


def _shortened(diagnostic: Diagnostic) -> Diagnostic:
    calls = diagnostic.related
    if len(calls) <= _MOST_CALLS:
        return diagnostic
    half = _MOST_CALLS // 2
    note = f"{len(calls) - _MOST_CALLS} more calls in between are left out"
    return replace(
        diagnostic,
        related=(*calls[:half], *calls[-half:]),
        notes=(*diagnostic.notes, note),
    )
