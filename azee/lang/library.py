"""Rule libraries: where they are, and which rules their files define."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache
from pathlib import Path

from azee.lang.places import declare_places, utterances
from azee.lang.resolve import Resolving
from azee.lang.rule import Rule, is_azop
from azee.lang.scope import Namespace, Scope
from azee_grammar.diagnostic import AZeeError, Diagnostic, Related
from azee_grammar.files import TEXT_SUFFIXES, is_file, is_folder, read_source
from azee_grammar.library import shipped, shipped_names
from azee_grammar.nearest import nearest
from azee_grammar.parser import Parsed, parse
from azee_grammar.source import Source
from azee_grammar.syntax import Definition, File, Use, Utterance

CORE = "core"
DEFAULT = "lsf"
"""The library in scope beside the core if a text uses none."""


@dataclass(eq=False)
class Library:
    """A namespace with the mistakes in its files."""

    namespace: Namespace
    diagnostics: list[Diagnostic] = field(default_factory=list)


def own_name(file: File) -> str | None:
    """Return the name of the rule in a file that has only an `azop`: the name of the file."""
    if len(file.items) != 1 or not isinstance(item := file.items[0], Utterance):
        return None
    if not is_azop(item.expr):
        return None
    return unicodedata.normalize("NFC", Path(item.span.source.name).stem)


def definitions(file: File) -> Iterator[Definition]:
    """Yield what a file defines, in order."""
    name = own_name(file)
    for item in file.items:
        if isinstance(item, Definition):
            yield item
        elif isinstance(item, Utterance) and name is not None:
            yield Definition(item.span, name, item.expr.span, (), item.expr)


def define(
    namespace: Namespace, found: Iterable[Definition], scope: Scope, resolving: Resolving
) -> Iterator[Diagnostic]:
    """Add rules to a namespace; yield `duplicate-definition` for names that exist."""
    for definition in found:
        other = namespace.rules.get(definition.name)
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
    ) -> None:
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
            others = [text for text in _texts(folder) if text != path]
        except OSError:
            return None
        if not others:
            return None
        return self._read(folder.name or folder.resolve().name, folder).namespace

    def _found(self, name: str, folder: Path | None) -> Library | None:
        if not _is_plain(name):
            return None
        for path in self._candidates(name, folder):
            if not _leads_outside(path, path.parent):
                return self._read(name, path)
        return shipped_library(name) if name in shipped_names() else None

    def _candidates(self, name: str, folder: Path | None) -> Iterator[Path]:
        """Yield the folders and texts of a plain name, the nearest first."""
        beside = () if folder is None else (folder, folder.parent)
        for place in (*beside, *self._folders):
            for path in (place / name, *(place / f"{name}{suffix}" for suffix in TEXT_SUFFIXES)):
                if is_folder(path) if path.name == name else is_file(path):
                    yield path

    def _outside(self, name: str, folder: Path | None) -> Path | None:
        """Return the first link of a name that is not followed."""
        return next(self._candidates(name, folder), None)

    def _read(self, name: str, path: Path) -> Library:
        if path in self._libraries:
            return self._libraries[path]
        library = Library(Namespace(name))
        self._libraries[path] = library
        is_whole = is_folder(path)
        folder = path if is_whole else path.parent
        try:
            files = _texts(path) if is_whole else [path]
        except OSError as problem:
            library.diagnostics.append(_unreadable(path, problem))
            return library
        library.diagnostics += _same_but_for_case(files)
        for file in files:
            if is_whole and (obstacle := _obstacle(file, path)):
                library.diagnostics.append(obstacle)
                continue
            try:
                source = self._read_source(file)
            except AZeeError as problem:
                library.diagnostics += problem.diagnostics
                continue
            self._add(library, source, folder)
        return library

    def _add(self, library: Library, source: Source, folder: Path) -> None:
        parsed = _parsed(source)
        library.diagnostics += parsed.diagnostics
        scope, problems = self.scope(library.namespace, parsed.file, folder)
        library.diagnostics += problems
        library.diagnostics += define(
            library.namespace, definitions(parsed.file), scope, self._resolving
        )
        library.diagnostics += declare_places(parsed.file, scope, self._resolving)

    def _missing(self, use: Use, folder: Path | None) -> Diagnostic:
        name = use.library.name
        found = [f"`'{candidate}`" for candidate in nearest(name, shipped_names())]
        if not _is_plain(name):
            hint = "a library has a plain name; `--library DIR` adds folders to look in"
        elif outside := self._outside(name, folder):
            hint = f"`{outside}` is a link that leads outside its folder, and is not followed"
        elif found:
            hint = f"did you mean {' or '.join(found)}?"
        else:
            hint = "it is looked for beside this file, in each `--library DIR`, and among " + (
                ", ".join(f"`'{known}`" for known in shipped_names())
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
        if _is_plain(path.name) and not _leads_outside(path, folder)
    ]
    texts = {path.stem for path in inside if path.suffix in TEXT_SUFFIXES and is_file(path)}
    return sorted(texts | {path.name for path in inside if is_folder(path) and _has_texts(path)})


def _is_plain(name: str) -> bool:
    return not name.startswith(".") and not any(c in '/\\:*?"<>|\0' for c in name)


def _texts(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if path.suffix in TEXT_SUFFIXES)


def _has_texts(folder: Path) -> bool:
    """Whether a folder is a library; what cannot be listed may be one, and is told when read."""
    try:
        return bool(_texts(folder))
    except OSError:
        return True


def _leads_outside(path: Path, folder: Path) -> bool:
    """Whether a path in a folder is a link to something that is not in it."""
    try:
        return path.is_symlink() and not path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError):  # links in a circle
        return True


def _obstacle(file: Path, library: Path) -> Diagnostic | None:
    """Return why a text in a folder library is not read: a link out of it, a pipe, a device."""
    if _leads_outside(file, library):
        message = f"`{file}` is a link that leads outside its library"
        return Diagnostic("cannot-read", message, None, help="copy the text into the folder")
    if file.exists() and not is_file(file) and not is_folder(file):
        return Diagnostic("cannot-read", f"`{file}` is not a plain file", None)
    return None


def _unreadable(folder: Path, problem: OSError) -> Diagnostic:
    reason = f": {problem.strerror.lower()}" if problem.strerror else ""
    return Diagnostic("cannot-read", f"cannot read the folder `{folder}`{reason}", None)


def _has_utterances(file: File) -> bool:
    return any(True for _ in utterances(file))


@lru_cache(maxsize=256)
def _parsed(source: Source) -> Parsed:
    """Parse a text of a library, once: each file of a folder that is checked reads the others."""
    return parse(source)


def _same_but_for_case(files: Sequence[Path]) -> Iterator[Diagnostic]:
    """Yield a diagnostic for files that some file systems cannot distinguish."""
    seen: dict[str, Path] = {}
    for path in files:
        name = unicodedata.normalize("NFC", path.stem).casefold()
        if name in seen:
            message = f"`{path}` and `{seen[name]}` have the same name but for case or suffix"
            yield Diagnostic("duplicate-definition", message, None)
        seen.setdefault(name, path)


# Shipped libraries ----------------------------------------------------------------------------

SHIPPED_RESOLVING = Resolving()
"""The scope that the shipped rules share; they are resolved once per process."""


@cache
def shipped_library(name: str) -> Library:
    """Return a library that ships. In scope of its rules are itself, its libraries and the core."""
    library = Library(Namespace(name))
    core = library.namespace if name == CORE else shipped_library(CORE).namespace
    for path in _texts(shipped() / name):
        source = Source(f"{name}/{path.name}", read_source(path).text)
        parsed = parse(source)
        library.diagnostics += parsed.diagnostics
        scope = Scope(library.namespace, core, shipped=_shipped_rules)
        for item in parsed.file.items:
            if isinstance(item, Use):
                scope.libraries.append(shipped_library(item.library.name).namespace)
        library.diagnostics += define(
            library.namespace, definitions(parsed.file), scope, SHIPPED_RESOLVING
        )
    return library


def _shipped_rules(name: str) -> Namespace | None:
    return shipped_library(name).namespace if name in shipped_names() else None
