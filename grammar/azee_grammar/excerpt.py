"""A line of a text with carets below a part of it, aligned for a terminal."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from itertools import repeat
from operator import itemgetter

from azee_grammar.source import Span

TAB_STOP = 4
WIDEST = 100
"""How many columns of a line are shown; of a longer line, those around the carets."""

_LEAD = 30  # columns that stay before the carets in a shortened line
_CUT = "…"


@dataclass(frozen=True, slots=True)
class Excerpt:
    """The shown line, the blanks below it up to the span, and the carets."""

    line: str
    indent: str
    carets: str

    @classmethod
    def of(cls, span: Span) -> Excerpt:
        """Show the first line of a span."""
        text = span.source.line(span.line)
        start = min(span.column - 1, len(text))
        end = min(start + span.end - span.start, len(text))
        # Only what can be visible is examined: a line may have megabytes.
        skipped = max(0, start - 4 * WIDEST)
        cells = _cells(text[skipped : start + 4 * WIDEST])
        before = _width_of(cells[: start - skipped])
        under = _width_of(cells[start - skipped : end - skipped])
        total = before + _width_of(cells[start - skipped :])
        if skipped or total > WIDEST or start + 4 * WIDEST < len(text):
            return cls._cut(cells, before, max(1, under), left=bool(skipped))
        line = "".join(shown for shown, _ in cells)
        return cls(line.rstrip(), " " * before, "^" * max(1, under))

    @classmethod
    def _cut(cls, cells: list[tuple[str, int]], before: int, under: int, *, left: bool) -> Excerpt:
        first = max(0, before - _LEAD) if left or before + under > WIDEST else 0
        shown: list[str] = []
        column = 0
        kept = 0
        offset: int | None = None
        for text, width in cells:
            if column >= first:
                if offset is None:
                    offset = column
                if kept + width > WIDEST:
                    shown.append(_CUT)
                    break
                shown.append(text)
                kept += width
            column += width
        lead = _CUT if left or offset else ""
        indent = before - (offset or 0) + len(lead)
        room = max(1, kept - (before - (offset or 0)))
        return cls(lead + "".join(shown), " " * indent, "^" * min(under, room))


def _cells(text: str) -> list[tuple[str, int]]:
    """Return for each character how it is shown, and over how many columns."""
    if text.isascii() and text.isprintable():  # a text may have thousands of mistakes
        return list(zip(text, repeat(1)))
    cells: list[tuple[str, int]] = []
    column = 0
    for c in text:
        if " " <= c <= "~":
            cells.append((c, 1))
            column += 1
            continue
        if c == "\t":
            width = TAB_STOP - column % TAB_STOP
            shown = " " * width
        else:
            shown = printable(c)
            width = _width(c) if shown == c else len(shown)
        cells.append((shown, width))
        column += width
    return cells


def _width_of(cells: list[tuple[str, int]]) -> int:
    return sum(map(itemgetter(1), cells))


def _width(c: str) -> int:
    if unicodedata.combining(c) or unicodedata.category(c) in ("Mn", "Me", "Cf"):
        return 0
    return 2 if unicodedata.east_asian_width(c) in ("W", "F") else 1


def printable(text: str) -> str:
    """Return a text, with characters escaped that could control a terminal or be invisible."""
    if text.isprintable():
        return text
    return "".join(c if _shows(c) else _escape(c) for c in text)


def _shows(c: str) -> bool:
    # Joiners and combining marks belong to words of many scripts; odd spaces are shown as spaces.
    return c.isprintable() or c in "\u200c\u200d" or unicodedata.category(c) in ("Zs", "Co", "Cn")


def _escape(c: str) -> str:
    code = ord(c)
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"
