"""Pages that tests open: azee's servers in processes of their own, ended by their ids; folders."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
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


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Say nothing."""


@contextmanager
def web_server(folder: Path) -> Iterator[str]:
    """Serve a folder as any web server does."""
    handler = partial(_Quiet, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()
        thread.join()
