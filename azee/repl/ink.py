"""Text with colours, and its form for a terminal."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Sequence
from enum import Enum

from azee_grammar.excerpt import printable


class Ink(Enum):
    """A style; the value is its ANSI code (ECMA-48, Select Graphic Rendition)."""

    PLAIN = ""
    STRONG = "1"
    FAINT = "2"
    GOOD = "32"
    BAD = "31"
    WARNING = "33"
    NAME = "36"
    AXIS = "2 "
    GROUP = "1;38;5;255;48;5;239"
    GROUP_INSIDE = "1;38;5;255;48;5;243"
    HANDS = "38;5;255;48;5;25"
    HEAD = "38;5;255;48;5;30"
    GAZE = "38;5;255;48;5;64"
    FACE = "38;5;255;48;5;90"
    HOLD = "38;5;255;48;5;94"
    RECORDED = "38;5;255;48;5;130"
    BLANK = "38;5;245;48;5;236"


Fragment = tuple[Ink, str]
Line = Sequence[Fragment]


def plain(text: str, ink: Ink = Ink.PLAIN) -> Line:
    """Return a line of one colour."""
    return ((ink, text),)


def written(lines: Iterable[Line], *, colour: bool) -> str:
    """Return lines as text for a terminal; characters that could control it are escaped."""
    return "".join(f"{_line(line, colour)}\n" for line in lines)


def _line(line: Line, colour: bool) -> str:
    if not colour:
        return "".join(printable(text) for _, text in line).rstrip()
    return "".join(_fragment(ink, printable(text)) for ink, text in line)


def _fragment(ink: Ink, text: str) -> str:
    code = ink.value.strip()
    return f"\033[{code}m{text}\033[0m" if code else text


def width(text: str) -> int:
    """Return the number of terminal columns of a text."""
    return sum(_columns(c) for c in text)


def cut(text: str, columns: int) -> str:
    """Return the text, shortened with an ellipsis if it has more columns than a bound."""
    if width(text) <= columns:
        return text
    kept, taken = [], 0
    for c in text:
        if taken + _columns(c) > columns - 1:
            break
        kept.append(c)
        taken += _columns(c)
    return "".join(kept) + "…" if columns > 0 else ""


def _columns(c: str) -> int:
    if unicodedata.combining(c):
        return 0
    return 2 if unicodedata.east_asian_width(c) in ("W", "F") else 1
