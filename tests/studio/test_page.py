"""The page in headless Chromium as people use it, and what is left when something is killed.

`STUDIO_PICTURES=FOLDER` keeps screenshots, to be looked at.
"""

from __future__ import annotations

import json
import math
import os
import random
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from programs import NODE_FOLDER, Node
from studio_server import Studio

pytestmark = pytest.mark.slow
WRITTEN = ":info-about\n    'topic\n    :personne\n    'info\n    :âge\n    "
LOST_S = 1.0
"""The most of typing that may be lost."""


@pytest.fixture
def studio(tmp_path: Path) -> Iterator[Studio]:
    (tmp_path / "texts").mkdir()
    started = Studio(tmp_path / "texts", tmp_path / "kept.sqlite")
    yield started
    started.kill()


def journey(browser: Node, name: str, studio: Studio) -> dict[str, Any]:
    pictures = os.environ.get("STUDIO_PICTURES", "")
    told: dict[str, Any] = json.loads(browser("studio_page.mjs", name, studio.url, pictures))
    assert told["complaints"] == []
    assert told["foreign"] == []
    return told


def test_a_new_author_writes_errs_mends_sees_saves_and_comes_back(
    browser: Node, studio: Studio, tmp_path: Path
) -> None:
    told = journey(browser, "author", studio)
    assert told["problem"].startswith("3:5 there is no rule `:persone`")
    assert (told["under"], told["problems"]) == (":persone", 0)
    assert told["text"] == told["reloaded"] == WRITTEN
    assert told["moved_m"] > 0.1
    assert told["chosen"].startswith("INFO · âge")
    assert told["lit"] == ["    :âge"]
    assert (told["speed"], told["first_rule"]) == (0.5, ":tree ['loc ^Mssp]")
    assert told["reasons"] > 5
    assert told["blocks"] == [":info-about", ":personne", ":âge"]
    assert (told["exported"], told["export_begins"]) == ("untitled.bvh", "HIERARCHY")
    assert told["state"] == "Saved"
    assert (tmp_path / "texts" / "untitled.azee").read_text(encoding="utf-8") == WRITTEN
    assert told["faults"] == []
    for width in (1366, 1024, 390):
        assert told[f"wide_{width}"] == width


def test_everything_is_reached_by_keys_alone(browser: Node, studio: Studio, tmp_path: Path) -> None:
    told = journey(browser, "keys", studio)
    assert told["parts"] == ["text", "signer", "score", "text", "panel"]
    assert told["toggles"]
    assert told["loops"]
    assert told["block"]
    assert (told["tab"], told["tree"]) == ("tab-blocks", "treeitem")
    assert (told["closed"], told["back"]) == (True, "tab-blocks")
    assert (tmp_path / "texts" / "untitled.azee").read_text() == ":arbre\n"


@pytest.mark.parametrize("victim", ["server", "worker", "browser"])
def test_who_is_killed_takes_no_more_than_a_second_of_typing_along(
    browser: Node, studio: Studio, victim: str
) -> None:
    assert browser.chromium is not None
    with subprocess.Popen(
        [browser.program, "studio_page.mjs", "typing", studio.url, ""],
        cwd=NODE_FOLDER, env=os.environ | {"CHROMIUM": browser.chromium},
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
    ) as typing:  # fmt: skip
        assert typing.stdout is not None
        pids = {"browser": json.loads(typing.stdout.readline())["browser"]}
        pids |= {"server": studio.process.pid, "worker": _worker(studio.process.pid)}
        typed: list[tuple[int, float]] = []
        killed_s = math.inf
        while time.time() < killed_s:
            line = json.loads(typing.stdout.readline())
            typed.append((line["typed"], line["at"] / 1000))
            if len(typed) == 1:  # the page may take long to open
                killed_s = random.Random(victim).uniform(2, 6) + time.time()
        os.kill(pids[victim], signal.SIGKILL)
        killed_s = time.time()
        time.sleep(1.5 if victim == "worker" else 0)
        typing.kill()
    if victim == "server":
        studio.kill()
        studio.start()
    elif victim == "worker":
        assert _worker(studio.process.pid) != pids["worker"]
    told = journey(browser, "text", studio)
    due = [number for number, at in typed if at < killed_s - LOST_S]
    assert len(due) > 3
    found = told["text"].split("\n")
    assert [f"# {number}" for number in due] == found[: len(due)]
    assert any("not saved" in notice for notice in told["notices"])


def _worker(server: int) -> int:
    """Return the process id of the worker of a server; it is its only child."""
    for _ in range(600):
        children = Path(f"/proc/{server}/task/{server}/children").read_text().split()
        if children:
            return int(children[0])
        time.sleep(0.1)
    raise AssertionError("the server has no worker")
