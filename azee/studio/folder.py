"""The folder that a studio has open: its texts by name, read, and saved without losing anything.

A name is a path relative to the folder, with `/` between its parts. Whatever a name looks like and
wherever links lead, nothing outside the folder is read or written.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from azee.export.files import replace_file
from azee_grammar.diagnostic import AZeeError
from azee_grammar.files import TEXT_SUFFIXES, decode

FILM_SUFFIXES = (".mp4", ".webm", ".ogv", ".mov")
"""Films that may be shown beside the signer."""
LARGEST_TEXT = 1_000_000
"""Bytes; what a page can edit. Texts of corpora are a hundredth of it."""
MOST_FILES = 5_000
_DEEPEST = 8
_BOM = b"\xef\xbb\xbf"
_TOOLS = frozenset({"node_modules", "__pycache__"})


class RefusedError(Exception):
    """Something that a page may not have or do. status: of HTTP. The message is for people."""

    def __init__(self, status: int, message: str) -> None:
        super().__init__(message)
        self.status, self.message = status, message


class ConflictError(Exception):
    """A file is not as it was when it was read. stored: what it is now; none where it is gone."""

    def __init__(self, stored: Stored | None) -> None:
        super().__init__("the file has changed on the disk")
        self.stored = stored


@dataclass(frozen=True, slots=True)
class Stored:
    """A text as the disk has it. text: its lines end with LF. digest: of its bytes."""

    text: str
    digest: str
    bom: bool = False
    crlf: bool = False


class Folder:
    """A folder with the texts and films in it.

    Args: root: must exist; links in its own path are followed.
    """

    def __init__(self, root: Path) -> None:
        self.root = root.resolve(strict=True)

    def path(self, name: str, suffixes: tuple[str, ...] = TEXT_SUFFIXES) -> Path:
        """Return the path of a name.

        Raises: RefusedError: it is none, or leads out of the folder.
        """
        parts = name.split("/")
        odd = any(p in ("", ".", "..") or p.startswith(".") or p in _TOOLS for p in parts)
        if odd or len(parts) > _DEEPEST or re.search(r"[\\:\x00-\x1f\x7f\ud800-\udfff]", name):
            raise RefusedError(400, "that is no name of a file in this folder")
        if any(len(part.encode()) > 200 for part in parts):
            raise RefusedError(400, "that name is too long")
        if not name.lower().endswith(suffixes):
            raise RefusedError(400, f"names of such files end with {' or '.join(suffixes)}")
        try:
            path = (self.root / name).resolve()
        except (OSError, ValueError, RuntimeError) as error:  # links in a circle
            raise RefusedError(400, "that is no name of a file in this folder") from error
        if not path.is_relative_to(self.root):
            raise RefusedError(403, "that file is outside the folder")
        return path

    def name(self, path: Path) -> str | None:
        """Return the name of a path; None if it is not one of a text in the folder."""
        try:
            name = path.relative_to(self.root).as_posix()
            return name if self.path(name) == path.resolve() else None
        except (ValueError, RefusedError, OSError):
            return None

    def names(self, suffixes: tuple[str, ...] = TEXT_SUFFIXES) -> list[str]:
        """Return the names of all texts, in order; at most `MOST_FILES`."""
        found = []
        for name in self._below(self.root, "", _DEEPEST, suffixes):
            found.append(name)
            if len(found) >= MOST_FILES:
                break
        return found

    def _below(
        self, folder: Path, before: str, depth: int, suffixes: tuple[str, ...]
    ) -> Iterator[str]:
        try:
            inside = sorted(folder.iterdir(), key=lambda path: (path.is_dir(), path.name))
        except OSError:
            return
        for path in inside:
            name = f"{before}{path.name}"
            if path.name.startswith(".") or path.name in _TOOLS:
                continue
            if path.is_dir() and not path.is_symlink() and depth > 1:
                yield from self._below(path, f"{name}/", depth - 1, suffixes)
            elif name.lower().endswith(suffixes) and path.is_file():
                try:
                    self.path(name, suffixes)
                except RefusedError:
                    continue
                yield name

    def read(self, name: str) -> Stored:
        """Return a text. Raises: RefusedError: there is none, or it cannot be read."""
        path = self.path(name)
        try:
            with path.open("rb") as file:
                data = file.read(LARGEST_TEXT + 1)
        except FileNotFoundError as error:
            raise RefusedError(404, f"there is no file {name}") from error
        except OSError as error:
            reason = (error.strerror or type(error).__name__).lower()
            raise RefusedError(409, f"cannot read {name}: {reason}") from error
        if len(data) > LARGEST_TEXT:
            raise RefusedError(413, f"{name} is too large to be edited here")
        try:
            text = decode(data, name).text
        except AZeeError as error:
            raise RefusedError(409, error.diagnostics[0].message) from error
        crlf = text.count("\r\n") * 2 > text.count("\n") > 0
        return Stored(_lf(text), _digest(data), data.startswith(_BOM), crlf)

    def save(self, name: str, text: str, digest: str | None) -> str:
        """Write a text and return its digest; line ends and byte-order mark stay as they were.

        Args: digest: of the text that it was made of; None for a file that must not exist yet.
        Raises: ConflictError: the file on the disk is another one; it stays.
            RefusedError: it cannot be written.
        """
        path = self.path(name)
        try:
            before: Stored | None = self.read(name)
        except RefusedError as refused:
            if refused.status != 404:
                raise
            before = None
        if (before and before.digest) != digest and not (before and before.text == text):
            raise ConflictError(before)
        whole = _lf(text)
        if before and before.crlf:
            whole = whole.replace("\n", "\r\n")
        data = (_BOM if before and before.bom else b"") + _encoded(whole)
        if len(data) > LARGEST_TEXT:
            raise RefusedError(413, "the text is too large")
        try:
            with replace_file(path) as file:
                file.write(data)
        except OSError as error:
            reason = (error.strerror or type(error).__name__).lower()
            raise RefusedError(409, f"cannot write {name}: {reason}") from error
        return _digest(data)


def _lf(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _encoded(text: str) -> bytes:
    try:
        return text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise RefusedError(400, "the text holds half a character") from error


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
