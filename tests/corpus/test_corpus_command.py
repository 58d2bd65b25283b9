"""`azee corpus stats`: folders, files, formats, mistakes."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from xml.etree import ElementTree

import jsonschema
import pytest
from formats import schema
from PIL import Image

from azee.cli.main import run


@pytest.fixture(autouse=True)
def _in_a_folder_with_texts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("texts/deep").mkdir(parents=True)
    Path("texts/a.azee").write_text("info-about(:chat, :lake)\n", encoding="utf-8")
    Path("texts/deep/b.az").write_text(":chat\n", encoding="utf-8")
    Path("texts/readme.txt").write_text("none", encoding="utf-8")


def test_a_folder_is_searched_with_all_in_it_and_no_text_counts_twice(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["corpus", "stats", "texts", "texts/a.azee", "--most", "1"]) == 0
    captured = capsys.readouterr()
    assert captured.out.splitlines()[1].split()[:3] == ["1", "chat", "lsf"]
    assert captured.out.splitlines()[1].split()[4:6] == ["yes", "2"]
    assert captured.out.splitlines()[2] == "… and 2 more"
    assert captured.err.startswith("2 texts, 2 utterances, 4 applications of 3 rules\n")


def test_json_keeps_to_the_documented_schema() -> None:
    assert run(["corpus", "stats", "texts", "-o", "all.json", "-o", "unknown.csv"]) == 0
    found = json.loads(Path("all.json").read_text(encoding="utf-8"))
    jsonschema.validate(found, schema("corpus"))
    assert (found["texts"], found["known"], found["applications"]) == (2, 3, 4)


def test_csv_has_the_table_that_is_asked_for() -> None:
    assert run(["corpus", "stats", "texts", "--table", "unknown", "-o", "u.csv", "--quiet"]) == 0
    lines = Path("u.csv").read_text(encoding="utf-8").splitlines()
    assert [line.split(",")[1] for line in lines] == ["rule", "lake"]


@pytest.mark.long
def test_charts_are_pictures_and_the_same_every_time() -> None:
    outputs = [word for name in ("a.svg", "b.svg", "c.png", "d.pdf") for word in ("-o", name)]
    assert run(["corpus", "stats", "texts", *outputs]) == 0
    assert Path("a.svg").read_bytes() == Path("b.svg").read_bytes()
    words = {text for e in ElementTree.parse("a.svg").iter() if (text := (e.text or "").strip())}
    assert {"chat", "lake", "info-about", "unknown rule"} <= words
    assert {"2", "1", "occurrences", "3 rules in 4 applications"} <= words
    with Image.open("c.png") as picture:
        assert picture.width > 600
        colours = {c for _, c in picture.convert("RGB").getcolors(1 << 20) or []}
    assert (181, 72, 58) in colours  # that of unknown rules
    assert Path("d.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.long
def test_a_chart_has_no_more_bars_than_can_be_read() -> None:
    Path("texts/a.azee").write_text("".join(f":rule-{i}\n" for i in range(70)), encoding="utf-8")
    assert run(["corpus", "stats", "texts", "-o", "a.svg", "--quiet"]) == 0
    words = [(e.text or "").strip() for e in ElementTree.parse("a.svg").iter()]
    assert sum(word.startswith("rule-") for word in words) == 59  # and chat
    assert "60 of 71 rules in 71 applications" in words


def test_a_chart_of_nothing_can_be_drawn() -> None:
    Path("texts/a.azee").write_text("", encoding="utf-8")
    Path("texts/deep/b.az").write_text("", encoding="utf-8")
    assert run(["corpus", "stats", "texts", "-o", "a.svg"]) == 0


def test_without_the_library_for_charts_the_remedy_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert run(["corpus", "stats", "texts", "-o", "a.svg"]) == 1
    assert "install it with: pip install 'azee[charts]'" in capsys.readouterr().err


def test_mistakes_are_told_and_the_rest_is_counted(capsys: pytest.CaptureFixture[str]) -> None:
    Path("texts/c.azee").write_text(":bien\n:chat (\n", encoding="utf-8")
    assert run(["corpus", "stats", "texts", "--quiet"]) == 1
    captured = capsys.readouterr()
    assert "error[" in captured.err
    assert "bien" in captured.out
    Path("none").mkdir()
    assert run(["corpus", "stats", "none"]) == 1
    assert "no text is in the folder `none`" in capsys.readouterr().err
    assert run(["corpus", "stats", "texts", "-o", "a.xml"]) == 2
