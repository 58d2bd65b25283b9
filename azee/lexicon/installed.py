"""Lexicons by name: a folder, or one that another distribution has installed."""

from __future__ import annotations

from pathlib import Path

from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.installed import installed_library, installed_names


def lexicon_folder(name: str) -> Path:
    """Return the folder of a lexicon.

    Raises: AZeeError: cannot-read.
    """
    path = Path(name)
    if path.is_dir():
        return path.resolve()
    found = installed_library(name)
    if found is not None:
        return found
    names = ", ".join(f"`{known}`" for known in installed_names())
    hint = (
        f"installed are {names}" if names else "`pip install azee[ngt]` installs the lexicon `ngt`"
    )
    message = f"there is no folder and no installed lexicon `{name}`"
    raise AZeeError(Diagnostic("cannot-read", message, None, help=hint))
