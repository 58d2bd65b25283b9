"""Open texts with the positions of an editor: lines from 0, columns in UTF-16 code units."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from lsprotocol import types

from azee_grammar.source import Source, Span

_LINE_END = re.compile(r"\r\n|\r|\n")


@dataclass(frozen=True)
class Document:
    """A version of a text, with the two kinds of positions in it.

    The protocol's lines end with LF, CRLF or CR alone, unlike those of `str.splitlines`, and its
    columns count UTF-16 code units. Offsets count code points, as everywhere else in azee.
    """

    uri: str
    text: str
    version: int | None = None

    @cached_property
    def path(self) -> Path | None:
        """Its path, if it is a file."""
        return path_of(self.uri)

    @cached_property
    def source(self) -> Source:
        """The text as a source; a byte-order mark stays, so that offsets are right."""
        return Source(self.uri if self.path is None else str(self.path), self.text)

    @cached_property
    def _starts(self) -> tuple[int, ...]:
        return (0, *(end.end() for end in _LINE_END.finditer(self.text)))

    def position(self, offset: int) -> types.Position:
        """Return the position of a code point."""
        line = bisect_right(self._starts, offset) - 1
        return types.Position(line, _units(self.text[self._starts[line] : offset]))

    def offset(self, position: types.Position) -> int:
        """Return the code point at a position; beyond the end of a line, its end.

        Between the two halves of a surrogate pair, return their character.
        """
        if position.line >= len(self._starts):
            return len(self.text)
        start = self._starts[position.line]
        end = _LINE_END.search(self.text, start)
        line = self.text[start : end.start() if end else len(self.text)]
        if line.isascii():
            return start + min(position.character, len(line))
        left = position.character
        for at, character in enumerate(line):
            left -= _units(character)
            if left < 0:
                return start + at
        return start + len(line)

    def range(self, span: Span) -> types.Range:
        """Return the range of a span of this text."""
        return types.Range(self.position(span.start), self.position(span.end))

    @property
    def whole(self) -> types.Range:
        """The range of the whole text."""
        return types.Range(types.Position(0, 0), self.position(len(self.text)))

    def edited(
        self, changes: Iterable[types.TextDocumentContentChangeEvent], version: int | None
    ) -> Document:
        """Return the text after changes, each relative to the text after the one before."""
        document = self
        for change in changes:
            text = change.text
            if isinstance(change, types.TextDocumentContentChangePartial):
                start, end = (document.offset(p) for p in (change.range.start, change.range.end))
                text = document.text[:start] + text + document.text[max(start, end) :]
            document = Document(self.uri, text, version)
        return document


def _units(text: str) -> int:
    """Return the number of UTF-16 code units."""
    return len(text) if text.isascii() else len(text.encode("utf-16-le", "surrogatepass")) // 2


def path_of(uri: str) -> Path | None:
    """Return the path of a `file:` address.

    Return None for other addresses, such as those of unsaved texts, and for those that no file
    can have.
    """
    from pygls.uris import to_fs_path

    try:
        found = to_fs_path(uri) if uri.startswith("file:") else None
        path = None if found is None else Path(found)
        if path is None or not path.is_absolute():
            return None
        path.lstat()
    except (FileNotFoundError, NotADirectoryError, PermissionError):
        return path  # it may be made yet
    except (OSError, ValueError):  # no address, a NUL in the name, a name that is too long
        return None
    return path


def uri_of(path: Path) -> str:
    """Return the address of a file."""
    return path.absolute().as_uri()
