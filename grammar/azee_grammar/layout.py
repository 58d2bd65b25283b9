"""Splits lines into items, by indentation and by parentheses that span lines; reports mistakes.

An item is a line at the margin with all deeper lines below it and with the content of its
parentheses, however that is indented. A mistake in one item does not affect the next: a parenthesis
that is never closed ends at the next line at the margin.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

from azee_grammar.diagnostic import Diagnostic
from azee_grammar.parens import Closings
from azee_grammar.source import Source, Span
from azee_grammar.token import BAD, Token
from azee_grammar.words import WordReader

DEEPEST = 200
"""Levels of indentation, parentheses and named operands together; code recurses over the tree."""

_LINE = re.compile(r"([^\r\n]*)(?:\r\n|\r|\n|\Z)")
_SPACE = re.compile(r"\s*")
_DEF = re.compile(r"def(?=\s|\Z)")


@dataclass(slots=True)
class Item:
    """The tokens of one item, and its mistakes.

    An item without tokens has only diagnostics.
    """

    tokens: list[Token] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)


class LayoutReader:
    """Splits a source into items and marks their nesting with INDENT and DEDENT tokens.

    With `indented` the first line sets the margin, as for an expression on a command line.
    Otherwise the margin is the beginning of the line. `comments` is complete once all items were
    taken.
    """

    def __init__(self, source: Source, *, indented: bool = False) -> None:
        self.source = source
        self.comments: list[tuple[int, int]] = []
        self._text = source.text
        self._margin: str | None = None if indented else ""
        self._words = WordReader(source, self._report, self.comments)
        self._item = Item()
        self._levels: list[str] = []  # prefixes of the enclosing lines; empty outside of items
        self._open: list[int] = []  # indices of the tokens of unclosed parentheses
        self._named: set[int] = set()  # those in which an argument's name came last
        self._wrong = False  # whether the line being read has a mistake that hides its structure
        self._skipping = False

    def items(self) -> Iterator[Item]:
        """Yield the items in order."""
        for start, first, end in self._lines():
            prefix = self._text[start:first]
            if self._margin is None:
                self._margin = prefix
            if prefix == self._margin and not self._continues(start, first):
                yield from self._finish()
                self._levels = [prefix]
                self._skipping = False
                self._read(first, end)
            elif self._skipping:
                continue
            elif self._open or self._placed(prefix, start, first):
                self._read(first, end)
        yield from self._finish()

    def _lines(self) -> Iterator[tuple[int, int, int]]:
        """Yield start, first visible character and end of each line that is not only a comment."""
        text = self._text
        at = 1 if text.startswith("\ufeff") else 0
        while at < len(text) and self._words.left >= 0:
            line = _LINE.match(text, at)
            assert line
            end = line.end(1)
            blank = _SPACE.match(text, at, end)
            assert blank
            first = blank.end()
            if first < end and text[first] == "#":
                self._words.comment(first, end)
            elif first < end:
                yield at, first, end
            at = line.end()

    def _continues(self, start: int, first: int) -> bool:
        """Whether a line at the margin is inside parentheses of the item above."""
        if self._skipping:
            return self._text[first] == ")"
        return bool(self._open) and self._closings.closes(start, len(self._open))

    @cached_property
    def _closings(self) -> Closings:
        return Closings(self._text)

    def _placed(self, prefix: str, start: int, first: int) -> bool:
        """Relate a line to the lines above by its prefix; return False if that is impossible."""
        levels = self._levels
        span = Span(self.source, start, first)
        if not levels:
            return self._refuse(
                Diagnostic(
                    "bad-indent",
                    "this line is indented, but there is no line above that it could belong to",
                    span,
                    help="an item begins at the start of a line",
                )
            )
        if odd := prefix.strip(" \t"):
            name = unicodedata.name(odd[0], "another character").lower()
            return self._refuse(
                Diagnostic(
                    "bad-indent",
                    "a line is indented with spaces or tabs only",
                    span,
                    label=f"here stands: {name}, U+{ord(odd[0]):04X}",
                )
            )
        if prefix == levels[-1]:
            return True
        if prefix.startswith(levels[-1]):
            if self._too_deep(first):
                return False
            levels.append(prefix)
            self._add("_INDENT", first)
            return True
        if prefix in levels:
            while levels[-1] != prefix:
                levels.pop()
                self._add("_DEDENT", first)
            return True
        if levels[-1].startswith(prefix):
            return self._refuse(
                Diagnostic(
                    "bad-indent",
                    "this line is indented like no line above it",
                    span,
                    label=_widths(prefix, levels),
                )
            )
        return self._refuse(
            Diagnostic(
                "tab-space-mix",
                "tabs and spaces are mixed in the indentation",
                span,
                label=f"{_described(prefix)} here, {_described(levels[-1])} above",
                help="indent the lines of a file with spaces only, or with tabs only",
            )
        )

    def _read(self, first: int, end: int) -> None:
        """Read one line, or one more line inside parentheses."""
        item = self._item
        if not self._open:
            self._wrong = False
        if not item.tokens and _DEF.match(self._text, first, end):
            tokens = self._words.definition(first, end)
        else:
            tokens = self._words.read(first, end)
        for token in tokens:
            if token.kind in ("_OPEN", "_CALL"):
                if self._too_deep(token.start):
                    return
                self._open.append(len(item.tokens))
            elif token.kind == "CLOSE" and not self._open:
                token = self._stray(token)
            elif token.kind == "CLOSE":
                self._named.discard(self._open.pop())
            elif token.kind == "_EQUALS" and self._open:
                self._named.add(self._open[-1])
            elif token.kind == "_COMMA" and self._open:
                self._named.discard(self._open[-1])
            self._wrong = self._wrong or token.kind == BAD
            item.tokens.append(token)
        if not self._open:
            self._add("_NEWLINE", item.tokens[-1].end)

    def _finish(self) -> Iterator[Item]:
        item = self._item
        if self._open:
            self._close()
        if item.tokens:
            self._levels = self._levels[1:]
            end = item.tokens[-1].end
            for _ in self._levels:
                self._add("_DEDENT", end)
        self._levels = []
        self._item = Item()
        if item.tokens or item.diagnostics:
            yield item

    def _close(self) -> None:
        """Report the open parentheses, unless an earlier mistake already explains them."""
        tokens = self._item.tokens
        count = len(self._open)
        at = self._open[0]
        self._open = []
        self._named.clear()
        if not self._wrong:
            opened = tokens[at]
            inner = f", nor {'is' if count == 2 else 'are'} {count - 1} inside it"
            self._report(
                Diagnostic(
                    "unclosed-paren",
                    f"this parenthesis is never closed{inner if count > 1 else ''}",
                    Span(self.source, opened.start, opened.end),
                    help="close it before the next line that is not indented",
                )
            )
        end = tokens[at].start
        del tokens[at:]
        self._add(BAD, end)
        self._add("_NEWLINE", end)

    def _refuse(self, diagnostic: Diagnostic) -> bool:
        """Report a mistake and skip the remaining item."""
        self._report(diagnostic)
        self._skipping = True
        self._open = []
        self._named.clear()
        if self._item.tokens:
            end = self._item.tokens[-1].end
            self._add(BAD, end)
            self._add("_NEWLINE", end)
        return False

    def _too_deep(self, at: int) -> bool:
        if len(self._levels) - 1 + len(self._open) + len(self._named) < DEEPEST:
            return False
        self._refuse(
            Diagnostic(
                "recursion-limit",
                f"this is nested more than {DEEPEST} levels deep",
                Span(self.source, at, at + 1),
                help="give an inner part a name with `def`",
            )
        )
        return True

    def _stray(self, token: Token) -> Token:
        if not self._wrong:
            self._report(
                Diagnostic(
                    "syntax",
                    "this parenthesis closes nothing",
                    Span(self.source, token.start, token.end),
                    label="no `(` is open here",
                )
            )
        return token._replace(kind=BAD)

    def _add(self, kind: str, at: int) -> None:
        self._item.tokens.append(Token(kind, at, at))

    def _report(self, diagnostic: Diagnostic) -> None:
        self._item.diagnostics.append(diagnostic)


def _described(prefix: str) -> str:
    spaces, tabs = prefix.count(" "), prefix.count("\t")
    parts = [
        f"{count} {name}{'s' if count > 1 else ''}"
        for count, name in ((tabs, "tab"), (spaces, "space"))
        if count
    ]
    return " and ".join(parts) or "none"


def _widths(prefix: str, levels: list[str]) -> str:
    """Describe the two levels between which the indentation of a line lies."""
    shorter = [level for level in levels if len(level) < len(prefix)]
    longer = levels[len(shorter)]
    near = [_described(level) for level in (*shorter[-1:], longer)]
    return f"{_described(prefix)} here, {' or '.join(near)} above"
