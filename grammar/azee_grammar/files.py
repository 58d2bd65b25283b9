"""Reads texts from files; whatever goes wrong becomes one diagnostic, never a Python exception."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.source import Source, Span

LARGEST_BYTES = 16 * 1024 * 1024
"""A larger text is refused before it is read whole; files of corpora are much smaller."""

TEXT_SUFFIXES = (".azee", ".az")
"""Suffixes of files with AZee."""
STANDARD_INPUT = "-"


def is_file(path: Path) -> bool:
    """Whether there is a plain file; no if the system takes no such name, as one too long."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def is_folder(path: Path) -> bool:
    """Whether there is a folder; no if the system takes no such name, as one too long."""
    try:
        return path.is_dir()
    except (OSError, ValueError):
        return False


_BOM = b"\xef\xbb\xbf"
_UTF16 = (b"\xff\xfe", b"\xfe\xff")


def read_source(path: str | os.PathLike[str]) -> Source:
    """Read a UTF-8 text; a byte-order mark is dropped, line ends stay as they are.

    `-` reads standard input.

    Raises: AZeeError: cannot-read, not-utf8 or size-limit.
    """
    name = os.fspath(path)
    if name == STANDARD_INPUT:
        return decode(sys.stdin.buffer.read(LARGEST_BYTES + 1), "<stdin>")
    try:
        if is_folder(Path(name)):
            raise AZeeError(
                Diagnostic(
                    "cannot-read",
                    f"`{name}` is a directory",
                    None,
                    help="name a file in it; `--library` takes folders of rules",
                )
            )
        with Path(name).open("rb") as stream:
            data = stream.read(LARGEST_BYTES + 1)
    except (OSError, ValueError) as problem:
        raise AZeeError(_unreadable(name, problem)) from None
    return decode(data, name)


def decode(data: bytes, name: str) -> Source:
    """Turn the bytes of a text into a source.

    Raises: AZeeError: not-utf8 or size-limit.
    """
    if len(data) > LARGEST_BYTES:
        megabytes = LARGEST_BYTES // 2**20
        raise AZeeError(Diagnostic("size-limit", f"`{name}` is larger than {megabytes} MB", None))
    data = data.removeprefix(_BOM)
    try:
        return Source(name, data.decode("utf-8"))
    except UnicodeDecodeError as problem:
        raise AZeeError(_not_utf8(data, name, problem.start)) from None


def _unreadable(name: str, problem: OSError | ValueError) -> Diagnostic:
    if isinstance(problem, FileNotFoundError | NotADirectoryError):
        return Diagnostic("cannot-read", f"there is no file `{name}`", None)
    if isinstance(problem, PermissionError):
        return Diagnostic("cannot-read", f"no permission to read `{name}`", None)
    if isinstance(problem, OSError) and problem.errno == errno.ENAMETOOLONG:
        return Diagnostic("cannot-read", f"cannot read `{name}`: its name is too long", None)
    reason = problem.strerror if isinstance(problem, OSError) else None
    why = f": {reason[0].lower()}{reason[1:]}" if reason else ""
    return Diagnostic("cannot-read", f"cannot read `{name}`{why}", None)


def _not_utf8(data: bytes, name: str, offset: int) -> Diagnostic:
    """Mark the first byte that is not UTF-8, in the readable text before it."""
    if data[:2] in _UTF16:
        return Diagnostic(
            "not-utf8",
            f"`{name}` is UTF-16 text, not UTF-8",
            None,
            help="save it again with the encoding UTF-8",
        )
    if b"\0" in data[: offset + 1]:
        return Diagnostic("not-utf8", f"`{name}` is not a text file", None)
    source = Source(name, data.decode("utf-8", errors="replace"))
    at = len(data[:offset].decode("utf-8"))
    as_latin = bytes([data[offset]]).decode("cp1252", errors="replace")
    likely = f"; in Windows-1252 it is `{as_latin}`" if as_latin.isalpha() else ""
    return Diagnostic(
        "not-utf8",
        f"`{name}` is not UTF-8 text",
        Span(source, at, at + 1),
        label=f"byte 0x{data[offset]:02X} stands here{likely}",
        help="save it again with the encoding UTF-8",
    )
