"""Libraries of rules that other distributions install.

A distribution names its libraries in the entry point group `azee.libraries`. An entry point is a
function without arguments that returns the folder of the library's texts; its name is the
library's.
"""

from __future__ import annotations

from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

GROUP = "azee.libraries"


@cache
def _entries() -> dict[str, EntryPoint]:
    return {entry.name: entry for entry in entry_points(group=GROUP)}


def installed_names() -> tuple[str, ...]:
    """Return the names of the libraries, sorted."""
    return tuple(sorted(_entries()))


@cache
def installed_library(name: str) -> Path | None:
    """Return the folder of a library; None if no distribution has it."""
    entry = _entries().get(name)
    if entry is None:
        return None
    folder = Path(entry.load()())
    return folder if folder.is_dir() else None
