"""Texts in which `|` marks where somebody is."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from azee_grammar.library import shipped

_FENCE = re.compile(r"^```azee[^\n]*\n(.*?)^```$", re.M | re.S)
_MANUAL = Path(__file__).parents[2] / "docs" / "language"


def at_cursor(marked: str) -> tuple[str, int]:
    """Return a text without its mark, and the offset of the mark."""
    offset = marked.index("|")
    return marked[:offset] + marked[offset + 1 :], offset


def real_texts() -> Iterator[str]:
    """Yield every rule file that ships and every block of AZee in the manual."""
    for path in sorted(shipped().rglob("*.azee")):
        yield path.read_text(encoding="utf-8")
    for page in sorted(_MANUAL.glob("*.md")):
        yield from (found[1] for found in _FENCE.finditer(page.read_text(encoding="utf-8")))
