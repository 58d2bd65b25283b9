"""The output of a session: lines for people, diagnostics as `azee check` shows them."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from azee.repl.ink import Ink, Line, written
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.render import render


@dataclass(frozen=True)
class Screen:
    """Results go to `put`, mistakes to `put_wrong`; both take text for a terminal."""

    put: Callable[[str], None]
    put_wrong: Callable[[str], None]
    colour: bool
    fixed_columns: int | None = None

    @property
    def columns(self) -> int:
        """The most columns of a result."""
        return self.fixed_columns or min(shutil.get_terminal_size().columns, 160) - 1

    @property
    def rows(self) -> int:
        """The most rows of a result that should fit on the screen."""
        return max(8, shutil.get_terminal_size().lines - 4)

    def show(self, lines: Iterable[Line]) -> None:
        """Write lines."""
        self.put(written(lines, colour=self.colour))

    def say(self, text: str, ink: Ink = Ink.FAINT) -> None:
        """Write one line."""
        self.show([[(ink, text)]])

    def complain(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Write diagnostics, an empty line behind each."""
        for diagnostic in diagnostics:
            self.put_wrong(render(diagnostic, colour=self.colour).rstrip("\n") + "\n\n")

    def refuse(self, message: str, hint: str | None = None) -> None:
        """Report why a command is impossible."""
        lines: list[Line] = [((Ink.BAD, "error"), (Ink.STRONG, f": {message}"))]
        if hint:
            lines.append(((Ink.NAME, "help"), (Ink.PLAIN, f": {hint}")))
        self.put_wrong(written(lines, colour=self.colour))


def plain_screen() -> Screen:
    """Return a screen for pipes and simple terminals: no colours, results to standard output."""

    def out(text: str) -> None:
        sys.stdout.write(text)
        sys.stdout.flush()

    def wrong(text: str) -> None:
        sys.stdout.flush()
        sys.stderr.write(text)
        sys.stderr.flush()

    return Screen(out, wrong, colour=False, fixed_columns=None if sys.stdout.isatty() else 100)
