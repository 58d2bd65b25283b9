"""Rule libraries: where they are, and which rules their files define."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from azee.lang.lazy_rules import LazyRules
from azee.lang.library_folder import Shelf, definitions, leads_outside, own_name, parsed_text, texts
from azee.lang.library_index import LibraryIndex
from azee.lang.places import declare_places, utterances
from azee.lang.resolve import Resolving
from azee.lang.rule import Rule
from azee.lang.scope import Namespace, Scope
from azee_grammar.diagnostic import AZeeError, Diagnostic, Related
from azee_grammar.files import TEXT_SUFFIXES, is_file, is_folder, read_source
from azee_grammar.installed import installed_library, installed_names
from azee_grammar.library import shipped, shipped_names
from azee_grammar.nearest import nearest
from azee_grammar.source import Source, Span
from azee_grammar.syntax import Definition, File, Use

CORE = "core"
DEFAULT = "lsf"
"""The library in scope beside the core if a text uses none."""


@dataclass(eq=False)
class Library:
    """A namespace with the mistakes in its files."""

    namespace: Namespace
    diagnostics: list[Diagnostic] = field(default_factory=list)
    index: LibraryIndex | None = None
    """What is known of its files, if they are read when their rules are named."""

    def note_sound(self) -> None:
        """Note in the index which of the files that were read and checked have no mistake."""
        if self.index is None:
            return
        faulty = {d.span.source.name for d in self.diagnostics if d.span}
        files: dict[str, bool] = {}
        for rule in self.namespace.read.values():
            name = rule.definition.span.source.name
            sound = rule.is_resolved and not rule.diagnostics and name not in faulty
            files[name] = files.get(name, True) and sound
        self.index.found_sound(Path(name).name for name, sound in files.items() if sound)


def define(
    namespace: Namespace, found: Iterable[Definition], scope: Scope, resolving: Resolving
) -> Iterator[Diagnostic]:
    """Add rules to a namespace; yield `duplicate-definition` for names that exist."""
    for definition in found:
        other = namespace.read.get(definition.name)
        if other is None:
            rule = Rule(definition, namespace.name, scope, resolving)
            namespace.rules[definition.name] = rule
            continue
        yield Diagnostic(
            "duplicate-definition",
            f"there are two rules `{definition.name}`",
            definition.name_span,
            related=(Related("the first is defined", other.definition.name_span),),
        )


def _vanished(name: str, file: Path, library: Library, resolving: Resolving) -> Rule:
    """Return what stands for a rule whose file changed since it was indexed."""
    source = Source(str(file), "")
    span = Span(source, 0, 0)
    message = f"`{file}` changed while it was read: it has no rule `{name}` any more"
    found = [Diagnostic("cannot-read", message, None, help="run it again")]
    scope = Scope(library.namespace, Namespace(None))
    return Rule(
        Definition(span, name, span, (), None), library.namespace.name, scope, resolving, found
    )


class Librarian:
    """Finds and reads libraries, each once.

    A library is a folder of texts, or one text. It is looked up beside the text that uses it, then
    in each of the given folders, then among the libraries that ship. Names are plain, so no text
    reads elsewhere.
    """

    def __init__(
        self,
        folders: Sequence[Path],
        resolving: Resolving,
        core: Namespace,
        read: Callable[[Path], Source] = read_source,
        shelf: Shelf | None = None,
    ) -> None:
        self._shelf = shelf or Shelf()
        self._folders = folders
        self._read_source = read
        self._resolving = resolving
        self._core = core
        self._libraries: dict[Path, Library] = {}

    @property
    def libraries(self) -> Iterable[Library]:
        """All libraries that were read."""
        return self._libraries.values()

    def scope(
        self, namespace: Namespace, file: File, folder: Path | None
    ) -> tuple[Scope, list[Diagnostic]]:
        """Return the scope of a text: its own rules, the libraries it uses, the core.

        Without any `use`, the default library is in scope.
        """
        scope = Scope(namespace, self._core, shipped=_shipped_rules)
        problems: list[Diagnostic] = []
        uses = [item for item in file.items if isinstance(item, Use)]
        for use in uses:
            library = self._found(use.library.name, folder)
            if library is None:
                problems.append(self._missing(use, folder))
            elif library.namespace is not namespace:
                scope.libraries.append(library.namespace)
        default = shipped_library(DEFAULT).namespace
        if not uses:
            scope.libraries.append(default)
        elif default not in scope.libraries and namespace is not default:
            scope.dropped = default
        return scope, problems

    def siblings(self, file: File, path: Path) -> Namespace | None:
        """Return the rules of the folder library that a text is a file of.

        A text that only defines rules is such a file if there are others beside it. One with
        utterances is not: what lies beside it cannot change what it means.
        """
        if not file.items or (own_name(file) is None and _has_utterances(file)):
            return None
        folder = path.parent
        try:
            others = [text for text in self._shelf.listing(folder).files if text != path]
        except OSError:
            return None
        if not others:
            return None
        name = folder.name or folder.resolve().name
        return self._read(name, folder, check=False).namespace

    def _found(self, name: str, folder: Path | None) -> Library | None:
        if not _is_plain(name):
            return None
        for path in self._candidates(name, folder):
            if not leads_outside(path, path.parent):
                return self._read(name, path)
        if name in shipped_names():
            return shipped_library(name)
        installed = installed_library(name)
        return (
            None if installed is None else self._read(name, installed, check=False, installed=True)
        )

    def _candidates(self, name: str, folder: Path | None) -> Iterator[Path]:
        """Yield the folders and texts of a plain name, the nearest first."""
        beside = () if folder is None else (folder, folder.parent)
        for place in (*beside, *self._folders):
            for path in (place / name, *(place / f"{name}{suffix}" for suffix in TEXT_SUFFIXES)):
                if (is_folder(path) and _has_texts(path)) if path.name == name else is_file(path):
                    yield path

    def _outside(self, name: str, folder: Path | None) -> Path | None:
        """Return the first link of a name that is not followed."""
        return next(self._candidates(name, folder), None)

    def _read(
        self, name: str, path: Path, *, check: bool = True, installed: bool = False
    ) -> Library:
        """Read a library, once.

        Args: check: whether mistakes in rules that nobody names count. installed: whether no
            editor has newer texts of it than the disk.
        """
        if path in self._libraries:
            return self._libraries[path]
        library = Library(Namespace(name))
        self._libraries[path] = library
        files: Sequence[Path] = [path]
        folder = path.parent
        if is_folder(path):
            folder = path
            try:
                listing = self._shelf.listing(path)
            except OSError as problem:
                library.diagnostics.append(_unreadable(path, problem))
                return library
            library.diagnostics += listing.diagnostics
            files = listing.files
            if self._read_source is read_source or installed:
                files = self._indexed(library, path, check=check)
        for file in files:
            try:
                source = self._read_source(file)
            except AZeeError as problem:
                library.diagnostics += problem.diagnostics
                continue
            self._add(library, source, folder)
        return library

    def _indexed(self, library: Library, folder: Path, *, check: bool) -> list[Path]:
        """Let the rules of a folder be read when they are named; return the files to read now."""
        index = self._shelf.index(folder)
        library.index = index

        def load(file: str, name: str) -> None:
            try:
                self._add(library, read_source(folder / file), folder)
            except AZeeError as problem:
                library.diagnostics += problem.diagnostics
            if name not in rules.read:
                rules[name] = _vanished(name, folder / file, library, self._resolving)

        rules = LazyRules(index.names, load)
        library.namespace.rules = rules
        return [folder / name for name in index.unsound] if check else []

    def _add(self, library: Library, source: Source, folder: Path) -> None:
        parsed = parsed_text(source)
        library.diagnostics += parsed.diagnostics
        scope, problems = self.scope(library.namespace, parsed.file, folder)
        library.diagnostics += problems
        library.diagnostics += define(
            library.namespace, definitions(parsed.file), scope, self._resolving
        )
        library.diagnostics += declare_places(parsed.file, scope, self._resolving)

    def _missing(self, use: Use, folder: Path | None) -> Diagnostic:
        name = use.library.name
        known = (*shipped_names(), *installed_names())
        found = [f"`'{candidate}`" for candidate in nearest(name, known)]
        if not _is_plain(name):
            hint = "a library has a plain name; `--library DIR` adds folders to look in"
        elif outside := self._outside(name, folder):
            hint = f"`{outside}` is a link that leads outside its folder, and is not followed"
        elif found:
            hint = f"did you mean {' or '.join(found)}?"
        else:
            hint = "it is looked for beside this file, in each `--library DIR`, and among " + (
                ", ".join(f"`'{library}`" for library in known)
            )
        message = f"there is no library `'{name}`"
        return Diagnostic("library-not-found", message, use.library.span, help=hint)


def names_in(folder: Path) -> list[str]:
    """Return the names of the libraries in a folder, sorted, as `use` takes them.

    Raises: OSError: the folder cannot be read.
    """
    inside = [
        path
        for path in folder.iterdir()
        if _is_plain(path.name) and not leads_outside(path, folder)
    ]
    texts = {path.stem for path in inside if path.suffix in TEXT_SUFFIXES and is_file(path)}
    return sorted(texts | {path.name for path in inside if is_folder(path) and _has_texts(path)})


def _is_plain(name: str) -> bool:
    return not name.startswith(".") and not any(c in '/\\:*?"<>|\0' for c in name)


def _has_texts(folder: Path) -> bool:
    """Whether a folder is a library; what cannot be listed may be one, and is told when read."""
    try:
        return bool(texts(folder))
    except OSError:
        return True


def _unreadable(folder: Path, problem: OSError) -> Diagnostic:
    reason = f": {problem.strerror.lower()}" if problem.strerror else ""
    return Diagnostic("cannot-read", f"cannot read the folder `{folder}`{reason}", None)


def _has_utterances(file: File) -> bool:
    return any(True for _ in utterances(file))


# Shipped libraries ----------------------------------------------------------------------------

SHIPPED_RESOLVING = Resolving()
"""The scope that the shipped rules share; they are resolved once per process."""


_SHIPPED: dict[str, Library] = {}


def shipped_library(name: str) -> Library:
    """Return a library that ships. In scope of its rules are itself, its libraries and the core."""
    if name not in _SHIPPED:
        _SHIPPED[name] = _indexed_shipped(name)
    return _SHIPPED[name]


def mistakes_in_shipped() -> Iterator[Diagnostic]:
    """Yield the mistakes in what was read of the libraries that ship; there are none unless edited.

    Each says which library it is in.
    """
    for name, library in [*_SHIPPED.items()]:
        found = [*library.diagnostics]
        found += (d for rule in library.namespace.read.values() for d in rule.diagnostics)
        note = f"`'{name}` is a library that ships with azee; has its file been changed?"
        for diagnostic in found:
            yield replace(diagnostic, notes=(*diagnostic.notes, note))


def _indexed_shipped(name: str) -> Library:
    folder = shipped() / name
    shelf = Shelf()
    library = Library(Namespace(name), index=shelf.index(folder))
    core = library.namespace if name == CORE else shipped_library(CORE).namespace
    assert library.index is not None

    def load(file: str, _: str) -> None:
        source = Source(f"{name}/{file}", read_source(folder / file).text)
        parsed = parsed_text(source)
        library.diagnostics += parsed.diagnostics
        scope = Scope(library.namespace, core, shipped=_shipped_rules)
        for item in parsed.file.items:
            if isinstance(item, Use):
                scope.libraries.append(shipped_library(item.library.name).namespace)
        library.diagnostics += define(
            library.namespace, definitions(parsed.file), scope, SHIPPED_RESOLVING
        )

    library.namespace.rules = LazyRules(library.index.names, load)
    shelf.keep()
    return library


def _shipped_rules(name: str) -> Namespace | None:
    return shipped_library(name).namespace if name in shipped_names() else None
