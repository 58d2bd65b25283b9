"""A study's server that tests start, kill and start again."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path


class Server:
    """`azee study serve` in a process of its own, on one port, however often it is killed."""

    def __init__(self, folder: Path) -> None:
        self.folder, self._port = folder, 0
        self.start()

    def start(self) -> None:
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
        self._process = subprocess.Popen(
            [sys.executable, "-m", "azee", "study", "serve", str(self.folder),
             "--port", str(self._port)],
            env=environment, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        assert self._process.stderr is not None
        line = self._process.stderr.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)/", line)
        assert found, line + self._process.stderr.read()
        self._port, self.url = int(found[1]), found[0]
        self._process.stderr.readline()
        assert "participants" in self._process.stderr.readline()

    def kill(self) -> None:
        self._process.send_signal(signal.SIGKILL)
        self._process.wait()
        assert self._process.stderr is not None
        self._process.stderr.close()
