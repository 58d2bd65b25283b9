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


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """One server for all journeys, each with a text of its own."""
    folder = tmp_path_factory.mktemp("studio")
    (folder / "texts").mkdir()
    started = Studio(folder / "texts", folder / "kept.sqlite")
    yield started
    started.kill()


def journey(browser: Node, name: str, studio: Studio, file: str) -> dict[str, Any]:
    pictures = os.environ.get("STUDIO_PICTURES", "")
    told: dict[str, Any] = json.loads(browser("studio_page.mjs", name, studio.url, pictures, file))
    assert told["complaints"] == []
    assert told["foreign"] == []
    return told


def test_a_new_author_writes_errs_mends_sees_corrects_saves_and_comes_back(
    browser: Node, studio: Studio
) -> None:
    told = journey(browser, "author", studio, "author.azee")
    assert told["problem"].startswith("3:5 there is no rule `:persone`")
    assert (told["under"], told["problems"]) == (":persone", 0)
    assert told["text"] == told["undone"] == WRITTEN
    assert told["corrected"] == told["reloaded"] != WRITTEN
    assert "place @I_TIP(s)" in told["corrected"]
    assert told["moved_m"] > 0.1
    assert told["chosen"].startswith("INFO · âge")
    assert told["lit"] == ["    :âge"]
    assert (told["speed"], told["first_rule"]) == (0.5, ":tree ['loc ^Mssp]")
    assert told["reasons"] > 5
    assert told["blocks"] == [":info-about", ":personne", ":âge"]
    assert (told["exported"], told["export_begins"]) == ("author.bvh", "HIERARCHY")
    assert told["state"] == "Saved"
    assert (studio.folder / "author.azee").read_text(encoding="utf-8") == told["corrected"]
    assert told["faults"] == []
    for width in (1366, 1024, 390):
        assert told[f"wide_{width}"] == width


def test_the_body_is_posed_and_one_edit_puts_the_hand_where_it_was_dragged(
    browser: Node, studio: Studio
) -> None:
    told = journey(browser, "pose", studio, "pose.azee")
    assert told["moved_m"] > 0.1
    assert told["wrist_m"] > 0.05
    assert told["under_px"] < 2
    assert len(told["answers_ms"]) > 1
    assert len(told["proposals"]) > 2
    assert told["changed"] == f"key 1\n    {told['written']}\n"
    assert told["off_m"] < 0.001
    assert told["undone"]
    assert told["palm"].startswith("orient 'nrm !palm(s) 'along ")
    assert told["face"][0] == "morph 'AU12 .7"
    assert "morph 'index_bend s .5" in told["finger"]
    assert any(written.startswith(":#") for written in told["finger"])
    assert told["gaze"].startswith("look")
    assert told["wide_390"] == 390


def test_everything_is_reached_by_keys_alone(browser: Node, studio: Studio) -> None:
    told = journey(browser, "keys", studio, "keys.azee")
    assert told["parts"] == ["text", "signer", "score", "text", "panel"]
    assert told["toggles"]
    assert told["loops"]
    assert told["block"]
    assert (told["tab"], told["tree"]) == ("tab-blocks", "treeitem")
    assert (told["closed"], told["back"]) == (True, "tab-blocks")
    assert (studio.folder / "keys.azee").read_text() == ":arbre\n"


@pytest.mark.parametrize("victim", ["server", "worker", "browser"])
def test_who_is_killed_takes_no_more_than_a_second_of_typing_along(
    browser: Node, studio: Studio, victim: str
) -> None:
    assert browser.chromium is not None
    with subprocess.Popen(
        [browser.program, "studio_page.mjs", "typing", studio.url, "", f"{victim}.azee"],
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
    told = journey(browser, "text", studio, f"{victim}.azee")
    due = [number for number, at in typed if at < killed_s - LOST_S]
    assert len(due) > 3
    found = told["text"].split("\n")
    assert [f"# {number}" for number in due] == found[: len(due)]
    assert any("not saved" in notice for notice in told["notices"])


def test_an_open_page_goes_to_the_new_address_of_a_server_and_loses_nothing(
    browser: Node, studio: Studio
) -> None:
    assert browser.chromium is not None
    with subprocess.Popen(
        [browser.program, "studio_page.mjs", "moved", studio.url, "", "moved.azee"],
        cwd=NODE_FOLDER, env=os.environ | {"CHROMIUM": browser.chromium}, bufsize=1,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
    ) as page:  # fmt: skip
        assert page.stdin is not None
        assert page.stdout is not None
        assert page.stdout.readline() == "ready\n"
        studio.kill()
        page.stdin.write("killed\n")
        assert page.stdout.readline() == "typed\n"
        studio.start()
        page.stdin.write(f"{studio.url}\n")
        told = json.loads(page.stdout.readline())
    assert told["text"] == "# before\n# after 100 % ✓\n"
    assert told["address"] == f"{studio.url}?file=moved.azee"
    assert told["complaints"] == told["foreign"] == []
    draft = json.loads(studio.ask("api/file?name=moved.azee")[1])["draft"]
    assert draft["text"] == told["text"]


def _worker(server: int) -> int:
    """Return the process id of the worker of a server; it is its only child."""
    for _ in range(600):
        children = Path(f"/proc/{server}/task/{server}/children").read_text().split()
        if children:
            return int(children[0])
        time.sleep(0.1)
    raise AssertionError("the server has no worker")
