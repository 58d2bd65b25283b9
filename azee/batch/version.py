"""Which azee it is: results of another one are not those of this one."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path

import azee
import azee_grammar
import azee_rig
import azee_solver

_READ = {".py", ".azee", ".lark", ".json"}
_ELSEWHERE = {"web", "data", "__pycache__"}
"""Folders that do not decide how a text moves, or have digests of their own."""


@cache
def installed_version() -> str:
    """Return the number of the version, and a digest of the code and the rules that ship."""
    digest = hashlib.sha256()
    for package in (azee, azee_grammar, azee_rig, azee_solver):
        root = Path(package.__path__[0])
        for path in sorted(_files(root)):
            digest.update(f"{root.name}/{path.relative_to(root).as_posix()}\n".encode())
            digest.update(path.read_bytes())
    return f"{version('azee')}+{digest.hexdigest()[:12]}"


def _files(folder: Path) -> list[Path]:
    found = []
    for path in folder.iterdir():
        if path.is_dir():
            found += [] if path.name in _ELSEWHERE else _files(path)
        elif path.suffix in _READ:
            found.append(path)
    return found
