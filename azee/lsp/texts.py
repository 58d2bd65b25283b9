"""All texts of a server: those open in the editor, and those on the disk around them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from azee.lsp.analysis import Analysis, Sound, analyse
from azee.lsp.document import Document, uri_of
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.files import TEXT_SUFFIXES, read_source
from azee_grammar.library import shipped
from azee_grammar.source import Source

MOST_FILES = 2000
"""The most files of the open folders in which names are searched."""
_OF_TOOLS = frozenset({"node_modules", "__pycache__", "dist", "build", "out"})


class Texts:
    """The newest version of every text, and its analysis."""

    def __init__(self, libraries: Sequence[Path] = ()) -> None:
        self.libraries = tuple(path.absolute() for path in libraries)
        self.roots: tuple[Path, ...] = ()
        self.open: dict[str, Document] = {}
        self._analyses: dict[str, Analysis] = {}
        self._sound: dict[str, Sound] = {}
        self._paths: dict[Path, str] = {}

    # Changes --------------------------------------------------------------------------------

    def put(self, document: Document) -> None:
        """Take a new version of an open text."""
        new = document.uri not in self.open
        self.open[document.uri] = document
        if document.path is not None:
            self._paths[document.path] = document.uri
        self._forget(document.path, everything=new)

    def close(self, uri: str) -> None:
        """Return to the version on the disk."""
        document = self.open.pop(uri, None)
        if document is not None:
            self._paths.pop(document.path or Path(), None)
            self._sound.pop(uri, None)
            self._forget(document.path, everything=True)

    def disk_changed(self) -> None:
        """Forget all that was read."""
        self._analyses.clear()

    def _forget(self, path: Path | None, *, everything: bool) -> None:
        """Forget the analyses that depend on a text."""
        if everything:
            self._analyses.clear()
            return
        name = None if path is None else str(path)
        for uri, analysis in list(self._analyses.items()):
            names = (analysis.document.source.name, *(source.name for source in analysis.read))
            if name in names or uri not in self.open:
                del self._analyses[uri]

    # Queries --------------------------------------------------------------------------------

    def analysis(self, document: Document) -> Analysis:
        """Return the analysis of a text."""
        found = self._analyses.get(document.uri)
        if found is None or found.document.text != document.text:
            found = analyse(document, self.libraries, self._read)
            self._analyses[document.uri] = found
        return found

    def check(self, document: Document) -> tuple[Diagnostic, ...]:
        """Return all mistakes in a text."""
        before = self._sound.get(document.uri, Sound())
        diagnostics, self._sound[document.uri] = self.analysis(document).check(before)
        return diagnostics

    def users(self, document: Document) -> Iterator[Document]:
        """Yield the other open texts that use one."""
        name = document.source.name
        for other in list(self.open.values()):
            if other.uri != document.uri and any(
                source.name == name for source in self.analysis(other).read
            ):
                yield other

    def named(self, name: str) -> Document | None:
        """Return the text of a source's name: open, on the disk, or shipped."""
        if name in self.open:
            return self.open[name]
        path = Path(name)
        if not path.is_absolute():
            path = shipped() / path
        return self.at(path)

    def at(self, path: Path) -> Document | None:
        """Return the text of a file, from the editor or else from the disk."""
        if path in self._paths:
            return self.open[self._paths[path]]
        try:
            return Document(uri_of(path), read_source(path).text)
        except AZeeError:
            return None

    def all(self) -> Iterator[Document]:
        """Yield the open texts, then those of the open folders and of the libraries."""
        yield from list(self.open.values())
        seen = set(self._paths)
        left = MOST_FILES
        for root in (*self.roots, *self.libraries):
            for path in _files(root):
                if path not in seen and left > 0 and (document := self.at(path)):
                    left -= 1
                    seen.add(path)
                    yield document

    def _read(self, path: Path) -> Source:
        document = self.at(path)
        return read_source(path) if document is None else document.source


def _files(root: Path) -> Iterator[Path]:
    """Yield the AZee files below a folder, without hidden files and those of tools."""
    try:
        inside = sorted(root.iterdir())
    except OSError:
        return
    for path in inside:
        if path.suffix in TEXT_SUFFIXES and path.is_file():
            yield path
        elif path.is_dir() and not (path.is_symlink() or _is_hidden(path.name)):
            yield from _files(path)


def _is_hidden(name: str) -> bool:
    return name.startswith(".") or name in _OF_TOOLS
