"""The place of the cursor in a text: the word being written, and the head that takes it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from azee.assist.frame import Frame, FrameReader, Operand
from azee.assist.lines import Line, defined_names, item_around, read_lines
from azee_grammar.token import Token

_BLANKS = re.compile(r"[^\S\r\n]*")


@dataclass(frozen=True, slots=True)
class Place:
    """The word at an offset and its surroundings.

    `word` is the part of the word before the offset, from `start`; the whole word ends at `end`.
    """

    start: int
    offset: int
    end: int
    word: str
    token: Token | None
    """The whole word, as the parser reads it; None between words."""
    frame: Frame
    """The frame whose operand the word is, or would be, including operands after the word."""
    number: int
    """How many operands of the frame come before the word."""
    commas: int
    pending: str | None
    """In a call, the name of the argument whose value is being written."""
    silent: bool
    """Whether the offset is in a comment or a text literal, where words have no meaning."""
    text: str
    """The whole text."""

    @property
    def defined(self) -> tuple[str, ...]:
        """Names of the rules that the text defines."""
        return defined_names(self.text)

    @property
    def before(self) -> list[Operand]:
        """The operands of the frame before the word."""
        return self.frame.operands[: self.number]

    @property
    def sigil(self) -> str:
        """The sigil of the word, if it has one."""
        if self.word.startswith(":#"):
            return ":#"
        first = self.word[:1]
        return first if first and first in ":.'^!@" else ""

    @property
    def name(self) -> str:
        """The word without its sigil."""
        return self.word[len(self.sigil) :]


def place(text: str, offset: int) -> Place:
    """Return the place of an offset, `0 <= offset <= len(text)`."""
    return _Finder(text, offset).found()


class _Finder:
    def __init__(self, text: str, offset: int) -> None:
        self._text, self._offset = text, offset
        self._read = read_lines(text, *item_around(text, offset))
        self._token = next(filter(self._touches, self._words()), None)
        self._start = self._token.start if self._token else offset
        self._reader = FrameReader(text)
        self._taken: tuple[Frame, int, int, str | None] | None = None

    def found(self) -> Place:
        for line in self._read.lines:
            if line.start > self._offset:
                self._capture(None)
            self._reader.begin(line)
            for number, token in enumerate(line.tokens):
                if token.start >= self._start and line.start <= self._offset:
                    self._capture(line)
                self._reader.take(line, number)
            if line.end >= self._offset >= line.start:
                self._capture(line)
        self._capture(None)
        assert self._taken is not None
        frame, number, commas, pending = self._taken
        word = self._text[self._start : self._offset]
        if self._token is not None and self._token.kind == "TEXT":
            silent = True
        else:
            silent = any(start < self._offset <= end for start, end in self._read.comments)
        end = self._token.end if self._token else self._offset
        return Place(
            self._start, self._offset, end, word, self._token,
            frame, number, commas, pending, silent, self._text,
        )  # fmt: skip

    def _words(self) -> Iterator[Token]:
        for line in self._read.lines:
            yield from line.tokens

    def _touches(self, token: Token) -> bool:
        """Whether the offset is in or right behind a word."""
        if token.kind in ("_OPEN", "_CALL", "_COMMA", "_EQUALS", "CLOSE"):
            return False
        return token.start < self._offset <= token.end

    def _capture(self, line: Line | None) -> None:
        """Store the frame that takes a word here; on a blank line, its indentation decides."""
        if self._taken is not None:
            return
        reader = self._reader
        frame = reader.taker if line is not None else reader.owner(self._blanks())
        self._taken = (frame, len(frame.operands), frame.commas, frame.pending)

    def _blanks(self) -> str:
        start = max(
            self._text.rfind("\n", 0, self._offset), self._text.rfind("\r", 0, self._offset)
        )
        found = _BLANKS.match(self._text, start + 1, self._offset)
        return found[0] if found else ""
