"""What a study's server answers to whoever asks for more than the page offers."""

from __future__ import annotations

import http.client
from collections.abc import Iterator, Mapping
from pathlib import Path
from urllib.parse import urlencode, urlsplit

import pytest
from study_server import Server

from azee.cli.main import run
from azee.spelling.study.answers import Answers
from azee.spelling.study.questions import AGES, FLUENCIES

WORDS, TYPES = ("ÇAY", "DAVID"), ("variable", "constant")
WHO = {"age": AGES[1], "fluency": FLUENCIES[0], "name": "Ann", "mail": ""}


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    folder = tmp_path_factory.mktemp("study")
    for word in WORDS:
        for kind in TYPES:
            (folder / f"{word}-{kind}.mp4").write_bytes(f"{word} {kind}".encode())
    assert run(["study", "manifest", str(folder)]) == 0
    started = Server(folder)
    yield started
    started.kill()


def ask(
    server: Server,
    path: str,
    form: Mapping[str, str] | None = None,
    headers: Mapping[str, str] | None = None,
) -> tuple[int, str, str]:
    """Return status, text and cookie or place of an answer."""
    connection = http.client.HTTPConnection(urlsplit(server.url).netloc, timeout=20)
    body = urlencode(form) if form is not None else None
    kind = {"Content-Type": "application/x-www-form-urlencoded"} if form is not None else {}
    connection.request(
        "POST" if body is not None else "GET", path, body, {**kind, **(headers or {})}
    )
    answer = connection.getresponse()
    text = answer.read().decode()
    cookie = (answer.getheader("set-cookie") or "").partition(";")[0]
    connection.close()
    return answer.status, text, cookie or answer.getheader("location") or ""


@pytest.fixture(scope="module")
def cookie(server: Server) -> Mapping[str, str]:
    status, _, found = ask(server, "/begin", WHO)
    assert status == 303
    assert found.startswith("azee-study=")
    return {"Cookie": found}


def test_the_way_through_a_study(server: Server) -> None:
    _, first, _ = ask(server, "/")
    assert "25 participants" not in first
    assert "97 participants" in first  # of two words each
    _, _, found = ask(server, "/begin", WHO)
    me = {"Cookie": found}
    assert ask(server, "/", None, me)[2] == "/instructions"
    assert ask(server, "/page/1", {"choice": "second"}, me)[2] == "/page/2"
    assert ask(server, "/", None, me)[2] == "/page/2"
    assert ask(server, "/closing", None, me)[2] == "/page/2"
    assert "checked" in ask(server, "/page/1", None, me)[1]
    assert ask(server, "/page/2", {"choice": "first"}, me)[2] == "/closing"
    assert ask(server, "/closing", {"remark-0": "<i>", "remark-9": "x"}, me)[2] == "/done"
    assert ask(server, "/", None, me)[2] == "/done"
    answers = Answers.open(server.folder / "answers.sqlite")
    assert answers.choices(answers.participants()[-1]) == {1: "second", 2: "first"}
    assert answers.remarks()[-1][1:] == (0, "<i>")


def test_a_page_does_not_say_what_it_compares(server: Server, cookie: Mapping[str, str]) -> None:
    status, page, _ = ask(server, "/page/1", None, cookie)
    assert status == 200
    assert not any(name in page for name in (*WORDS, *TYPES))
    clips = {ask(server, f"/clip/1/{place}", None, cookie)[1] for place in (1, 2)}
    assert clips in [{f"{word} {kind}" for kind in TYPES} for word in WORDS]
    status, part, _ = ask(server, "/clip/1/1", None, {**cookie, "Range": "bytes=0-2"})
    assert (status, len(part.encode()[:3])) == (206, 3)


@pytest.mark.parametrize(
    ("path", "form", "headers", "status"),
    [
        ("/page/1", None, {"Cookie": "azee-study=guess"}, 403),
        ("/clip/1/1", None, {"Cookie": ""}, 403),
        ("/page/0", None, {}, 404),
        ("/page/3", None, {}, 404),
        ("/page/99999999999999999999", None, {}, 404),
        ("/clip/1/3", None, {}, 404),
        ("/sample", None, {}, 404),
        ("/manifest.json", None, {}, 404),
        ("/page/1", {}, {}, 400),
        ("/page/1", {"choice": "third"}, {}, 400),
        ("/page/1", {"choice": "none"}, {}, 400),
        ("/page/1", {"choice": "first"}, {"Origin": "http://evil.example"}, 403),
        ("/closing", {"remark-0": "x" * 200_000}, {}, 413),
        ("/begin", {"age": "7", "fluency": ""}, {}, 400),
        ("/", None, {"Host": "evil.example"}, 400),
        ("/begin", None, {}, 405),
    ],
)
def test_what_is_not_offered_is_refused_in_words(
    server: Server,
    cookie: Mapping[str, str],
    path: str,
    form: Mapping[str, str] | None,
    headers: Mapping[str, str],
    status: int,
) -> None:
    if path == "/closing":
        for page in ("/page/1", "/page/2"):
            ask(server, page, {"choice": "first"}, cookie)
    before = _kept(server)
    found, text, _ = ask(server, path, form, {**cookie, **headers})
    assert found == status
    assert "Traceback" not in text
    assert _kept(server) == before


def _kept(server: Server) -> list[dict[int, str]]:
    answers = Answers.open(server.folder / "answers.sqlite")
    return [dict(answers.choices(person)) for person in answers.participants()]


def test_a_port_that_is_taken_is_told(server: Server, capsys: pytest.CaptureFixture[str]) -> None:
    port = urlsplit(server.url).port
    assert run(["study", "serve", str(server.folder), "--port", str(port)]) == 2
    assert f"port {port} is taken" in capsys.readouterr().err


def test_a_folder_without_a_manifest(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["study", "serve", str(tmp_path)]) == 1
    assert "error[cannot-read]" in capsys.readouterr().err
