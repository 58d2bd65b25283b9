"""What a text needs beside itself: the libraries that it uses, as one digest."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from azee.batch.text import Text
from azee_grammar.files import TEXT_SUFFIXES, is_file, is_folder
from azee_grammar.installed import installed_library

_USE = re.compile(rb"^[ \t]*use[ \t]+'([^\s#(),]+)", re.MULTILINE)
"""One too many, such as in a comment, only makes the digest depend on more than it must."""


class Dependencies:
    """Digests of what texts use, each library read once.

    It looks where `azee.lang.library.Librarian` looks, in everything that a name may mean, and in
    the libraries that these use. Libraries that ship belong to the version of azee.

    Args: libraries: folders of the option `--library`.
    """

    def __init__(self, libraries: Sequence[Path]) -> None:
        self._folders = tuple(libraries)
        self._read: dict[Path, tuple[str, tuple[str, ...]]] = {}

    def digest(self, text: Text) -> str:
        """Return a digest of all files that a text may use; of none, an empty text."""
        data = text.source.text.encode()
        wanted = [(name, text.folder) for name in _names(data)]
        if text.folder is not None and _only_defines(text):
            wanted.append((text.folder.name, text.folder.parent))
        seen: dict[Path, str] = {}
        while wanted:
            name, folder = wanted.pop()
            for path in self._candidates(name, folder):
                if path not in seen:
                    seen[path], names = self._content(path)
                    inside = path if is_folder(path) else path.parent
                    wanted += [(used, inside) for used in names]
        if not seen:
            return ""
        lines = sorted(f"{path.name} {digest}\n" for path, digest in seen.items())
        return hashlib.sha256("".join(lines).encode()).hexdigest()

    def _candidates(self, name: str, folder: Path | None) -> Iterator[Path]:
        beside = () if folder is None else (folder, folder.parent)
        for place in (*beside, *self._folders):
            for path in (place / name, *(place / f"{name}{suffix}" for suffix in TEXT_SUFFIXES)):
                if is_folder(path) or is_file(path):
                    yield path.resolve()
        installed = installed_library(name)
        if installed is not None:
            yield installed.resolve()

    def _content(self, path: Path) -> tuple[str, tuple[str, ...]]:
        """Return a digest of a file, or of the texts of a folder, and the names that it uses."""
        if path not in self._read:
            files = sorted(path.iterdir()) if is_folder(path) else [path]
            digest, names = hashlib.sha256(), list[str]()
            for file in files:
                if file.suffix in (*TEXT_SUFFIXES, ".json") and is_file(file):
                    data = file.read_bytes()
                    digest.update(f"{file.name} {len(data)}\n".encode())
                    digest.update(data)
                    names += _names(data)
            self._read[path] = digest.hexdigest(), tuple(dict.fromkeys(names))
        return self._read[path]


def _names(data: bytes) -> list[str]:
    return [found.decode(errors="replace") for found in dict.fromkeys(_USE.findall(data))]


def _only_defines(text: Text) -> bool:
    """Whether a text may be a file of the library beside it: it has no utterance of its own."""
    return text.utterance is None and b"def " in text.source.text.encode()
