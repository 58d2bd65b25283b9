"""What is known of the files of a library without reading them again.

The index of a folder is kept in the user's cache. It has, for each file, its size and time, the
rules that it defines, the names that it mentions, and whether it was sound when it was last
checked. A file stays sound until it changes, or a rule that it mentions appears, changes or goes.
So a library of thousands of rules is checked once, and a text that names three of them reads three.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from azee_grammar.cache import keep, kept
from azee_grammar.library import shipped
from azee_grammar.mentions import mentions
from azee_grammar.parser import Parsed
from azee_grammar.syntax import Definition, File, Use

_FOLDER = "libraries"
_FORMAT = 1


@dataclass(frozen=True, slots=True)
class IndexedFile:
    """A file of a library as it was read.

    stamp: its size in bytes and the time it changed. rules: those that it defines. mentions: names
    of rules in it. is_closed: whether it uses no library but those that ship.
    """

    stamp: tuple[int, int]
    rules: tuple[str, ...]
    mentions: frozenset[str]
    is_closed: bool
    is_sound: bool = False


class LibraryIndex:
    """The files of a folder by name, as they are now."""

    def __init__(self, folder: Path, files: dict[str, IndexedFile], stored: bool) -> None:
        self._folder = folder
        self._is_stored = stored
        self.files = files
        self.names: dict[str, str] = {}
        """The file of each rule; of a rule in several files, the first."""
        for name, file in files.items():
            for rule in file.rules:
                self.names.setdefault(rule, name)

    @property
    def unsound(self) -> list[str]:
        """The files that have to be read and checked, in order."""
        count = Counter(rule for file in self.files.values() for rule in file.rules)
        return [
            name
            for name, file in self.files.items()
            if not file.is_sound or any(count[rule] > 1 for rule in file.rules)
        ]

    def found_sound(self, names: Iterable[str]) -> None:
        """Note that files were checked and had no mistake."""
        for name in names:
            file = self.files.get(name)
            if file and file.is_closed and not file.is_sound:
                self.files[name] = replace(file, is_sound=True)
                self._is_stored = False

    def keep(self) -> None:
        """Write what changed into the user's cache."""
        if self._is_stored:
            return
        self._is_stored = True
        rows = {
            name: [file.stamp, file.rules, sorted(file.mentions), file.is_closed, file.is_sound]
            for name, file in self.files.items()
        }
        document = {"format": _FORMAT, "folder": str(self._folder), "files": rows}
        keep(_file(self._folder), json.dumps(document, separators=(",", ":")).encode())


def index_of(
    folder: Path,
    paths: Iterable[Path],
    read: Callable[[Path], Parsed | None],
    definitions: Callable[[File], Iterable[Definition]],
) -> LibraryIndex:
    """Return the index of the files in a folder; only those that changed are read.

    Args: read: parses a file; None if it cannot be read.
    """
    stored = _stored(folder)
    files: dict[str, IndexedFile] = {}
    changed: set[str] = set()
    for path in paths:
        stamp = _stamp(path)
        old = stored.get(path.name)
        if old is not None and old.stamp == stamp:
            files[path.name] = old
            continue
        files[path.name] = new = _indexed(stamp, read(path), definitions)
        changed.update(new.rules, () if old is None else old.rules)
    for name, old in stored.items():
        if name not in files:
            changed.update(old.rules)
    if changed:
        for name, file in files.items():
            if file.is_sound and not changed.isdisjoint(file.mentions):
                files[name] = replace(file, is_sound=False)
    return LibraryIndex(folder, files, stored=not changed and stored.keys() == files.keys())


def _indexed(
    stamp: tuple[int, int],
    parsed: Parsed | None,
    definitions: Callable[[File], Iterable[Definition]],
) -> IndexedFile:
    if parsed is None:
        return IndexedFile(stamp, (), frozenset(), is_closed=False)
    items = parsed.file.items
    rules = tuple(dict.fromkeys(d.name for d in definitions(parsed.file)))
    named = frozenset(name for item in items for name in mentions(item))
    closed = not any(isinstance(item, Use) for item in items)
    return IndexedFile(stamp, rules, named, closed and not parsed.diagnostics)


def _stamp(path: Path) -> tuple[int, int]:
    try:
        found = os.stat(path)  # noqa: PTH116 - thousands of files: Path.stat takes twice as long
    except OSError:
        return (-1, -1)
    return found.st_size, found.st_mtime_ns


def _stored(folder: Path) -> dict[str, IndexedFile]:
    data = kept(_file(folder))
    if data is None:
        return {}
    try:
        document = json.loads(data)
        if document["format"] != _FORMAT or document["folder"] != str(folder):
            return {}
        return {
            str(name): IndexedFile(
                (int(stamp[0]), int(stamp[1])),
                tuple(map(str, rules)),
                frozenset(map(str, named)),
                bool(closed),
                bool(sound),
            )
            for name, (stamp, rules, named, closed, sound) in document["files"].items()
        }
    except (ValueError, KeyError, TypeError, AttributeError, IndexError):
        return {}


def _file(folder: Path) -> str:
    digest = hashlib.sha256(f"{folder}\0".encode("utf-8", "surrogatepass") + _program_stamp())
    return f"{_FOLDER}/{digest.hexdigest()[:32]}.json"


@cache
def _program_stamp() -> bytes:
    """Return what a check depends on beside the library: this program and the rules that ship."""
    folders = (shipped(), Path(__file__).parent)
    found = sorted(
        (str(path), *_stamp(path))
        for folder in folders
        for path in folder.rglob("*")
        if path.suffix in (".py", ".azee", ".csv")
    )
    return hashlib.sha256(repr(found).encode("utf-8", "surrogatepass")).digest()
