"""`azee spell TEXT`, as a user types it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from azee.cli.main import run


@pytest.mark.long
def test_a_word_becomes_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = tmp_path / "cab.json"
    clip = tmp_path / "cab.npz"
    assert run(["spell", "CAB", "-o", str(clip), "--report", str(report)]) == 0
    assert clip.exists()
    told = json.loads(report.read_text(encoding="utf-8"))
    assert {row["outcome"] for row in told["constraints"]} <= {"met", "eased"}
    assert "wrote" in capsys.readouterr().err


def test_the_expression_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["spell", "a", "--timing", "constant", "--speed", "2", "--show"]) == 0
    assert capsys.readouterr().out == (
        ":fingerspelling('text = \"a\", 'language = 'asl, 'times = list(list(0.4000, 0.0000)))\n"
    )


def test_a_word_that_is_a_subcommand_is_spelled_by_the_long_form(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["spell", "word", "fit", "--show"]) == 0
    assert 'text = "fit"' in capsys.readouterr().out
    assert run(["spell", "--language", "lsf", "fit", "--show"]) == 0
    assert "'language = 'lsf" in capsys.readouterr().out


def test_what_is_left_out_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["spell", "what?", "--show"]) == 0
    assert "the manual alphabet of ASL has no `?`; it is left out" in capsys.readouterr().err
    assert run(["spell", "what?", "--show", "--strict"]) == 3
    assert run(["spell", "??", "--show"]) == 1
    assert "nothing that the manual alphabet of ASL spells" in capsys.readouterr().err
