"""Refuses what the page of a server did not ask for.

A server on loopback can be reached by every page that is open in a browser of the same machine, and
by other users. So a request must name this machine in `Host` (against rebinding of names), come
from the server's own page where it has an `Origin`, begin its path with a token that was made when
the server started, and be small.
"""

from __future__ import annotations

import secrets
from collections.abc import Iterable, Mapping

from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocketDisconnect

LARGEST_BODY = 1_000_000
"""Bytes of a request, or of one message over a WebSocket, if nothing else is said."""
READING = frozenset({"GET", "HEAD"})
"""Methods that change nothing. All others need an `Origin`."""
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' blob: data:; media-src 'self' blob:; font-src 'self'; connect-src 'self'; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'self'"
)
"""Content-Security-Policy: a page loads what its own server has. Styles may stand in elements."""
HEADERS: Mapping[str, str] = {
    "content-security-policy": POLICY,
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
}
"""Sent with every answer that does not set them itself."""
TOO_BIG, REFUSED = 1009, 1008
"""How a WebSocket is closed (RFC 6455, 7.4.1)."""
TOO_MUCH = "That is more than this server takes."


def new_token() -> str:
    """Return 192 random bits that can stand in a path."""
    return secrets.token_urlsafe(24)


class _RefusedError(Exception):
    """A request that the application does not see. Its text is for who sent it."""

    def __init__(self, status: int, reason: str) -> None:
        super().__init__(reason)
        self.status = status


class Guard:
    """An ASGI middleware around all of a server.

    The application sees the path behind the token: its `root_path` ends with the token, so that
    addresses which Starlette makes keep it.

    Args: token: the first part of every path. port: where the server listens.
        largest_body: bytes of a request or of a message over a WebSocket.
    """

    def __init__(
        self, app: ASGIApp, *, token: str, port: int, largest_body: int = LARGEST_BODY
    ) -> None:
        self._app, self._token, self._largest = app, token.encode(), largest_body
        self._hosts = tuple(f"{name}:{port}" for name in ("127.0.0.1", "localhost"))

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it in one sentence."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        exchange = _Exchange(receive, send, self._largest)
        try:
            inner = self._admitted(scope)
        except _RefusedError as refusal:
            await exchange.refuse(scope, refusal)
            return
        try:
            await self._app(inner, exchange.receive, exchange.send)
        except (ClientDisconnect, WebSocketDisconnect):
            if not exchange.too_big:  # else the application was told that the other side has gone
                raise
        if exchange.too_big:
            await exchange.refuse(scope, _RefusedError(413, TOO_MUCH))

    def _admitted(self, scope: Scope) -> Scope:
        """Return the scope behind the token. Raises: _RefusedError."""
        headers = scope["headers"]
        host = _only(headers, b"host")
        if host not in self._hosts:
            raise _RefusedError(421, "This server answers to the names of its own machine only.")
        origin = _only(headers, b"origin")
        if origin is None and (scope["type"] == "websocket" or scope["method"] not in READING):
            raise _RefusedError(
                403, "A request that changes something must say where it comes from."
            )
        if origin not in (None, f"http://{host}"):
            raise _RefusedError(403, "This request comes from another site.")
        root = scope.get("root_path", "")
        first, slash, _ = scope["path"].removeprefix(root).removeprefix("/").partition("/")
        if not secrets.compare_digest(first.encode("utf-8", "surrogatepass"), self._token):
            raise _RefusedError(403, "Open the address that azee printed: it holds a token.")
        if not slash:
            raise _RefusedError(404, "The address of the page ends with a slash.")
        length = _only(headers, b"content-length")
        if length is not None and not _at_most(length, self._largest):
            raise _RefusedError(413, TOO_MUCH)
        return {**scope, "root_path": f"{root}/{first}"}


def _only(headers: Iterable[tuple[bytes, bytes]], name: bytes) -> str | None:
    """Return the value of a header, or None. Raises: _RefusedError: it is there twice."""
    found = [value.decode("latin-1") for key, value in headers if key == name]
    if len(found) > 1:
        raise _RefusedError(400, f"The header {name.decode()} is there twice.")
    return found[0] if found else None


def _at_most(length: str, largest: int) -> bool:
    """Whether a length is a number up to a bound; Python refuses to read those of many digits."""
    return length.isdecimal() and len(length) <= len(str(largest)) and int(length) <= largest


class _Exchange:
    """What the application receives, up to a bound, and sends, until the bound is passed.

    Beyond it the application is told that the other side has gone, and what it says then is not
    sent.
    """

    def __init__(self, receive: Receive, send: Send, largest: int) -> None:
        self._receive, self._send, self._largest = receive, send, largest
        self._taken, self._begun = 0, False
        self.too_big = False

    async def receive(self) -> Message:
        """Receive a message, or that the other side has gone."""
        message = await self._receive()
        if message["type"] == "http.request":
            self._taken += len(message.get("body", b""))
            size = self._taken
        elif message["type"] == "websocket.receive":
            size = max(len(message.get(kind) or "") for kind in ("bytes", "text"))
        else:
            return message
        if size <= self._largest:
            return message
        self.too_big = True
        if message["type"] == "http.request":
            return {"type": "http.disconnect"}
        return {"type": "websocket.disconnect", "code": TOO_BIG}

    async def send(self, message: Message) -> None:
        """Send a message with the headers that keep pages apart."""
        if self.too_big:
            return
        self._begun = True
        if message["type"] == "http.response.start":
            message = {**message, "headers": _with_ours(message.get("headers", ()))}
        await self._send(message)

    async def refuse(self, scope: Scope, refusal: _RefusedError) -> None:
        """Say why a request is not answered, or close a WebSocket for that reason."""
        if scope["type"] == "websocket":
            code = TOO_BIG if refusal.status == 413 else REFUSED
            await self._send({"type": "websocket.close", "code": code, "reason": str(refusal)})
            return
        if self._begun:
            return
        body = f"{refusal}\n".encode()
        headers = _with_ours([
            (b"content-type", b"text/plain; charset=utf-8"),
            (b"content-length", str(len(body)).encode()),
            (b"connection", b"close"),
        ])  # fmt: skip
        await self._send(
            {"type": "http.response.start", "status": refusal.status, "headers": headers}
        )
        await self._send({"type": "http.response.body", "body": body})


def _with_ours(headers: Iterable[tuple[bytes, bytes]]) -> list[tuple[bytes, bytes]]:
    there = [*headers]
    known = {name.lower() for name, _ in there}
    ours = ((name.encode(), value.encode()) for name, value in HEADERS.items())
    return [*there, *(header for header in ours if header[0] not in known)]
