"""The modules of our packages, as paths and as syntax trees, for tests that read the code."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDERS = (".", "grammar", "rig", "solver")
"""Folders that packages lie in."""
PATHS = {
    path.relative_to(ROOT / folder): path
    for folder in FOLDERS
    for path in sorted((ROOT / folder).glob("azee*/**/*.py"))
}
MODULES = {
    ".".join(relative.with_suffix("").parts).removesuffix(".__init__"): path
    for relative, path in PATHS.items()
}
"""Path of every module, by its dotted name."""


@cache
def having(word: str) -> dict[str, Path]:
    """Modules in whose text a word stands: few, so that not every file must be parsed."""
    return {n: p for n, p in MODULES.items() if word in p.read_text(encoding="utf-8")}


@cache
def tree(path: Path) -> ast.Module:
    """The syntax tree of a file, read once."""
    return ast.parse(path.read_text(encoding="utf-8"))
