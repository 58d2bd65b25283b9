"""Strangers are refused, the folder is the limit, work is bounded, and the server lives."""

from __future__ import annotations

import json
import random
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from pathlib import Path

import pytest
from studio_server import Studio, received, until
from websockets.exceptions import ConnectionClosed, InvalidStatus

pytestmark = pytest.mark.slow
SECRET = "what nobody may read"
MUTATIONS = 1000
PAGES, EACH = 8, 25
"""Connections at a time, and messages over each."""
LARGEST_MB = 400
"""Of the server's own memory, whatever it is asked."""


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    folder = tmp_path_factory.mktemp("studio")
    (folder / "open" / "sub").mkdir(parents=True)
    (folder / "secret.azee").write_text(SECRET)
    (folder / "secret.mp4").write_text(SECRET)
    (folder / "open" / "a.azee").write_text(":arbre\n")
    (folder / "open" / "film.mp4").write_bytes(bytes(1000))
    (folder / "open" / "link.azee").symlink_to(folder / "secret.azee")
    (folder / "open" / "out").symlink_to(folder)
    started = Studio(folder / "open", folder / "kept.sqlite")
    yield started
    started.kill()


def test_the_page_and_its_files_are_served(studio: Studio) -> None:
    status, page = studio.ask("")
    assert status == 200
    for name in re.findall(rb'(?:src|href)="\./([^"]+)"', page):
        assert studio.ask(name.decode())[0] == 200
    listed = json.loads(studio.ask("api/files")[1])
    assert (listed["files"], listed["films"]) == (["a.azee"], ["film.mp4"])
    assert listed["bodies"][0] == "signer"
    status, part = studio.ask("film?name=film.mp4", headers={"Range": "bytes=0-9"})
    assert (status, len(part)) == (206, 10)


@pytest.mark.parametrize(
    "headers",
    [
        {"Host": "evil.example"},
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Host": "127.0.0.1"},
    ],
    ids=str,
)
def test_other_hosts_and_origins_are_refused(studio: Studio, headers: dict[str, str]) -> None:
    for path in ("", "api/files", "api/file?name=a.azee"):
        assert studio.ask(path, headers=headers)[0] in (403, 421)
    assert studio.ask("api/file?name=a.azee", "PUT", {"text": ""}, headers)[0] in (403, 421)


def test_nothing_is_there_without_the_token(studio: Studio) -> None:
    for path in ("/", "/api/files", "/x/api/files", "/live", "/studio.html", "//", "/%2e%2e/"):
        status, body = studio.ask_whole(path)
        assert status in (403, 404)
        assert SECRET.encode() not in body
    assert studio.ask("api/file?name=a.azee", "PUT", {"text": ""}, {"Origin": ""})[0] == 403


@pytest.mark.parametrize("origin", ["http://evil.example", None])
def test_a_live_connection_needs_an_origin_of_ours(studio: Studio, origin: str | None) -> None:
    with pytest.raises(InvalidStatus), studio.live(origin):
        pass


@pytest.mark.parametrize(
    "name",
    [
        *("../secret.azee", "%2e%2e/secret.azee", "..%2fsecret.azee", "%2e%2e%2fsecret.azee"),
        *("..%5csecret.azee", "sub/..%2f..%2fsecret.azee", "link.azee", "out/secret.azee"),
        *("%00.azee", "%ff%fe.azee", "....//secret.azee", "%252e%252e%252fsecret.azee"),
        *("/etc/passwd", "%2fetc%2fpasswd", "..%c0%afsecret.azee", "a.azee%00.txt"),
    ],
)
def test_no_name_leads_out_of_the_folder(studio: Studio, name: str) -> None:
    for path in (f"api/file?name={name}", f"film?name={name.replace('azee', 'mp4')}", name,
                 f"body/{name}", f"api/versions?name={name}"):  # fmt: skip
        status, body = studio.ask(path)
        assert SECRET.encode() not in body
        assert b"root:" not in body
        assert status >= 400 or path.startswith("api/versions")
    before = sorted(studio.folder.parent.glob("*"))
    studio.ask(f"api/file?name={name}", "PUT", {"text": "x", "digest": None})
    assert sorted(studio.folder.parent.glob("*")) == before
    assert (studio.folder.parent / "secret.azee").read_text() == SECRET


def test_the_language_server_reads_nothing_outside_either(studio: Studio) -> None:
    with studio.live() as socket:
        root = until(socket, "hello")[0]["root"]
        for number, uri in enumerate(
            [root.replace("/open", "/secret.azee"), "file:///etc/passwd", f"{root}/link.azee",
             f"{root}/../secret.azee", f"{root}/out/secret.azee"]
        ):  # fmt: skip
            params = {"textDocument": {"uri": uri}}
            message = {"jsonrpc": "2.0", "id": number, "method": "textDocument/documentSymbol",
                       "params": params}  # fmt: skip
            socket.send(json.dumps({"kind": "lsp", "message": message}))
            answer = until(socket, "lsp")[0]["message"]
            assert answer["id"] == number
            assert "outside" in answer["error"]["message"]


def test_a_page_that_ends_its_language_server_ends_no_other(studio: Studio) -> None:
    start = {"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"capabilities": {}}}
    with studio.live() as first, studio.live() as second:
        for socket in (first, second):
            socket.send(json.dumps({"kind": "lsp", "message": start}))
            assert "result" in until(socket, "lsp")[0]["message"]
        first.send(json.dumps({"kind": "lsp", "message": {"jsonrpc": "2.0", "method": "exit"}}))
        ask = {"jsonrpc": "2.0", "id": 2, "method": "workspace/symbol", "params": {"query": "a"}}
        for _ in range(2):
            second.send(json.dumps({"kind": "lsp", "message": ask}))
            assert "result" in until(second, "lsp")[0]["message"]


def test_a_text_comes_as_score_and_movement(studio: Studio) -> None:
    with studio.live() as socket:
        job = {"kind": "compile", "number": 5, "file": "a.azee", "text": ":arbre\n"}
        socket.send(json.dumps(job))
        assert until(socket, "score", number=5)[0]["blocks"][0]["rule"] == "arbre"
        _, clip = until(socket, "clip", number=5)
        assert clip.startswith(b"AZWC")
        assert until(socket, "report", number=5)[0]["constraints"]
        socket.send(json.dumps({"kind": "draft", "file": "a.azee", "text": ":a", "number": 6}))
        assert until(socket, "kept")[0]["number"] == 6
    assert json.loads(studio.ask("api/file?name=a.azee")[1])["draft"]["text"] == ":a"
    assert studio.ask("api/draft?name=a.azee", "DELETE")[0] == 200


MOVE = {"edit": "move", "path": [], "row": 0, "to_path": [], "to_row": 2}
REQUESTS = [
    ("GET", "api/file?name=a.azee", None),
    ("PUT", "api/file?name=new.azee", {"text": ":arbre\n", "digest": None}),
    ("GET", "api/version?name=a.azee&number=1", None),
    ("POST", "api/rules", {"file": "a.azee", "text": ":arbre\n"}),
    ("POST", "api/blocks", {"file": "a.azee", "text": ":arbre('loc ^Mssp)\n"}),
    ("POST", "api/edit", {"file": "a.azee", "text": ":a\n:b\n", "edit": MOVE}),
    ("POST", "api/export", {"file": "a.azee", "text": ":abre\n", "number": 1, "suffix": ".bvh"}),
    ("GET", "body/signer.glb", None),
    ("GET", "film?name=film.mp4", None),
]
BEGIN: dict[str, object] = {"capabilities": {}, "processId": None, "rootUri": None}
TEXT = {"uri": "file:///a.azee", "languageId": "azee", "version": 1, "text": ""}
CALLS: list[dict[str, object]] = [
    {"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": BEGIN},
    {"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": TEXT}},
]
MESSAGES: list[dict[str, object]] = [
    {"kind": "compile", "number": 1, "file": "a.azee", "text": ":abre\n", "rig": "signer"},
    {"kind": "draft", "number": 1, "file": "b.azee", "text": ":abre\n", "digest": None},
    {"kind": "watch", "file": "a.azee", "digest": "0"},
    {"kind": "lsp", "message": CALLS[0]},
    {"kind": "lsp", "message": CALLS[1]},
    {"kind": "pose", "act": "drag", "session": 1, "serial": 1, "handle": "gaze", "target": [0]},
    {
        "kind": "pose",
        "act": "open",
        "session": 1,
        "serial": 2,
        "at_s": 0,
        "number": 1,
        "file": "a.azee",
        "text": ":abre\n",
    },
]


def mutated(data: bytes, rng: random.Random) -> bytes:
    """Change, remove, repeat or insert some bytes, or a word that means something."""
    changed = bytearray(data)
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(changed) + 1)
        match rng.randrange(5):
            case 0:
                changed[at : at + 1] = bytes([rng.randrange(256)])
            case 1:
                del changed[at : at + rng.randint(1, 8)]
            case 2:
                changed[at:at] = changed[max(0, at - 20) : at] * rng.randint(1, 50)
            case 3:
                words = (b"..", b"null", b"1e999", b"[" * 3000, b"\\ud800", b"-1", b'"x":', b"{}")
                changed[at:at] = rng.choice(words)
            case _:
                changed[at:at] = b"9" * rng.randint(1, 400)
    return bytes(changed)


def mutated_request(rng: random.Random) -> tuple[str, str, bytes | None]:
    """Return method, path and body of a request that is not quite one of ours."""
    method, path, body = rng.choice(REQUESTS)
    raw = None if body is None else mutated(json.dumps(body).encode(), rng)
    if rng.random() < 0.5 or raw is None:
        path = mutated(path.encode(), rng).decode("latin-1")
        path = re.sub(r"[^!-~]", lambda m: f"%{ord(m[0]):02x}", path)[:3000]
    return method, path, raw


def say(studio: Studio, messages: Sequence[str]) -> None:
    """Send messages over one live connection, until it is closed or all are answered."""
    with studio.live() as socket, suppress(ConnectionClosed):
        for message in messages:
            socket.send(message)
        socket.send(json.dumps({"kind": "nothing"}))
        until(socket, "refused", message="there is no such kind of message")


def test_a_thousand_mutated_requests_and_messages_are_refused_bounded_and_survived(
    studio: Studio,
) -> None:
    """Some at a time, as from several pages: alone, each would wait for the one before."""
    rng = random.Random(7)
    requests = [mutated_request(rng) for _ in range(MUTATIONS // 2)]
    messages = [
        mutated(json.dumps(rng.choice(MESSAGES)).encode(), rng).decode("utf-8", "replace")
        for _ in range(MUTATIONS // 2)
    ]
    talks = [messages[i : i + EACH] for i in range(0, len(messages), EACH)]
    with ThreadPoolExecutor(PAGES) as pool:
        answers = pool.map(lambda r: studio.ask(r[1], r[0], headers={}, raw=r[2]), requests)
        spoken = pool.map(partial(say, studio), talks)
        seen = Counter[int]()
        for request, (status, answer) in zip(requests, answers, strict=True):
            seen[status] += 1
            assert SECRET.encode() not in answer
            assert status < 500 or status == 503, (request, answer)
        assert len([*spoken]) == len(talks)
    assert sum(count for status, count in seen.items() if status >= 400) > MUTATIONS // 5
    test_a_text_comes_as_score_and_movement(studio)
    assert _memory_mb(studio) < LARGEST_MB


def test_a_body_that_is_too_large_is_refused(studio: Studio) -> None:
    status, _ = studio.ask("api/rules", "POST", raw=b"x" * 3_000_000)
    assert status == 413
    with studio.live() as socket:
        received(socket)

        def say_too_much() -> None:
            socket.send("x" * 3_000_000)  # it may close while this is being sent
            until(socket, "nothing")

        with pytest.raises(ConnectionClosed):
            say_too_much()


def _memory_mb(studio: Studio) -> float:
    status = Path(f"/proc/{studio.process.pid}/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1000  # type: ignore[index]
