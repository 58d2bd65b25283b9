"""Puts comments and blank lines back among the lines of a text that was laid out again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

from azee_grammar.source import Source, Span


@dataclass(frozen=True, slots=True)
class Line:
    """A line without its indentation, and the range of the text that it shows."""

    depth: int
    text: str
    start: int
    end: int


def weave(lines: Sequence[Line], source: Source, comments: Sequence[Span], indent: str) -> str:
    """Return the text of the lines with its comments.

    A comment at the end of a line stays there. Any other comment stays above the line that it
    preceded. One blank line stays where there were some.
    """
    out: list[str] = []
    waiting = list(reversed(comments))

    def put(depth: int, text: str, start: int) -> None:
        if out and _after_blank(source, start):
            out.append("")
        out.append(indent * depth + text)

    for line, following in zip_longest(lines, lines[1:]):
        while waiting and waiting[-1].start < line.end:
            put(line.depth, _text(waiting[-1]), waiting.pop().start)
        put(line.depth, line.text, line.start)
        if not waiting or not _same_line(source, line.end, waiting[-1].start):
            continue
        if following is None or following.start > waiting[-1].start:
            out[-1] += f"  {_text(waiting.pop())}"
    while waiting:
        put(0, _text(waiting[-1]), waiting.pop().start)
    return "".join(f"{text}\n" for text in out)


def _text(comment: Span) -> str:
    return comment.text.rstrip()


def _same_line(source: Source, one: int, other: int) -> bool:
    return source.position(one)[0] == source.position(other)[0]


def _after_blank(source: Source, offset: int) -> bool:
    """Whether there is a blank line above an offset that begins its line."""
    line, column = source.position(offset)
    if source.line(line)[: column - 1].strip("\ufeff \t") or line == 1:
        return False
    return not source.line(line - 1).strip()
