"""Pages that tests open: azee's servers in processes of their own, ended by their ids."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from types import TracebackType

END_S = 20.0


class Served:
    """A command of azee that serves a page on a port that is free, until the block ends."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
        self._process = subprocess.Popen(
            [sys.executable, "-m", "azee", *arguments, "--port", "0"],
            cwd=folder, env=environment, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        assert self._process.stderr is not None
        line = self._process.stderr.readline()
        found = re.search(r"http://127\.0\.0\.1:\d+/\S*", line)
        assert found, line + self._process.stderr.read()
        self.url = found[0]

    def __enter__(self) -> Served:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        self.end()

    def ended(self) -> tuple[int, str]:
        """Wait until it ends by itself; return its exit code and what it said."""
        _, said = self._process.communicate(timeout=END_S)
        return self._process.returncode, said

    def end(self, number: signal.Signals = signal.SIGTERM) -> tuple[int, str]:
        """End it by its process id, if it runs; return its exit code and what it said."""
        if self._process.returncode is None:
            self._process.send_signal(number)
            return self.ended()
        return self._process.returncode, ""
