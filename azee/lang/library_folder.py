"""The folders of libraries: which texts are in them, and which rules these define."""

from __future__ import annotations

import os
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from azee.lang.library_index import LibraryIndex, index_of
from azee.lang.rule import is_azop
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.files import TEXT_SUFFIXES, is_file, is_folder, read_source
from azee_grammar.kept_tree import parse_kept
from azee_grammar.parser import Parsed
from azee_grammar.source import Source
from azee_grammar.syntax import Definition, File, Utterance


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


@dataclass(frozen=True)
class Listing:
    """The texts of a folder that can be read, and what is wrong with the others or their names."""

    files: tuple[Path, ...]
    diagnostics: tuple[Diagnostic, ...]


class Shelf:
    """Folders as they were when first asked for: for as long as no file changes, as in one check.

    Several texts may share one, so that a folder is listed once for all its files.
    """

    def __init__(self) -> None:
        self._listings: dict[Path, Listing] = {}
        self._indices: dict[Path, LibraryIndex] = {}

    def listing(self, folder: Path) -> Listing:
        """Return the texts of a folder.

        Raises: OSError: it cannot be listed.
        """
        if folder not in self._listings:
            plain = _plain_files(folder)
            files = texts(folder)
            odd = {f: _obstacle(f, folder) for f in files if f.name not in plain}
            found = (*_same_but_for_case(files), *(o for o in odd.values() if o))
            readable = tuple(file for file in files if odd.get(file) is None)
            self._listings[folder] = Listing(readable, found)
        return self._listings[folder]

    def index(self, folder: Path) -> LibraryIndex:
        """Return the index of a folder that can be listed."""
        if folder not in self._indices:
            files = self.listing(folder).files
            self._indices[folder] = index_of(folder.resolve(), files, _parsed_or_none, definitions)
        return self._indices[folder]

    def keep(self) -> None:
        """Write what changed into the user's cache."""
        for index in self._indices.values():
            index.keep()


def _plain_files(folder: Path) -> set[str]:
    """Return the names of files that are neither links nor folders nor devices."""
    with os.scandir(folder) as entries:
        return {entry.name for entry in entries if entry.is_file(follow_symlinks=False)}


def _parsed_or_none(path: Path) -> Parsed | None:
    try:
        return parsed_text(read_source(path))
    except AZeeError:
        return None


def texts(folder: Path) -> list[Path]:
    """Return the texts in a folder, sorted. Raises: OSError: it cannot be listed."""
    names = (n for n in os.listdir(folder) if n.endswith(TEXT_SUFFIXES))  # noqa: PTH208 - faster
    return [folder / name for name in sorted(names) if name not in TEXT_SUFFIXES]


def leads_outside(path: Path, folder: Path) -> bool:
    """Whether a path in a folder is a link to something that is not in it."""
    try:
        return path.is_symlink() and not path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError):  # links in a circle
        return True


def _obstacle(file: Path, library: Path) -> Diagnostic | None:
    """Return why a text in a folder library is not read: a link out of it, a pipe, a device."""
    if leads_outside(file, library):
        message = f"`{file}` is a link that leads outside its library"
        return Diagnostic("cannot-read", message, None, help="copy the text into the folder")
    if file.exists() and not is_file(file) and not is_folder(file):
        return Diagnostic("cannot-read", f"`{file}` is not a plain file", None)
    return None


@lru_cache(maxsize=256)
def parsed_text(source: Source) -> Parsed:
    """Parse a text of a library, once: each file of a folder that is checked reads the others."""
    return parse_kept(source)


def _same_but_for_case(files: Sequence[Path]) -> Iterator[Diagnostic]:
    """Yield a diagnostic for files that some file systems cannot distinguish."""
    seen: dict[str, Path] = {}
    for path in files:
        name = unicodedata.normalize("NFC", path.stem).casefold()
        if name in seen:
            message = f"`{path}` and `{seen[name]}` have the same name but for case or suffix"
            yield Diagnostic("duplicate-definition", message, None)
        seen.setdefault(name, path)
