"""Where the built pages are: HTML, scripts and the licences of what they contain."""

from __future__ import annotations

import re
from pathlib import Path

DIST = Path(__file__).parent / "dist"
"""Files to serve side by side, at any address: they name each other by relative addresses."""
LICENCES = "LICENSES.md"
"""Licences of the libraries in the scripts."""
_NAMED = re.compile(r"""(?:from|import|src=|href=)\s*\(?["'`]\./([\w.-]+)["'`]""")


def bundle() -> tuple[Path, ...]:
    """Return all files of the built pages, in the order of their names."""
    return tuple(sorted(path for path in DIST.iterdir() if path.is_file()))


def parts(*names: str) -> tuple[Path, ...]:
    """Return the files that some of them need, themselves and the licences among them."""
    found: set[str] = set()
    asked = [*names, LICENCES]
    while asked:
        name = asked.pop()
        if name not in found:
            found.add(name)
            if not name.startswith("vendor-"):  # libraries need no file of ours
                asked += _NAMED.findall((DIST / name).read_text(encoding="utf-8"))
    return tuple(DIST / name for name in sorted(found))
