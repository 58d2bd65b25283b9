"""What a server on loopback refuses, before its application sees it."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import Message, Scope
from starlette.websockets import WebSocket

from azee.webserver.guard import HEADERS, Guard, new_token

TOKEN, PORT, LARGEST = "t0ken-_A", 8123, 100
HOST = f"127.0.0.1:{PORT}"
OWN = {"host": HOST, "origin": f"http://{HOST}"}


async def _page(request: Request) -> Response:
    return PlainTextResponse(str(request.url_for("page")))


async def _echo(request: Request) -> Response:
    return PlainTextResponse(await request.body())


async def _talk(socket: WebSocket) -> None:
    await socket.accept()
    async for text in socket.iter_text():
        await socket.send_text(text.upper())


def _app() -> Guard:
    routes = [
        Route("/", _page, name="page"),
        Route("/echo", _echo, methods=["POST"]),
        WebSocketRoute("/talk", _talk),
    ]
    return Guard(Starlette(routes=routes), token=TOKEN, port=PORT, largest_body=LARGEST)


@dataclass
class Exchange:
    """Messages to and from an application."""

    coming: list[Message]
    sent: list[Message] = field(default_factory=list)

    async def receive(self) -> Message:
        return self.coming.pop(0) if self.coming else {"type": "http.disconnect"}

    async def send(self, message: Message) -> None:
        self.sent.append(message)

    @property
    def status(self) -> int:
        return int(self.sent[0]["status"])

    @property
    def body(self) -> str:
        return b"".join(m.get("body", b"") for m in self.sent[1:]).decode()


def _scope(kind: str, path: str, headers: Sequence[tuple[str, str]]) -> Scope:
    raw = [(name.encode("latin-1"), value.encode("latin-1")) for name, value in headers]
    return {
        "type": kind, "path": path, "root_path": "", "headers": raw, "query_string": b"",
        "server": ("127.0.0.1", PORT), "scheme": "http" if kind == "http" else "ws",
    }  # fmt: skip


def ask(
    path: str,
    headers: Mapping[str, str] = OWN,
    method: str = "GET",
    parts: Sequence[bytes] = (b"",),
) -> Exchange:
    last = len(parts) - 1
    exchange = Exchange(
        [{"type": "http.request", "body": p, "more_body": i < last} for i, p in enumerate(parts)]
    )
    scope = {**_scope("http", path, [*headers.items()]), "method": method}
    asyncio.run(_app()(scope, exchange.receive, exchange.send))
    return exchange


def talk(headers: Mapping[str, str], *texts: str, path: str = f"/{TOKEN}/talk") -> list[Message]:
    coming: list[Message] = [{"type": "websocket.connect"}]
    coming += [{"type": "websocket.receive", "text": text} for text in texts]
    exchange = Exchange([*coming, {"type": "websocket.disconnect", "code": 1000}])
    asyncio.run(_app()(_scope("websocket", path, [*headers.items()]), exchange.receive,
                       exchange.send))  # fmt: skip
    return exchange.sent


def test_the_page_is_behind_the_token_and_its_addresses_keep_it() -> None:
    page = ask(f"/{TOKEN}/")
    assert (page.status, page.body) == (200, f"http://{HOST}/{TOKEN}/")
    there = {name.decode() for name, _ in page.sent[0]["headers"]}
    assert there >= set(HEADERS)


@pytest.mark.parametrize(
    ("path", "headers", "status"),
    [
        (f"/{TOKEN}/", {}, 421),
        (f"/{TOKEN}/", {"host": f"evil.example:{PORT}"}, 421),
        (f"/{TOKEN}/", {"host": "127.0.0.1"}, 421),
        (f"/{TOKEN}/", {"host": f"{HOST}.evil.example"}, 421),
        (f"/{TOKEN}/", OWN | {"origin": "http://evil.example"}, 403),
        (f"/{TOKEN}/", OWN | {"origin": "null"}, 403),
        (f"/{TOKEN}/", OWN | {"origin": f"https://{HOST}"}, 403),
        (f"/{TOKEN}/", {"host": f"localhost:{PORT}", "origin": f"http://{HOST}"}, 403),
        ("/", OWN, 403),
        (f"/{TOKEN}", OWN, 404),
        (f"/{TOKEN}x/", OWN, 403),
        (f"//{TOKEN}/", OWN, 403),
        (f"/other/../{TOKEN}/", OWN, 403),
        (f"/{TOKEN.lower()}/", OWN, 403),
    ],
)
def test_strangers_are_refused(path: str, headers: Mapping[str, str], status: int) -> None:
    refused = ask(path, headers)
    assert refused.status == status
    assert TOKEN not in refused.body


def test_a_browser_that_opens_the_page_sends_no_origin_but_changes_need_one() -> None:
    host = {"host": HOST}
    assert ask(f"/{TOKEN}/", host).status == 200
    assert ask(f"/{TOKEN}/echo", host, "POST", [b"a"]).status == 403
    assert ask(f"/{TOKEN}/echo", OWN, "POST", [b"a"]).body == "a"


def test_a_header_that_is_there_twice_is_refused() -> None:
    scope = _scope("http", f"/{TOKEN}/", [("host", HOST), ("host", "evil.example")])
    exchange = Exchange([{"type": "http.request"}])
    asyncio.run(_app()({**scope, "method": "GET"}, exchange.receive, exchange.send))
    assert exchange.status == 400


def test_bodies_are_bounded_whatever_they_say_of_their_length() -> None:
    whole = [b"x" * LARGEST]
    assert ask(f"/{TOKEN}/echo", OWN, "POST", whole).body == "x" * LARGEST
    assert ask(f"/{TOKEN}/echo", OWN, "POST", [*whole, b"x"]).status == 413
    for length in (str(LARGEST + 1), "-1", "1e9", "", "9" * 5000):
        refused = ask(f"/{TOKEN}/echo", OWN | {"content-length": length}, "POST", [b"x"])
        assert refused.status == 413


def test_a_websocket_needs_token_and_origin_and_small_messages() -> None:
    assert [m.get("text") for m in talk(OWN, "a", "b")] == [None, "A", "B"]
    assert talk({"host": HOST}, "a")[0]["code"] == 1008
    assert talk(OWN | {"origin": "http://evil.example"}, "a")[0]["code"] == 1008
    assert talk(OWN, "a", path="/talk")[0]["code"] == 1008
    sent = talk(OWN, "a", "x" * (LARGEST + 1), "b")
    assert [m.get("text") for m in sent] == [None, "A", None]
    assert (sent[-1]["type"], sent[-1]["code"]) == ("websocket.close", 1009)


_WORD = st.text(st.characters(codec="latin-1"), max_size=20)
_HEADER = st.sampled_from([*OWN.items(), ("host", "[::1]"), ("content-length", "٣")]) | st.tuples(
    st.sampled_from(["host", "origin", "content-length", "x"]), _WORD
)


@given(
    path=st.lists(st.sampled_from([TOKEN, "..", "%2e%2e", ""]) | st.text(max_size=8)).map("/".join),
    headers=st.lists(_HEADER, max_size=4),
    method=st.sampled_from(["GET", "POST", "HEAD", "DELETE", "X"]),
)
@settings(max_examples=40)
@example(path="\ud800/", headers=[*OWN.items()], method="GET")
def test_any_request_is_answered_and_only_with_the_token_inside(
    path: str, headers: list[tuple[str, str]], method: str
) -> None:
    exchange = Exchange([{"type": "http.request", "body": b"x"}])
    kept = [(k, v) for k, v in headers if v.isascii() or k != "content-length"]
    scope = {**_scope("http", f"/{path}", kept), "method": method}
    asyncio.run(_app()(scope, exchange.receive, exchange.send))
    if exchange.status < 400:
        assert path.startswith(f"{TOKEN}/")
        assert dict(kept)["host"] in OWN["host"]


def test_tokens_differ_and_fit_into_a_path() -> None:
    assert len({new_token() for _ in range(20)}) == 20
    assert all(c.isalnum() or c in "-_" for c in new_token())
