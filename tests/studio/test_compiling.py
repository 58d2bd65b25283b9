"""Answers come in the order in which a page can show them."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from azee.studio.compiling import LONGEST_S, SupersededError, compiled, evaluated, still
from azee.studio.job import Job
from azee.studio.postures import Postures
from azee.studio.score_rows import score_rows

SENTENCE = ":info-about\n    'topic\n    :personne\n    'info\n    :âge\n"
KEY = "key 1\n    cstr\n        place @I_TIP(s) @CH\n        orient 'nrm !palm(s) 'along ^up\n"


def quick(text: str, expression: str | None = None) -> Job:
    """Return a job that takes little time."""
    return Job(1, "a.azee", text, expression, life=False, fps=10.0)


def nothing() -> None:
    """Nobody has anything newer."""


def test_rows_know_their_parents_times_and_places(tmp_path: Path) -> None:
    _, score, _ = evaluated(Job(1, "a.azee", f"# A text\n{SENTENCE}"), tmp_path, [])
    assert score is not None
    rows = score_rows(score, str(tmp_path / "a.azee"))
    assert (rows[0]["rule"], rows[0]["parent"], rows[0]["place"]) == ("info-about", -1, (2, 1))
    assert rows[0]["end_s"] == float(score.duration)
    named = {row["rule"]: row for row in rows}
    assert named["personne"]["place"] == (4, 5)
    assert named["âge"]["place"] == (6, 5)
    assert named["âge-once"]["place"] is None
    for row in rows[1:]:
        outer = rows[row["parent"]]
        assert row["path"][:-1] == outer["path"]
        assert outer["start_s"] <= row["start_s"] <= row["end_s"] <= outer["end_s"]


def test_mistakes_come_at_once_and_nothing_after_them(tmp_path: Path) -> None:
    answers = list(compiled(Job(4, "a.azee", ":abre\n"), tmp_path, [], nothing, Postures()))
    assert [header["kind"] for header, _ in answers] == ["score"]
    header = answers[0][0]
    assert (header["number"], header["blocks"]) == (4, [])
    assert [d["code"] for d in header["diagnostics"]] == ["unknown-rule"]
    assert (header["diagnostics"][0]["line"], header["diagnostics"][0]["column"]) == (1, 1)


def test_a_text_that_signs_too_long_is_told_so(tmp_path: Path) -> None:
    text = f"key {LONGEST_S + 1}\n    place @I_TIP(s) @CH\n"
    found, score, _ = evaluated(Job(1, "a.azee", text), tmp_path, [])
    assert score is None
    assert [d.code for d in found] == ["clip-times"]


def test_a_newer_text_stops_the_work_between_postures(tmp_path: Path) -> None:
    calls = 0

    def check() -> None:
        nonlocal calls
        calls += 1
        if calls == 2:
            raise SupersededError

    answers = compiled(quick(KEY), tmp_path, [], check, Postures())
    assert next(answers)[0]["kind"] == "score"
    with pytest.raises(SupersededError):
        next(answers)


@pytest.mark.slow
def test_a_key_comes_as_score_clip_and_report_with_marks(tmp_path: Path) -> None:
    job = quick(KEY)
    answers = {
        header["kind"]: (header, data)
        for header, data in compiled(job, tmp_path, [], nothing, Postures())
    }
    assert list(answers) == ["score", "clip", "report"]
    clip, data = answers["clip"]
    assert data.startswith(b"AZWC")
    assert clip["lead_s"] > 0
    report = answers["report"][0]
    assert {row["outcome"] for row in report["constraints"]} <= {"met", "eased"}
    place, orient = report["marks"]
    assert place["text"].startswith("place")
    for mark in place["marks"][1:]:
        assert "base" not in mark
        assert np.linalg.norm(np.subtract(mark["at"], mark["goal"])) < 0.011
    for mark in orient["marks"]:
        up = np.subtract(mark["goal"], mark["base"])
        np.testing.assert_allclose(up / np.linalg.norm(up), [0, 1, 0], atol=1e-3)
        assert abs(np.linalg.norm(np.subtract(mark["at"], mark["base"])) - 0.14) < 1e-3


@pytest.mark.slow
def test_postures_that_are_remembered_give_the_same_movement(tmp_path: Path) -> None:
    known = Postures()
    texts = (SENTENCE, SENTENCE.replace("personne", "arbre"), SENTENCE)
    made = [
        next(data for header, data in compiled(quick(text), tmp_path, [],
                                               nothing, known) if header["kind"] == "clip")
        for text in texts
    ]  # fmt: skip
    assert made[0] == made[2] != made[1]


@pytest.mark.slow
def test_a_rule_has_a_picture(tmp_path: Path) -> None:
    job = quick("", ":arbre")
    image = Image.open(io.BytesIO(still(job, tmp_path, [], (84, 105), nothing, Postures())))
    assert image.size == (84, 105)
    assert np.ptp(np.asarray(image)) > 100
