"""What the server of the player page answers, and that it ends when it is told to."""

from __future__ import annotations

import http.client
import json
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from served import Served

MOST_BYTES = 200_000
LONG = "key 601\n    place @I_TIP(s) @CH\n"

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with Served(tmp_path_factory.mktemp("player"), "play", "--page", "AB") as server:
        yield server


def ask(
    server: Served, address: str, asked: Any = None, method: str | None = None, **headers: str
) -> tuple[int, bytes]:
    at = urlsplit(server.url)
    connection = http.client.HTTPConnection(at.netloc, timeout=120)
    body = asked if isinstance(asked, bytes | None) else json.dumps(asked).encode()
    own = {"Origin": f"http://{at.netloc}"} | {k.title(): v for k, v in headers.items()}
    method = method or ("GET" if body is None else "POST")
    connection.request(method, at.path + address, body, own)
    answer = connection.getresponse()
    found = answer.status, answer.read()
    connection.close()
    return found


def test_the_page_its_scripts_and_what_it_offers(served: Served) -> None:
    status, page = ask(served, "")
    assert (status, b"player.js" in page) == (200, True)
    assert ask(served, "vendor-three.js")[0] == 200
    offered = json.loads(ask(served, "catalogue.json")[1])
    assert (offered["live"], offered["body"], offered["text"]) == (True, "signer", "AB")
    assert {"signer", "child"} <= set(offered["bodies"])
    assert {s["id"] for s in offered["sources"]} >= {"asl", "lsf", "tid", "azee"}


def test_typed_text_becomes_a_clip_or_a_message(served: Served) -> None:
    status, clip = ask(served, "perform", {"text": "a b?", "source": "asl", "body": "signer"})
    assert (status, clip[:4]) == (200, b"AZWC")
    header = json.loads(clip[8 : 8 + int.from_bytes(clip[4:8], "little")])
    assert header["extras"]["told"] == ["the manual alphabet of ASL has no `?`; it is left out"]
    assert [label["text"] for label in header["labels"] if len(label["path"]) > 1] == ["A", "B"]
    status, told = ask(served, "perform", {"text": ":nobody", "source": "azee", "body": "signer"})
    (diagnostic,) = json.loads(told)["diagnostics"]
    assert (status, diagnostic["code"], diagnostic["line"]) == (422, "unknown-rule", 1)
    status, told = ask(served, "perform", {"text": "?", "source": "tid", "body": "signer"})
    assert (status, b"unknown-character" in told) == (422, True)
    status, told = ask(served, "perform", {"text": LONG, "source": "azee", "body": "signer"})
    assert (status, b"the page plays 600 s" in told) == (422, True)


@pytest.mark.parametrize(
    ("address", "asked", "status"),
    [
        ("perform", b"no json", 400),
        ("perform", b"[" * 100_000, 400),
        ("perform", [], 400),
        ("perform", {"text": 1, "source": "asl", "body": "signer"}, 400),
        ("perform", {"text": "a", "source": "asl", "body": "/etc"}, 400),
        ("perform", {"text": "a", "source": ["asl"], "body": ["signer"]}, 400),
        ("perform", {"text": "a" * 20_001, "source": "asl", "body": "signer"}, 413),
        ("perform", b"x" * (MOST_BYTES + 1), 413),
        ("body/../../rig.glb", None, 404),
        ("body/nobody.glb", None, 404),
        ("../../../../etc/passwd", None, 404),
        ("%2e%2e/%2e%2e/pyproject.toml", None, 404),
        ("..%5c..%5cpyproject.toml", None, 404),
    ],
)
def test_what_cannot_be_is_refused(served: Served, address: str, asked: Any, status: int) -> None:
    assert ask(served, address, asked)[0] == status


def test_mutated_requests_are_answered(served: Served) -> None:
    """The bytes of a good request, changed at random: no answer is a fault of the server."""
    good = json.dumps({"text": "", "source": "asl", "body": "signer"}).encode()
    drawn = random.Random(4)
    for _ in range(100):
        data = bytearray(good)
        for _ in range(drawn.randint(1, 4)):
            at = drawn.randrange(len(data))
            data[at : at + drawn.randint(0, 3)] = drawn.randbytes(drawn.randint(0, 3))
        assert ask(served, "perform", bytes(data))[0] in (400, 422)
    assert ask(served, "catalogue.json")[0] == 200


def test_strangers_are_refused(served: Served) -> None:
    assert ask(served, "", origin="http://evil.example")[0] == 403
    assert ask(served, "", host="evil.example")[0] == 421
    at = urlsplit(served.url)
    connection = http.client.HTTPConnection(at.netloc, timeout=20)
    connection.request("GET", "/catalogue.json")
    assert connection.getresponse().status == 403
    connection.close()


def test_it_ends_by_quit_and_by_its_process_id(tmp_path: Path) -> None:
    with Served(tmp_path, "play", "--page") as server:
        assert ask(server, "quit", b"")[0] == 200
        code, said = server.ended()
        assert (code, said.strip()) == (130, "")
    with Served(tmp_path, "play", "--page") as server:
        code, said = server.end()
        assert (code, said) == (143, "")
