"""Reads without line editing: from a pipe, from a file or at a simple terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TextIO

from azee.assist.completeness import Completeness, completeness, unclosed
from azee.repl.commands import answer, is_command
from azee.repl.ink import Ink
from azee.repl.repl import Quit, Repl

PROMPT, CONTINUED = "azee> ", "  ... "


def read_through(repl: Repl, stream: TextIO) -> bool:
    """Run the items and commands of a stream; return whether none had a mistake."""
    right = True
    try:
        for text in inputs(stream):
            right = answer(repl, text) and right
    except Quit:
        pass
    return right


def inputs(stream: TextIO) -> Iterator[str]:
    """Yield commands and items of AZee; an item ends if the next line begins at the margin."""
    waiting = ""
    for line in stream:
        at_margin = bool(line.strip()) and not line[0].isspace()
        if is_command(line) and at_margin:
            yield from _whole(waiting)
            yield line
            waiting = ""
            continue
        if at_margin and not (unclosed(waiting) and not _begins_item(line)):
            yield from _whole(waiting)
            waiting = ""
        waiting += line
    yield from _whole(waiting)


def converse(repl: Repl) -> None:
    """Read and answer until the user leaves; an empty line ends an input of several lines."""
    while True:
        try:
            text = _typed(repl)
        except KeyboardInterrupt:
            repl.screen.put("\n")
            repl.screen.say("Ctrl-D or /quit leaves", Ink.FAINT)
            continue
        except EOFError:
            repl.screen.put("\n")
            return
        try:
            if text.strip():
                answer(repl, text)
        except Quit:
            return


def _typed(repl: Repl) -> str:
    text = input(PROMPT)
    if is_command(text):
        return text
    while completeness(text, repl.session.knowledge) is not Completeness.WHOLE:
        line = input(CONTINUED)
        if not line.strip():
            break
        text += f"\n{line}"
    return text


def _whole(text: str) -> Iterator[str]:
    if text.strip():
        yield text.rstrip()


def _begins_item(line: str) -> bool:
    return line.split(maxsplit=1)[0] in ("def", "use")
