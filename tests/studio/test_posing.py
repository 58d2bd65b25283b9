"""Drags over the live connection: a posture for each, then what could be written."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest
from studio_server import Studio, until
from websockets.sync.client import ClientConnection

pytestmark = pytest.mark.slow
TEXT = "key 1\n    place @I_TIP(s) ^Mssp\n"
FOLLOWS_M = 0.005
LONGEST_MS = 50
"""Of processor time; `benchmarks/run.py studio` has the time of the whole way."""


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    folder = tmp_path_factory.mktemp("posing")
    (folder / "open").mkdir()
    started = Studio(folder / "open", folder / "kept.sqlite")
    yield started
    started.kill()


class Page:
    """What a page sends while somebody poses the body."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket, self.serial = socket, 0

    def act(self, act: str, session: int = 1, **fields: object) -> dict[str, Any]:
        self.serial += 1
        said = {"kind": "pose", "act": act, "session": session, "serial": self.serial, **fields}
        self.socket.send(json.dumps(said))
        return until(self.socket, "posed", serial=self.serial)[0]

    def open(self, text: str = TEXT, session: int = 1) -> dict[str, Any]:
        what = {"number": 1, "file": "a.azee", "text": text}
        return self.act("open", session, at_s=0.5, **what)


def place(answer: dict[str, Any], handle: str) -> list[float]:
    found: list[float] = next(g["at"] for g in answer["grips"] if g["handle"] == handle)
    return found


def test_a_drag_is_followed_at_once_and_ends_as_text(studio: Studio) -> None:
    with studio.live() as socket:
        page = Page(socket)
        opened = page.open()
        assert {"'AU12"} <= {*opened["face"]}
        assert {"'index_bend s"} <= {*opened["fingers"]}
        x, y, z = place(opened, "@I_TIP(s)")
        for k in range(60):
            goal = [x, y + 0.002 * k, z]
            moved = page.act("drag", handle="@I_TIP(s)", target=goal)
            assert moved["solve_ms"] < LONGEST_MS
            assert abs(place(moved, "@I_TIP(s)")[1] - goal[1]) < FOLLOWS_M
        told = page.act("propose", handle="@I_TIP(s)")
        best = told["proposals"][0]
        assert (best["kind"], told["missed"]) == ("replace", [])
        change = best["change"]
        written = TEXT[: change["from"]] + change["insert"] + TEXT[change["to"] :]
        again = page.open(written, session=2)
        there, after = (place(answer, "@I_TIP(s)") for answer in (told, again))
        assert max(abs(a - b) for a, b in zip(there, after, strict=True)) < best["off"] + 0.001


def test_what_cannot_be_posed_is_told_and_a_lost_session_is_named(studio: Studio) -> None:
    with studio.live() as socket:
        page = Page(socket)
        assert page.act("drag", handle="@I_TIP(s)", target=[0, 1, 0])["lost"]
        assert "no rule" in page.open(":abre\n")["message"]
        page.open()
        assert "no site" in page.act("drag", handle="@NOSE", target=[0, 1, 0])["message"]
        assert "too far" in page.act("drag", handle="@I_TIP(s)", target=[0, 9, 0])["message"]
        assert "a weight" in page.act("drag", handle="'AU12", target=[0, 1, 0])["message"]
        assert "nothing was dragged" in page.act("propose", handle="gaze")["message"]
        assert page.act("drag", session=9, handle="gaze", target=[0, 1, 1])["lost"]
        page.act("close")
        assert page.act("propose", handle="gaze")["lost"]


@pytest.mark.parametrize(
    "wrong",
    [
        {"act": "fly"},
        {"act": "drag", "handle": "", "target": [0, 1, 0]},
        {"act": "drag", "handle": "gaze", "target": [0, 1]},
        {"act": "drag", "handle": "gaze", "target": [0, 1, "x"]},
        {"act": "drag", "handle": "gaze", "target": [0, 1, 1e999]},
        {"act": "drag", "handle": "x" * 999, "target": [0]},
        {"act": "open", "at_s": None, "file": "a.azee", "text": "", "number": 1},
        {"act": "open", "at_s": 0, "file": "../a.azee", "text": "", "number": 1},
        {"act": "close", "session": -1},
        {"act": "close", "serial": True},
    ],
    ids=str,
)
def test_acts_that_are_none_are_refused(studio: Studio, wrong: dict[str, object]) -> None:
    with studio.live() as socket:
        socket.send(json.dumps({"kind": "pose", "session": 1, "serial": 1, **wrong}))
        assert until(socket, "refused")[0]["message"]
