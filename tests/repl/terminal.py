"""`azee repl` in a pseudo-terminal, seen as its user sees it."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

import pexpect
import pyte

ROWS, COLUMNS = 40, 100
KEYS = {"tab": "\t", "enter": "\r", "ctrl-c": "\x03", "ctrl-d": "\x04", "up": "\x1b[A"}
_WHERE = b"\x1b[6n"  # the program asks where the cursor is, and a terminal answers


class Terminal:
    """A terminal of a fixed size in which the prompt runs."""

    def __init__(self, folder: Path, *arguments: str, **environment: str) -> None:
        self.screen = pyte.Screen(COLUMNS, ROWS)
        self._stream = pyte.ByteStream(self.screen)
        variables = {**os.environ, "TERM": "xterm-256color", **environment}
        variables.pop("NO_COLOR", None)
        self._child = pexpect.spawn(
            sys.executable,
            ["-m", "azee", "repl", *arguments],
            cwd=str(folder),
            env=variables,
            dimensions=(ROWS, COLUMNS),
            # What starts the tests may ignore Ctrl-C, as shells have it for jobs in the background.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )

    def __enter__(self) -> Terminal:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._child.close(force=True)

    @property
    def text(self) -> str:
        """What the screen shows."""
        return "\n".join(line.rstrip() for line in self.screen.display).rstrip()

    @property
    def coloured(self) -> bool:
        """Whether any character of the screen stands on a coloured ground."""
        cells = (cell for row in self.screen.buffer.values() for cell in row.values())
        return any(cell.bg != "default" for cell in cells)

    def type(self, text: str) -> None:
        """Press the keys of a text; line ends are Enter."""
        self._child.send(text.replace("\n", "\r"))

    def press(self, key: str) -> None:
        """Press a key by its name."""
        self._child.send(KEYS[key])

    def wait(self, shown: str | Callable[[str], bool], patience_s: float = 60.0) -> float:
        """Wait until the screen shows something; return how long that took, in seconds."""
        began = time.monotonic()
        seen = shown if callable(shown) else lambda text: shown in text
        while not seen(self.text):
            assert time.monotonic() - began < patience_s, f"waited for {shown!r}:\n{self.text}"
            self._read(0.05)
        return time.monotonic() - began

    def ended(self, patience_s: float = 30.0) -> int | None:
        """Wait for the end of the program; return its exit code."""
        until = time.monotonic() + patience_s
        while self._child.isalive() and time.monotonic() < until:
            self._read(0.05)
        assert not self._child.isalive(), self.text
        status: int | None = self._child.exitstatus
        return status

    def _read(self, seconds: float) -> None:
        try:
            data = self._child.read_nonblocking(65536, timeout=seconds)
        except (pexpect.TIMEOUT, pexpect.EOF):
            return
        self._stream.feed(data)
        for _ in range(data.count(_WHERE)):
            cursor = self.screen.cursor
            self._child.send(f"\x1b[{cursor.y + 1};{cursor.x + 1}R")
