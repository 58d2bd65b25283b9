"""Files that a command is to write: known formats, and places that can be written."""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import click

from azee.formats import cannot_write
from azee_grammar.diagnostic import AZeeError

_SIZE = re.compile(r"(\d{1,5})\s*[x×]\s*(\d{1,5})", re.ASCII)


def picture_size(_: click.Context, __: click.Parameter, value: str) -> tuple[int, int]:
    """Return width and height of an option such as 1280x720. Raises: click.BadParameter."""
    found = _SIZE.fullmatch(value)
    size = (int(found[1]), int(found[2])) if found else (0, 0)
    if not all(16 <= side <= 8192 for side in size):
        raise click.BadParameter(f"`{value}` is no size such as 1280x720, from 16 to 8192 pixels")
    return size


def with_suffix(*suffixes: str) -> Callable[..., Any]:
    """Return an option's callback that refuses paths whose suffix names none of some formats."""

    def checked(_: click.Context, __: click.Parameter, value: Any) -> Any:
        for path in value if isinstance(value, tuple) else (value,):
            if path is not None and path.suffix.lower() not in suffixes:
                raise click.BadParameter(
                    f"`{path}`: the suffix is the format: {' '.join(suffixes)}"
                )
        return value

    return checked


def check_outputs(paths: Iterable[Path]) -> None:
    """Refuse, before any work is done, what could not be written at its end.

    Raises: AZeeError: cannot-write, one diagnostic for each. click.UsageError: two are one file.
    """
    paths = list(paths)
    places = [_place(path) for path in paths]
    for path, place in zip(paths, places, strict=True):
        if places.count(place) > 1:
            raise click.UsageError(f"`{path}` would be written twice")
    found = [cannot_write(path, error) for path in paths if (error := _obstacle(path))]
    if found:
        raise AZeeError(*found)


def check_media(media: Path | None, outputs: Iterable[Path]) -> None:
    """Refuse a film for ELAN where no ELAN file is written. Raises: click.UsageError."""
    if media is not None and not any(path.suffix.lower() == ".eaf" for path in outputs):
        raise click.UsageError("--media is of ELAN files: name an .eaf with -o")


def size_of(path: Path) -> str:
    """Size of a file in kB or MB, for people."""
    size = path.stat().st_size
    return f"{size / 1e6:.1f} MB" if size >= 1e6 else f"{max(1, round(size / 1e3))} kB"


def _place(path: Path) -> Path:
    """Return what a path leads to; itself if the system takes no such path."""
    try:
        return path.resolve()
    except (OSError, ValueError, RuntimeError):
        return path


def _obstacle(path: Path) -> OSError | None:
    try:
        folder = path.resolve().parent
        if path.is_dir():
            return IsADirectoryError()
        if not folder.exists():
            return FileNotFoundError()
        if not folder.is_dir():
            return NotADirectoryError()
    except OSError as error:  # such as a name that is too long
        return error
    except (ValueError, RuntimeError):  # a NUL in the name; links in a circle
        return OSError(errno.EINVAL, os.strerror(errno.EINVAL))
    return None if os.access(folder, os.W_OK) else PermissionError()
