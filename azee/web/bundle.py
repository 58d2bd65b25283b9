"""Where the built pages are: HTML, scripts and the licences of what they contain."""

from __future__ import annotations

from pathlib import Path

DIST = Path(__file__).parent / "dist"
"""Files to serve side by side, at any address: they name each other by relative addresses."""
LICENCES = "LICENSES.md"
"""Licences of the libraries in the scripts."""


def bundle() -> tuple[Path, ...]:
    """Return all files of the built pages, in the order of their names."""
    return tuple(sorted(path for path in DIST.iterdir() if path.is_file()))
