"""Makes one program of the typed input and the loaded files."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from azee.lang.library import CORE, Librarian, define, shipped_library
from azee.lang.library_folder import definitions
from azee.lang.machine import DEFAULT_LIMITS, Machine
from azee.lang.places import declare_places
from azee.lang.program import Program
from azee.lang.resolve import Resolving
from azee.lang.scope import Namespace
from azee.repl.shelf import Shelf
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity
from azee_grammar.parser import parse
from azee_grammar.source import Source, Span
from azee_grammar.syntax import Definition, File, Item, Use

PROMPT = Source("<prompt>", "")


def assemble(
    uses: Iterable[Use], typed: Iterable[Definition], files: Sequence[Path], shelf: Shelf
) -> Program:
    """Return the program in whose scope the prompt evaluates.

    Rules that were typed win over those of files, later files over earlier ones. A rule of a file
    keeps the file's scope. The libraries that files use are in scope at the prompt too; if no
    file uses any, the default library is.
    """
    resolving = Resolving(Machine(DEFAULT_LIMITS))
    core = shipped_library(CORE).namespace
    librarian = Librarian(shelf.folders, resolving, core, shelf.read)
    beside = Librarian(shelf.folders, resolving, core, shelf.read)
    own = Namespace(None)
    uses, typed = tuple(uses), tuple(typed)
    items: tuple[Item, ...] = (*uses, *typed)
    found: list[Diagnostic] = []

    from_files = Namespace(None)
    libraries: list[Namespace] = []
    files_use = False
    for path in files:
        try:
            parsed = parse(shelf.read(path))
        except AZeeError as problem:
            found += problem.diagnostics
            continue
        namespace = Namespace(None)
        scope, problems = librarian.scope(namespace, parsed.file, path.parent)
        scope.siblings = beside.siblings(parsed.file, path)
        duplicates = list(define(namespace, definitions(parsed.file), scope, resolving))
        misplaced = declare_places(parsed.file, scope, resolving)
        found += (*parsed.diagnostics, *problems, *duplicates, *misplaced)
        from_files.rules.update(namespace.rules)
        if any(isinstance(item, Use) for item in parsed.file.items):
            files_use = True
            libraries += scope.libraries

    default = _default(librarian)
    scope, problems = librarian.scope(own, File(Span(PROMPT, 0, 0), uses), Path.cwd())
    if uses and not files_use:
        scope.libraries += default
        scope.dropped = None
    found += (*problems, *define(own, typed, scope, resolving))
    own.rules = {**from_files.rules, **own.rules}
    if files_use and not uses:
        scope.libraries.clear()
        scope.dropped = None if default[0] in libraries else default[0]
    scope.libraries += libraries
    in_libraries = [d for library in librarian.libraries for d in library.diagnostics]
    file = File(Span(PROMPT, 0, 0), items)
    return Program(
        PROMPT,
        file,
        scope,
        librarian,
        resolving,
        DEFAULT_LIMITS,
        (*found, *in_libraries),
        beside,
    )


def _default(librarian: Librarian) -> list[Namespace]:
    """Return what is in scope where nothing is used."""
    return librarian.scope(Namespace(None), File(Span(PROMPT, 0, 0), ()), None)[0].libraries


def mistakes_in_files(program: Program) -> tuple[Diagnostic, ...]:
    """Return the errors of a program that do not stand in what was typed."""
    return tuple(
        d
        for d in program.check()
        if d.severity is Severity.ERROR
        and not (d.span is not None and d.span.source.name.startswith("<"))
    )
