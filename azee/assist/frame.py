"""Assigns operands to heads by words alone, since a text being typed has no tree yet."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from azee.assist.lines import Line
from azee_grammar.parens import Closings
from azee_grammar.token import HEADS, Token

_TAKES = HEADS | {"DEF", "USE"}


@dataclass(slots=True, eq=False)
class Operand:
    """An operand: its word, or its head with the head's operands; `name` in `'name = value`."""

    token: Token
    frame: Frame | None = None
    name: str | None = None

    @property
    def symbol(self) -> str | None:
        """The symbol, if the operand is one."""
        return self.token.text if self.token.kind == "SYMBOL" else None


@dataclass(slots=True, eq=False)
class Frame:
    """A head with its operands so far; without a head, the margin or an open parenthesis."""

    head: Token | None = None
    parent: Frame | None = None
    called: bool = False
    operands: list[Operand] = field(default_factory=list)
    commas: int = 0
    pending: str | None = None
    """In a call, the name before an `=` that has no value yet."""

    def outwards(self) -> Iterator[Frame]:
        """Yield it and the frames around it, innermost first."""
        frame: Frame | None = self
        while frame is not None:
            yield frame
            frame = frame.parent

    def symbols(self) -> Iterator[tuple[int, str]]:
        """Yield the symbols among its operands, each with its number."""
        for i, operand in enumerate(self.operands):
            if operand.symbol is not None:
                yield i, operand.symbol


class FrameReader:
    """Places one line after the other and finds the frame that would take the next word."""

    def __init__(self, text: str) -> None:
        self.margin = Frame()
        self._text = text
        self._closings: Closings | None = None
        self._levels: list[tuple[str, Frame]] = []  # prefixes, and frames of deeper lines
        self._brackets: list[Frame] = []  # open parentheses and calls
        self._taker = self.margin

    @property
    def taker(self) -> Frame:
        """The frame that takes the next word of the line."""
        return self._taker

    def owner(self, prefix: str) -> Frame:
        """Return the frame to which a line with this indentation belongs."""
        if self._brackets:
            return self._taker
        for level, frame in reversed(self._levels):
            if len(level) < len(prefix):
                return frame
        return self.margin

    def begin(self, line: Line) -> None:
        """Go to a new line; inside parentheses this changes nothing."""
        if self._brackets and (line.prefix or self._continues(line)):
            return
        self._brackets.clear()
        self._taker = self.owner(line.prefix)
        while self._levels and len(self._levels[-1][0]) >= len(line.prefix):
            self._levels.pop()
        self._levels.append((line.prefix, self._taker))

    def take(self, line: Line, number: int) -> None:
        """Place the word of that number on a line."""
        token = line.tokens[number]
        called = number + 1 < len(line.tokens) and line.tokens[number + 1].kind == "_CALL"
        match token.kind:
            case "_OPEN" | "_CALL":
                self._open(token)
            case "CLOSE":
                self._close()
            case "_COMMA":
                self._next_argument()
            case "_EQUALS":
                self._name_argument()
            case kind if kind in _TAKES:
                self._head(line, number, called)
            case _:
                self._word(token)

    def _continues(self, line: Line) -> bool:
        if self._closings is None:
            self._closings = Closings(self._text)
        return self._closings.closes(line.start, len(self._brackets))

    def _word(self, token: Token) -> None:
        frame = self._taker
        frame.operands.append(Operand(token, None, frame.pending))
        frame.pending = None

    def _head(self, line: Line, number: int, called: bool) -> None:
        token = line.tokens[number]
        parent = self._taker
        frame = Frame(token, parent, called)
        parent.operands.append(Operand(token, frame, parent.pending))
        parent.pending = None
        if called:
            return  # its parenthesis opens it
        if self._brackets:
            if self._brackets[-1] is parent:  # the first word of an argument takes what follows
                self._taker = frame
        elif number == 0:
            self._taker = frame
            self._levels[-1] = (self._levels[-1][0], frame)
        elif line.tokens[0].kind == "SYMBOL" and number == len(line.tokens) - 1:
            self._levels[-1] = (self._levels[-1][0], frame)

    def _open(self, token: Token) -> None:
        frame = self._taker
        if token.kind == "_CALL" and frame.operands and (inner := frame.operands[-1].frame):
            self._brackets.append(inner)
        else:
            inner = Frame(None, frame)
            frame.operands.append(Operand(token, inner, frame.pending))
            frame.pending = None
            self._brackets.append(inner)
        self._taker = self._brackets[-1]

    def _close(self) -> None:
        if self._brackets:
            closed = self._brackets.pop()
            assert closed.parent is not None, "a parenthesis stands in something"
            self._taker = closed.parent

    def _next_argument(self) -> None:
        if self._brackets:
            self._taker = self._brackets[-1]
            self._taker.commas += 1
            self._taker.pending = None

    def _name_argument(self) -> None:
        frame = self._taker
        if frame.operands and (name := frame.operands[-1].symbol) is not None:
            frame.operands.pop()
            frame.pending = name
