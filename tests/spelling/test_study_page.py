"""The pages of a study in a browser that is not ours, with a server that is killed half-way."""

from __future__ import annotations

import json
import os
import random
import threading
import time
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
from programs import Node
from study_server import Server

from azee.cli.main import run
from azee.spelling.study.answers import Answers
from azee.spelling.study.design import comparisons
from azee.spelling.study.questions import AGES, FLUENCIES, Choice
from azee.spelling.timing.published import STUDIED

STRENGTHS = {"variable": 3.0, "motion": 2.0, "normalised": 1.0, "constant": -1.0}
"""Logits of planted preferences."""
REMARKS = ["speed & rhythm", "GUITAR", "<b>slower ones</b>", "", "ü"]


def _film(path: Path, shade: int) -> None:
    """Write a film of half a second that any browser plays."""
    with av.open(str(path), "w") as file:
        stream = file.add_stream("libvpx-vp9", rate=10)
        stream.width, stream.height, stream.pix_fmt = 64, 48, "yuv420p"
        stream.time_base = Fraction(1, 10)
        for i in range(5):
            picture = np.full((48, 64, 3), shade, dtype=np.uint8)
            picture[:, 10 * i : 10 * i + 10] = 255
            file.mux(stream.encode(av.VideoFrame.from_ndarray(picture, "rgb24")))
        file.mux(stream.encode(None))


def _kill_half_way(server: Server, answers: Path, pages: list[int], done: threading.Event) -> None:
    """Kill the server as soon as so many choices are kept, and start it again."""
    while pages and not done.is_set():
        kept = 0
        if answers.exists():
            found = Answers.open(answers)
            kept = sum(len(found.choices(person)) for person in found.participants())
        if kept >= pages[0]:
            pages.pop(0)
            server.kill()
            time.sleep(0.3)
            server.start()
        time.sleep(0.02)


@pytest.mark.slow
def test_a_study_is_filled_in_killed_half_way_resumed_and_analysed(
    browser: Node, tmp_path: Path
) -> None:
    folder = tmp_path / "study"
    folder.mkdir()
    for number, word in enumerate(STUDIED):
        for shade, kind in enumerate(STRENGTHS):
            _film(folder / f"{word}-{kind}.webm", 20 + 25 * shade + number)
    _film(folder / "sample.webm", 200)
    assert run(["study", "manifest", str(folder), "--seed", "7"]) == 0

    server = Server(folder)
    answers_file = folder / "answers.sqlite"
    chosen = random.Random(3)
    design = Answers.open(answers_file).design
    planted: dict[int, list[Choice]] = {
        number: [
            "first"
            if chosen.random() < 1 / (1 + np.exp(STRENGTHS[p.second] - STRENGTHS[p.first]))
            else "second"
            for p in comparisons(design, number)
        ]
        for number in (1, 2, 3)
    }
    (tmp_path / "choices.json").write_text(
        json.dumps({"choices": planted[1], "remarks": REMARKS}), encoding="utf-8"
    )
    done = threading.Event()
    killer = threading.Thread(target=_kill_half_way, args=(server, answers_file, [20, 31], done))
    killer.start()
    try:
        pictures = os.environ.get("STUDY_PICTURES", "")
        told = json.loads(
            browser("study_page.mjs", server.url, tmp_path / "choices.json", pictures)
        )
    finally:
        done.set()
        killer.join()
    assert (told["unplayed"], told["foreign"], told["complaints"]) == ([], [], [])
    assert told["restarts"] > 0
    assert len(told["acknowledged"]) >= 44
    kept = Answers.open(answers_file)
    (person,) = kept.participants()
    choices = kept.choices(person)
    assert {page: choices[int(page)] for page in told["acknowledged"]} == told["acknowledged"]
    assert [choices[page] for page in range(1, 49)] == planted[1]
    assert person.finished
    server.kill()
    for number in (2, 3):  # who comes later does so without a browser
        person = kept.begin(f"key-{number}", AGES[0], FLUENCIES[0], "", "")
        for at, choice in enumerate(planted[number], 1):
            kept.choose(person, at, choice)
        kept.finish(person, REMARKS)

    assert run(["study", "analyse", str(answers_file), "-o", str(tmp_path / "out")]) == 0
    found = json.loads((tmp_path / "out" / "analysis.json").read_text())
    assert (found["participants"], found["finished"], found["choices"]) == (3, 3, 144)
    logits = found["bradley_terry"]["logits"]
    assert sorted(logits, key=logits.get, reverse=True) == list(STRENGTHS)
    for kind, error in found["bradley_terry"]["standard_errors"].items():
        apart = (logits[kind] - logits["variable"]) - (STRENGTHS[kind] - STRENGTHS["variable"])
        assert abs(apart) < 4 * max(error, 0.3)
    assert found["bradley_terry"]["p_all_equal"] < 1e-6
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "&lt;b&gt;slower ones&lt;/b&gt;" in page
    assert "25 participants" in page
