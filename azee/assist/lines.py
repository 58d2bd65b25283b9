"""The words of a text line by line, even if its layout is broken.

The parser skips a line that it cannot place and all lines below it. Colours and completion need the
words of every line. Both read them with the same WordReader.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from azee_grammar.source import Source
from azee_grammar.token import Token
from azee_grammar.words import WordReader

_LINE = re.compile(r"([^\r\n]*)(?:\r\n|\r|\n|\Z)")
_PREFIX = re.compile(r"\ufeff?(\s*)")
_DEF = re.compile(r"def(?=\s|\Z)")


@dataclass(frozen=True, slots=True)
class Line:
    """A line that has words: its indentation, and the places of its words."""

    start: int
    prefix: str
    first: int
    end: int
    tokens: tuple[Token, ...]


@dataclass(frozen=True, slots=True)
class Lines:
    """The lines with words, and the ranges of the comments, in order."""

    lines: tuple[Line, ...]
    comments: tuple[tuple[int, int], ...]


def read_lines(text: str) -> Lines:
    """Read a text; mistakes are ignored, since the parser reports them."""
    comments: list[tuple[int, int]] = []
    words = WordReader(Source("", text), lambda _: None, comments)
    found: list[Line] = []
    at = 0
    while at < len(text) and words.left >= 0:
        line = _LINE.match(text, at)
        assert line
        end = line.end(1)
        prefix = _PREFIX.match(text, at, end)
        assert prefix
        first = prefix.end()
        if first < end and text[first] == "#":
            words.comment(first, end)
        elif first < end:
            margin = not prefix[1]
            if margin and _DEF.match(text, first, end):
                tokens = words.definition(first, end)
            else:
                tokens = words.read(first, end)
            found.append(Line(at, prefix[1], first, end, tuple(tokens)))
        at = line.end()
    return Lines(tuple(found), tuple(comments))
