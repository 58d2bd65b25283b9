"""The user's cache folder: what can be made again, written whole or not at all.

Where nothing can be written, nothing is kept and all works as before, only slower. Processes that
write the same file at once each write the same content and rename it into place.
"""

from __future__ import annotations

import os
import tempfile
from contextlib import suppress
from pathlib import Path

from platformdirs import user_cache_path

VARIABLE = "AZEE_CACHE"
"""Names another folder; `off` keeps nothing."""


def cache_folder() -> Path | None:
    """Return the folder, which need not exist; None if nothing is to be kept."""
    named = os.environ.get(VARIABLE)
    if named:
        return None if named == "off" else Path(named)
    return user_cache_path("azee", appauthor=False)


def kept(file: str) -> bytes | None:
    """Return what a file of the cache holds; None if there is none."""
    folder = cache_folder()
    if folder is None:
        return None
    try:
        return (folder / file).read_bytes()
    except OSError:
        return None


def keep(file: str, data: bytes) -> None:
    """Write a file of the cache, if that is possible."""
    folder = cache_folder()
    if folder is None:
        return
    path = folder / file
    name = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        number, name = tempfile.mkstemp(prefix=".", suffix=".part", dir=path.parent)
        with os.fdopen(number, "wb") as part:
            part.write(data)
        Path(name).replace(path)
    except OSError:
        if name is not None:
            with suppress(OSError):
                Path(name).unlink()
