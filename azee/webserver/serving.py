"""Servers of pages for this machine: a socket on loopback, uvicorn, and an orderly end."""

from __future__ import annotations

import socket
from dataclasses import dataclass

import uvicorn
from starlette.types import ASGIApp

from azee.webserver.guard import LARGEST_BODY, Guard, new_token

LOOPBACK = "127.0.0.1"
GRACE_S = 2.0
"""How long answers that are under way may take when the server is told to end."""
AT_ONCE = 64
"""Requests that are answered at the same time; more are refused with 503."""


@dataclass(frozen=True)
class LocalServer:
    """A socket that listens on loopback, and the token that its addresses begin with."""

    socket: socket.socket
    token: str

    @classmethod
    def on(cls, port: int) -> LocalServer:
        """Listen. Args: port: 0 takes any that is free. Raises: OSError: the port is taken."""
        return cls(socket.create_server((LOOPBACK, port)), new_token())

    @property
    def port(self) -> int:
        """Where it listens."""
        return int(self.socket.getsockname()[1])

    @property
    def url(self) -> str:
        """Address of the page, with the token."""
        return f"http://{LOOPBACK}:{self.port}/{self.token}/"

    def serve(self, app: ASGIApp, *, largest_body: int = LARGEST_BODY) -> None:
        """Answer until the process is interrupted or terminated: SIGINT or SIGTERM to its id.

        Answers that are under way have `GRACE_S` to end; then the signal takes its usual course.

        Args: largest_body: bytes of a request or of a message over a WebSocket.
        """
        guarded = Guard(app, token=self.token, port=self.port, largest_body=largest_body)
        config = uvicorn.Config(
            guarded,
            log_level="warning",
            server_header=False,
            access_log=False,
            proxy_headers=False,
            limit_concurrency=AT_ONCE,
            timeout_graceful_shutdown=int(GRACE_S),
            ws_max_size=largest_body,
            ws_per_message_deflate=False,  # nothing leaves the machine
        )
        uvicorn.Server(config).run(sockets=[self.socket])
