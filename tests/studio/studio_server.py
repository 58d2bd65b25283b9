"""A studio that tests start, speak to, kill and start again."""

from __future__ import annotations

import http.client
import json
import os
import re
import signal
import struct
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin


class Studio:
    """`azee studio` in a process of its own, with a new address after every start."""

    def __init__(self, folder: Path, kept: Path) -> None:
        self.folder, self._kept = folder, kept
        self.start()

    def start(self) -> None:
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "azee", "studio", str(self.folder), "--no-browser",
             "--kept", str(self._kept)],
            env=environment, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        assert self.process.stderr is not None
        line = self.process.stderr.readline()
        found = re.search(r"http://127\.0\.0\.1:\d+/[\w-]+/", line)
        assert found, line + self.process.stderr.read()
        self.url = found[0]
        self.origin = f"http://{urlsplit(self.url).netloc}"
        self.path = urlsplit(self.url).path

    def kill(self) -> None:
        """Kill it without a word; its worker ends with its input."""
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        assert self.process.stderr is not None
        self.process.stderr.close()

    def ask(
        self,
        path: str,
        method: str = "GET",
        body: object = None,
        headers: Mapping[str, str] | None = None,
        raw: bytes | None = None,
    ) -> tuple[int, bytes]:
        """Return status and body of an answer. `path` follows the token."""
        return self.ask_whole(self.path + path, method, body, headers, raw)

    def ask_whole(
        self,
        path: str,
        method: str = "GET",
        body: object = None,
        headers: Mapping[str, str] | None = None,
        raw: bytes | None = None,
    ) -> tuple[int, bytes]:
        """Return status and body of an answer to a path from the root."""
        connection = http.client.HTTPConnection(urlsplit(self.url).netloc, timeout=60)
        sent = raw if raw is not None else None if body is None else json.dumps(body).encode()
        own = {"Origin": self.origin} if method != "GET" else {}
        try:
            with suppress(BrokenPipeError):  # it refuses before it has read everything
                connection.request(method, path, sent, {**own, **(headers or {})})
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def live(self, origin: str | None = "own") -> ClientConnection:
        """Return a live connection of a page; the caller closes it."""
        said = self.origin if origin == "own" else origin
        return connect(
            self.url.replace("http:", "ws:") + "live",
            max_size=None,
            proxy=None,
            origin=None if said is None else Origin(said),
        )


def received(socket: ClientConnection, timeout: float = 120) -> tuple[dict[str, Any], bytes]:
    """Return the next message of a server: its header, and its bytes."""
    data = socket.recv(timeout=timeout)
    if isinstance(data, str):
        return json.loads(data), b""
    (length,) = struct.unpack_from("<I", data)
    return json.loads(data[4 : 4 + length]), data[4 + length :]


def until(socket: ClientConnection, kind: str, **fields: object) -> tuple[dict[str, Any], bytes]:
    """Return the next message of a kind with some values; others are passed over."""
    while True:
        header, payload = received(socket)
        if header["kind"] == kind and fields.items() <= header.items():
            return header, payload
