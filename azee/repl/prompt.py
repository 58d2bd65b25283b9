"""The prompt on a terminal: editing, colours, completion, and the end of an input."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path

from prompt_toolkit import PromptSession, print_formatted_text
from prompt_toolkit.application import get_app
from prompt_toolkit.buffer import Buffer
from prompt_toolkit.completion import CompleteEvent, Completer, Completion, PathCompleter
from prompt_toolkit.document import Document
from prompt_toolkit.filters import Condition
from prompt_toolkit.formatted_text import ANSI, StyleAndTextTuples
from prompt_toolkit.history import History
from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent
from prompt_toolkit.lexers import Lexer
from prompt_toolkit.output import ColorDepth
from prompt_toolkit.styles import Style

from azee.assist.completeness import Completeness, completeness, wants_deeper
from azee.assist.completion import completions
from azee.assist.pieces import pieces
from azee.assist.signature import signature
from azee.repl import commands
from azee.repl.ink import Ink
from azee.repl.repl import Quit, Repl
from azee.repl.screen import Screen

PROMPT = "azee> "
INDENT = "    "
STYLE = Style.from_dict(
    {
        "prompt": "bold ansicyan",
        "comment": "ansibrightblack italic",
        "keyword": "bold ansimagenta",
        "defined": "bold ansicyan",
        "rule": "ansicyan",
        "reference": "ansicyan italic",
        "posture": "ansicyan",
        "operator": "ansiblue",
        "bone": "ansigreen",
        "site": "ansigreen",
        "number": "ansimagenta",
        "text": "ansiyellow",
        "symbol": "ansiyellow",
        "parameter": "ansibrightred",
        "hole": "ansibrightred",
        "side": "ansigreen",
        "wrong": "underline ansired",
        "command": "bold",
        "bottom-toolbar": "noreverse ansibrightblack",
        "active": "bold ansicyan",
    }
)


def terminal_screen() -> Screen:
    """Return a screen on the terminal that also shows the prompt."""
    colour = not os.environ.get("NO_COLOR")
    depth = ColorDepth.DEPTH_24_BIT if colour else ColorDepth.DEPTH_1_BIT

    def put(text: str) -> None:
        print_formatted_text(ANSI(text), end="", color_depth=depth)

    return Screen(put, put, colour=colour)


def converse(repl: Repl, history: History) -> None:
    """Read and answer until the user ends the session."""
    colour = repl.screen.colour
    session: PromptSession[str] = PromptSession(
        history=history,
        lexer=_Lexer(),
        completer=_Completer(repl),
        complete_while_typing=True,
        key_bindings=_keys(repl),
        multiline=True,
        style=STYLE,
        color_depth=None if colour else ColorDepth.DEPTH_1_BIT,
        prompt_continuation=" " * len(PROMPT),
        bottom_toolbar=lambda: _toolbar(repl),
        reserve_space_for_menu=6,
    )
    while True:
        try:
            text = session.prompt([("class:prompt", PROMPT)])
        except KeyboardInterrupt:
            repl.screen.say("Ctrl-D or /quit leaves", Ink.FAINT)
            continue
        except EOFError:
            return
        if not text.strip():
            continue
        try:
            commands.answer(repl, text.rstrip())
        except Quit:
            return


class _Lexer(Lexer):
    """Colours words as the parser reads them, and commands."""

    def lex_document(self, document: Document) -> Callable[[int], StyleAndTextTuples]:
        text = document.text
        if commands.is_command(text):
            return lambda number: [("class:command", document.lines[number])]
        styles = [""] * len(text)
        for piece in pieces(text):
            style = f"class:{piece.category.value}"
            styles[piece.start : piece.end] = [style] * (piece.end - piece.start)
        starts = [0]
        for line in document.lines:
            starts.append(starts[-1] + len(line) + 1)

        def line_of(number: int) -> StyleAndTextTuples:
            start = starts[number]
            return [(styles[start + i], c) for i, c in enumerate(document.lines[number])]

        return line_of


class _Completer(Completer):
    """Completes names, with their meanings; while typing, only inside a word."""

    def __init__(self, repl: Repl) -> None:
        self._repl = repl
        self._paths = PathCompleter(expanduser=True)

    def get_completions(
        self, document: Document, complete_event: CompleteEvent
    ) -> Iterable[Completion]:
        text, at = document.text, document.cursor_position
        if commands.is_command(text) or text.strip() == "/":
            yield from self._command(document, complete_event)
            return
        for found in completions(text, at, self._repl.session.knowledge):
            if found.start == found.end and not complete_event.completion_requested:
                return
            described = found.described
            meaning = described.meaning or described.what.value
            yield Completion(
                found.insert, found.start - at, display=described.title, display_meta=meaning
            )

    def _command(self, document: Document, event: CompleteEvent) -> Iterable[Completion]:
        before = document.text_before_cursor.lstrip()
        name, space, rest = before.partition(" ")
        if not space:
            for known, meaning in commands.names():
                if known.startswith(name):
                    yield Completion(known, -len(name), display_meta=meaning)
        elif name in ("/load", "/save", "/score", "/render"):
            yield from self._paths.get_completions(Document(rest, len(rest)), event)
        elif name in ("/doc", "/time"):
            for found in completions(rest, len(rest), self._repl.session.knowledge):
                yield Completion(
                    found.insert, found.start - len(rest), display_meta=found.described.meaning
                )


def _keys(repl: Repl) -> KeyBindings:
    keys = KeyBindings()

    @Condition
    def at_indentation() -> bool:
        return not get_app().current_buffer.document.current_line_before_cursor.strip()

    @keys.add("enter")
    def _enter(event: KeyPressEvent) -> None:
        buffer = event.current_buffer
        state = buffer.complete_state
        if state is not None and state.current_completion is not None:
            buffer.complete_state = None
        elif _ends(buffer.document, repl):
            buffer.document = Document(buffer.text.rstrip())  # so that a recalled input can go on
            buffer.validate_and_handle()
        else:
            buffer.insert_text(f"\n{_indentation(buffer, repl)}")

    @keys.add("escape", "enter")
    def _new_line(event: KeyPressEvent) -> None:
        buffer = event.current_buffer
        buffer.insert_text(f"\n{_indentation(buffer, repl)}")

    @keys.add("tab", filter=at_indentation)
    def _deeper(event: KeyPressEvent) -> None:
        document = event.current_buffer.document
        if document.line_count > 1:
            event.current_buffer.insert_text(INDENT)
        else:
            event.current_buffer.start_completion(select_first=False)

    @keys.add("backspace", filter=at_indentation)
    def _back(event: KeyPressEvent) -> None:
        buffer = event.current_buffer
        before = buffer.document.current_line_before_cursor
        buffer.delete_before_cursor(len(INDENT) if before.endswith(INDENT) else 1)

    return keys


def _ends(document: Document, repl: Repl) -> bool:
    """Whether Enter ends the input: it is complete, or the line is empty and the last one."""
    text = document.text
    if document.text_after_cursor.strip():
        return False
    if commands.is_command(text) or not text.strip():
        return True
    if document.line_count > 1 and not document.current_line.strip():
        return True
    return completeness(text, repl.session.knowledge) is Completeness.WHOLE


def _indentation(buffer: Buffer, repl: Repl) -> str:
    """Return the indentation of the next line: as above, or deeper below an incomplete line."""
    line = buffer.document.current_line_before_cursor
    blanks = line[: len(line) - len(line.lstrip())]
    if not blanks or wants_deeper(line, repl.session.knowledge):
        return blanks + INDENT
    return blanks


def _toolbar(repl: Repl) -> StyleAndTextTuples:
    """Return the line at the bottom: the application and its current operand, or how to go on."""
    buffer = get_app().current_buffer
    text, at = buffer.text, buffer.cursor_position
    if not commands.is_command(text) and text.strip():
        found = signature(text, at, repl.session.knowledge)
        if found is not None:
            start, end = (0, 0) if found.active is None else found.operands[found.active]
            return [
                ("", found.text[:start]),
                ("class:active", found.text[start:end]),
                ("", f"{found.text[end:]}   {found.meaning}"),
            ]
        if "\n" in text:
            return [("", "an empty line ends the input")]
    return [("", f"/help   {Path.cwd().name or '/'}   {repl.performer.rig_name}")]
