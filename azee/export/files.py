"""Output files that are complete or absent: written beside, flushed, then renamed."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

PART = ".part"
"""Suffix of the hidden files."""
_SHOWN = 40
"""Characters of a name that the hidden file repeats: a name as long as any may be stays legal."""


@contextmanager
def replace_file(path: str | Path) -> Iterator[BinaryIO]:
    """Open a file for binary writing that replaces `path` if there was no error.

    Raises: OSError: as `replace_path`.
    """
    with replace_path(path) as part, part.open("wb") as file:
        yield file
        file.flush()
        os.fsync(file.fileno())


@contextmanager
def replace_path(path: str | Path) -> Iterator[Path]:
    """Give a path to write to; its file replaces `path` if there was no error.

    It is a hidden file in the same folder that is renamed at the end. After any exception, `path`
    is as it was before and the hidden file is gone. A symbolic link is followed, and the
    permissions are those of a plain `open`.

    Raises: OSError: the folder is missing or not writable, `path` is a folder, or its name is
        too long.
    """
    target = Path(path).resolve()
    if target.is_dir():
        raise IsADirectoryError(21, "it is a directory", str(path))
    number, name = tempfile.mkstemp(prefix=_prefix(target), suffix=PART, dir=target.parent)
    os.close(number)
    part = Path(name)
    try:
        yield part
        part.chmod(_permissions(target))
        part.replace(target)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def remove_parts(path: str | Path) -> None:
    """Remove what processes that were killed left of a file, where no other process writes it.

    Raises: OSError.
    """
    target = Path(path).resolve()
    for part in target.parent.glob(f".*{PART}"):
        if part.name.startswith(_prefix(target)):
            part.unlink(missing_ok=True)


def _prefix(target: Path) -> str:
    return f".{target.name[:_SHOWN]}."


def _permissions(target: Path) -> int:
    """Return the permissions of the replaced file, or else 0666 with the process' mask."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
