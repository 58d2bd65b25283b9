"""Classifies every word of a text for colouring: the parser's tokens, comments included."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum

from azee.assist.lines import Line, read_lines
from azee_grammar.token import BAD, Token


class Category(Enum):
    """The class of a piece of text."""

    COMMENT = "comment"
    KEYWORD = "keyword"
    """`use` or `def` at the beginning of an item."""
    DEFINED = "defined"
    """The name after `def`."""
    RULE = "rule"
    """`:name`."""
    REFERENCE = "reference"
    """`.name`."""
    POSTURE = "posture"
    """`:#name`."""
    OPERATOR = "operator"
    BONE = "bone"
    SITE = "site"
    NUMBER = "number"
    TEXT = "text"
    SYMBOL = "symbol"
    PARAMETER = "parameter"
    HOLE = "hole"
    SIDE = "side"
    PUNCTUATION = "punctuation"
    WRONG = "wrong"
    """A word that the parser refuses."""


_CATEGORIES: Mapping[str, Category] = {
    "DEF": Category.KEYWORD,
    "USE": Category.KEYWORD,
    "NAME": Category.DEFINED,
    **{
        category.name: category
        for category in Category
        if category.name not in ("COMMENT", "KEYWORD", "DEFINED", "PUNCTUATION", "WRONG")
    },
    **dict.fromkeys(("_OPEN", "_CALL", "CLOSE", "_COMMA", "_EQUALS"), Category.PUNCTUATION),
    BAD: Category.WRONG,
}


@dataclass(frozen=True, slots=True)
class Piece:
    """A range of the text, `[start, end)` in code points, and its class."""

    category: Category
    start: int
    end: int


def pieces(text: str) -> tuple[Piece, ...]:
    """Return the words, punctuation and comments of a text in order; white space is left out.

    Lines that the parser skips after a mistake are classified too. `use` and `def` are keywords at
    the margin only; elsewhere they are words that the parser refuses.
    """
    read = read_lines(text)
    found = [piece for line in read.lines for piece in _pieces(line)]
    found += (Piece(Category.COMMENT, start, end) for start, end in read.comments)
    return tuple(sorted(found, key=lambda piece: piece.start))


def _pieces(line: Line) -> Iterator[Piece]:
    for token in line.tokens:
        if token.start < token.end:
            yield Piece(_category(token, line), token.start, token.end)


def _category(token: Token, line: Line) -> Category:
    if token.kind in ("USE", "DEF") and (line.prefix or token.start != line.first):
        return Category.WRONG
    return _CATEGORIES[token.kind]
