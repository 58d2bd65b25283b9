"""The state of a session: rules that were typed or loaded, and the results so far."""

from __future__ import annotations

import textwrap
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from azee.assist.knowledge import Knowledge
from azee.lang.program import Program
from azee.lang.values import Value
from azee.repl.assembly import assemble, mistakes_in_files
from azee.repl.shelf import Shelf
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.layout import LayoutReader
from azee_grammar.parser import parse
from azee_grammar.source import Source
from azee_grammar.syntax import Definition, Expr, Item, Use, Utterance

LAST = "_"
"""`^_` is the last result at the prompt."""


@dataclass(frozen=True, slots=True)
class Evaluated:
    """An expression, as written and as parsed, and its value."""

    text: str
    expr: Expr
    value: Value
    evaluate_s: float


@dataclass(frozen=True, slots=True)
class Defined:
    """A rule was defined; it may replace another rule and may have mistakes."""

    name: str
    again: bool
    mistakes: tuple[Diagnostic, ...]


@dataclass(frozen=True, slots=True)
class Used:
    """A library is now in scope."""

    name: str


@dataclass(frozen=True, slots=True)
class Failed:
    """The input is at fault."""

    diagnostics: tuple[Diagnostic, ...]


@dataclass(frozen=True, slots=True)
class Reloaded:
    """Files changed; if they have mistakes, the versions before stay in use."""

    paths: tuple[Path, ...]
    mistakes: tuple[Diagnostic, ...]


Outcome = Evaluated | Defined | Used | Failed


class Session:
    """Evaluates typed input, with everything in scope that was typed and loaded before."""

    def __init__(self, folders: Sequence[Path] = ()) -> None:
        self.shelf = Shelf(tuple(folders))
        self.uses: dict[str, Use] = {}
        self.definitions: dict[str, Definition] = {}
        self.texts: dict[str, str] = {}
        """Texts of the definitions, as they were written."""
        self.files: list[Path] = []
        self.last: Evaluated | None = None
        self._count = 0
        self._refused: tuple[object, ...] = ()
        self.program = self._assembled(self.shelf)

    @property
    def knowledge(self) -> Knowledge:
        """The names that have a meaning at the prompt."""
        return Knowledge(self.program.scope, self.shelf.folders)

    @property
    def names(self) -> dict[str, Value]:
        """Values that an expression may name."""
        return {LAST: self.last.value} if self.last else {}

    def enter(self, text: str) -> Iterator[Outcome]:
        """Take typed input, item by item.

        After an interruption, the session is as it was before the item.
        """
        self._count += 1
        source = Source(f"<input {self._count}>", textwrap.dedent(text))
        parsed = parse(source)
        if parsed.diagnostics:
            yield Failed(parsed.diagnostics)
        for item in parsed.file.items:
            if not (isinstance(item, Definition) and item.body is None):
                try:
                    yield self._enter(item, _written(source, item))
                except AZeeError as error:
                    yield Failed(error.diagnostics)
                except KeyboardInterrupt:
                    self.program = self._assembled(self.shelf)  # caches may be half filled
                    raise

    def load(self, path: Path) -> tuple[Diagnostic, ...]:
        """Take the rules of a file, now and whenever it changes; return its mistakes.

        Raises: AZeeError: it cannot be read.
        """
        path = path.resolve()
        shelf = self.shelf.renewed()
        shelf.read(path)
        if path in self.files:
            self.files.remove(path)
        self.files.append(path)
        self.shelf, self.program = shelf, self._assembled(shelf)
        return mistakes_in_files(self.program)

    def refresh(self) -> Reloaded | None:
        """Read the files that have changed, unless that was tried already.

        If they have mistakes, the versions before stay in use.
        """
        changed = self.shelf.changed()
        if not changed:
            self._refused = ()
            return None
        shelf = self.shelf.renewed()
        program = self._assembled(shelf)
        mistakes = mistakes_in_files(program)
        if mistakes and not mistakes_in_files(self.program):
            state = tuple((path, _state(path)) for path in changed)
            if state == self._refused:
                return None
            self._refused = state
            return Reloaded(changed, mistakes)
        self.shelf, self.program, self._refused = shelf, program, ()
        return Reloaded(changed, mistakes)

    def reload(self) -> Reloaded:
        """Read every file again, changed or not; mistakes are reported again."""
        self._refused = ()
        return self.refresh() or Reloaded((), mistakes_in_files(self.program))

    def _enter(self, item: Item, text: str) -> Outcome:
        match item:
            case Use(library=library):
                return self._use(item, library.name)
            case Definition(name=name):
                again = name in self.definitions
                self.definitions[name] = item
                self.texts[name] = text
                self.program = self._assembled(self.shelf)
                rule = self.program.scope.own.rules[name]
                _ = rule.procedure
                return Defined(name, again, tuple(rule.diagnostics))
            case Utterance(expr=expr):
                began = time.perf_counter()
                value = self.program.result(expr, self.names)
                self.last = Evaluated(text, expr, value, time.perf_counter() - began)
                return self.last

    def _use(self, item: Use, name: str) -> Outcome:
        before = self.uses
        self.uses = {**before, name: item}
        program = self._assembled(self.shelf)
        lacking = tuple(d for d in program.found if d.span == item.library.span)
        if lacking:
            self.uses = before
            return Failed(lacking)
        self.program = program
        return Used(name)

    def _assembled(self, shelf: Shelf) -> Program:
        return assemble(self.uses.values(), self.definitions.values(), self.files, shelf)


def _state(path: Path) -> object:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


def _written(source: Source, item: Item) -> str:
    """Return the text of an item with the parentheses around it, which its span leaves out."""
    for layout in LayoutReader(source).items():
        start, end = layout.tokens[0].start, max(token.end for token in layout.tokens)
        if start <= item.span.start < end:
            return source.text[start:end]
    return item.span.text
