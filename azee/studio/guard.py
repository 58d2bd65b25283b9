"""Who may speak to a studio: pages of its own, on this machine, that know its token.

Any page in any tab can send requests to 127.0.0.1, and a name that an attacker owns can be made to
point there (DNS rebinding). So a request needs the token in its path, a Host that is ours, and,
where the browser tells one, an Origin that is ours. What does not fit is refused before a byte of
its body is read.
"""

from __future__ import annotations

import hmac

from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LARGEST_BODY = 2_500_000
"""Bytes of a request: a text with every character escaped, and what goes with it."""
_READING = ("GET", "HEAD")
_HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; connect-src 'self'; "
    "style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; media-src 'self' blob:; "
    "worker-src 'self'; font-src 'self'; form-action 'none'; frame-ancestors 'none'; "
    "base-uri 'none'",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


class Guard:
    """Lets requests through to an application, or refuses them.

    Args: token: the first part of every path. port: on which the server listens.
    """

    def __init__(self, app: ASGIApp, token: str, port: int) -> None:
        self._app, self._token = app, token
        self._hosts = {f"{host}:{port}".encode() for host in ("127.0.0.1", "localhost")}
        self._origins = {b"http://" + host for host in self._hosts}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request, one WebSocket, or the application's start and end."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        status = self._status(scope)
        if status and scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008})
        elif status:
            await PlainTextResponse("refused", status)(scope, receive, _with_headers(send))
        else:
            inside = {**scope, "root_path": f"/{self._token}"}
            await self._app(inside, _bounded(receive), _with_headers(send))

    def _status(self, scope: Scope) -> int:
        """Return the status of a refusal, or 0."""
        headers: list[tuple[bytes, bytes]] = scope["headers"]
        hosts = [value for name, value in headers if name == b"host"]
        origins = [value for name, value in headers if name == b"origin"]
        if len(hosts) != 1 or hosts[0].lower() not in self._hosts:
            return 421
        if any(origin not in self._origins for origin in origins):
            return 403
        needed = scope["type"] == "websocket" or scope["method"] not in _READING
        if needed and not origins:
            return 403
        site = next((value for name, value in headers if name == b"sec-fetch-site"), b"none")
        if site not in (b"none", b"same-origin"):
            return 403
        path: str = scope["path"]
        token = path.split("/")[1] if path.startswith("/") else ""
        if not hmac.compare_digest(token.encode("utf-8", "replace"), self._token.encode()):
            return 404
        if not path.isprintable() or "\\" in path:
            return 400
        length = next((value for name, value in headers if name == b"content-length"), b"0")
        if not length.isdigit() or int(length[:12]) > LARGEST_BODY:
            return 413
        return 0


def _bounded(receive: Receive) -> Receive:
    """Return what reads at most `LARGEST_BODY` of a body whose length was not told."""
    left = LARGEST_BODY

    async def bounded() -> Message:
        nonlocal left
        message = await receive()
        if message["type"] == "http.request":
            left -= len(message.get("body", b""))
            if left < 0:
                return {"type": "http.disconnect"}
        return message

    return bounded


def _with_headers(send: Send) -> Send:
    async def sent(message: Message) -> None:
        if message["type"] == "http.response.start":
            added = [(name.lower().encode(), value.encode()) for name, value in _HEADERS.items()]
            message = {**message, "headers": [*message.get("headers", ()), *added]}
        await send(message)

    return sent
