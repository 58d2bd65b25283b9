"""Output files that are whole or not there: written beside, flushed, then renamed."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO


@contextmanager
def replace_file(path: str | Path) -> Iterator[BinaryIO]:
    """Open a file for binary writing that takes the place of `path` once all went well.

    Raises: OSError: as `replace_path`.
    """
    with replace_path(path) as part, part.open("wb") as file:
        yield file
        file.flush()
        os.fsync(file.fileno())


@contextmanager
def replace_path(path: str | Path) -> Iterator[Path]:
    """Give a path to write to, which takes the place of `path` once all went well.

    It is a hidden neighbour in the same folder that then gets the name; after any exception `path`
    is as it was before and the neighbour is gone. A symbolic link is followed, and the permissions
    are those a plain `open` would give.

    Raises: OSError: the folder is missing or not writable, or `path` is a folder.
    """
    target = Path(path).resolve()
    if target.is_dir():
        raise IsADirectoryError(21, "it is a directory", str(path))
    number, name = tempfile.mkstemp(prefix=f".{target.name}.", suffix=".part", dir=target.parent)
    os.close(number)
    part = Path(name)
    try:
        yield part
        part.chmod(_permissions(target))
        part.replace(target)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def _permissions(target: Path) -> int:
    """Those of the file that is replaced, else what the process' mask leaves of 0666."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
