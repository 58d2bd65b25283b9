"""The rule files that a session has read, as they were when it read them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from azee_grammar.files import TEXT_SUFFIXES, read_source
from azee_grammar.source import Source

Stamp = tuple[int, int]


@dataclass(slots=True, eq=False)
class Shelf:
    """Texts by path, with time and size, which show whether the file has changed since.

    A text stays as it was read while the shelf is used, so that a session can use the last version
    without mistakes. For folders with rules, the names of the texts are stored.
    """

    folders: tuple[Path, ...] = ()
    _sources: dict[Path, Source] = field(default_factory=dict)
    _stamps: dict[Path, Stamp | None] = field(default_factory=dict)
    _listings: dict[Path, frozenset[str]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for folder in self.folders:
            self._listings[folder] = _listing(folder)

    def read(self, path: Path) -> Source:
        """Return the text of a file. Raises: AZeeError: it cannot be read."""
        if path not in self._sources:
            self._stamps[path] = _stamp(path)
            self._sources[path] = read_source(path)
            self._listings.setdefault(path.parent, _listing(path.parent))
        return self._sources[path]

    def changed(self) -> tuple[Path, ...]:
        """Return the files that have changed, and the folders whose files are others now."""
        files = (path for path, stamp in self._stamps.items() if _stamp(path) != stamp)
        folders = (path for path, names in self._listings.items() if _listing(path) != names)
        return (*files, *folders)

    def renewed(self) -> Shelf:
        """Return a shelf for another reading, which already has the unchanged texts."""
        shelf = Shelf(self.folders)
        changed = set(self.changed())
        for path, source in self._sources.items():
            if path not in changed:
                shelf._sources[path] = source
                shelf._stamps[path] = self._stamps[path]
                shelf._listings.setdefault(path.parent, _listing(path.parent))
        return shelf


def _stamp(path: Path) -> Stamp | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


def _listing(folder: Path) -> frozenset[str]:
    """Return the names of the rule texts and folders in a folder, as far as it can be read."""
    try:
        inside: Iterable[Path] = list(folder.iterdir())
        return frozenset(p.name for p in inside if p.suffix in TEXT_SUFFIXES or p.is_dir())
    except OSError:
        return frozenset()
