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
_NEW = re.compile(r"(?:\A\ufeff?|(?<=[\r\n]))(?:def|use)(?=\s|\Z)")
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


def item_around(text: str, offset: int) -> tuple[int, int]:
    """Return where the lines around an offset begin and end that depend on each other.

    A `def` or `use` at the margin begins something new, whatever stands before it.
    """
    start, end = 0, len(text)
    for found in _NEW.finditer(text):
        if found.start() > offset:
            end = found.start()
            break
        start = found.start()
    return start, end


def defined_names(text: str) -> tuple[str, ...]:
    """Return the names of the rules that a text defines, in order."""
    words = WordReader(Source("", text), lambda _: None, [])
    names = []
    for found in _NEW.finditer(text):
        first = found.end() - 3
        if text.startswith("def", first):
            line = _LINE.match(text, first)
            assert line
            tokens = words.definition(first, line.end(1))
            names += [token.text for token in tokens if token.kind == "NAME"]
    return tuple(names)


def read_lines(text: str, start: int = 0, stop: int | None = None) -> Lines:
    """Read a text, or some of its lines; mistakes are ignored, since the parser reports them."""
    comments: list[tuple[int, int]] = []
    words = WordReader(Source("", text), lambda _: None, comments)
    found: list[Line] = []
    at = start
    stop = len(text) if stop is None else stop
    while at < stop and words.left >= 0:
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
