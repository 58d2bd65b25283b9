"""The rule libraries that ship with the project: folders of .azee files."""

from __future__ import annotations

from functools import cache
from pathlib import Path

_RULES = Path(__file__).parent / "rules"


def shipped() -> Path:
    """Return the folder whose subfolders are the shipped libraries."""
    return _RULES


@cache
def shipped_names() -> tuple[str, ...]:
    """Return the names of the shipped libraries, as they are written after `use '`."""
    folders = (folder for folder in _RULES.iterdir() if folder.is_dir())
    return tuple(sorted(folder.name for folder in folders if any(folder.glob("*.azee"))))
