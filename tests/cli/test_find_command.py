"""`azee find` searches texts for a template."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
from formats import schema
from programs import Python

from azee.cli.main import run

AGES = """\
# two ages
:info-about
    'topic :âge
    'info :bien
info-about(:age, :chat)
"""


@pytest.fixture(autouse=True)
def _in_a_folder_with_texts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ages.azee").write_text(AGES, encoding="utf-8")
    Path("one.azee").write_text(":chat\n", encoding="utf-8")


def test_matches_are_printed_with_place_and_bindings(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["find", ":info-about(:âge, ?info)", "one.azee", "ages.azee"]) == 0
    captured = capsys.readouterr()
    assert captured.out == (
        "ages.azee:2:1: :info-about 'topic :âge 'info :bien\n"
        "    ?info = :bien\n"
        "ages.azee:5:1: info-about(:age, :chat)\n"
        "    ?info = :chat\n"
    )
    assert captured.err == "2 found\n"


def test_nothing_found_has_a_code_of_its_own(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["find", "--quiet", ":pays", "ages.azee", "one.azee"]) == 3
    captured = capsys.readouterr()
    assert (captured.out, captured.err) == ("", "")


def test_json_keeps_to_the_documented_schema(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["find", "--format", "json", "info-about(?a, ?b)", "ages.azee"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    document = json.loads(captured.out)
    jsonschema.validate(document, schema("matches"))
    first, second = document["matches"]
    assert first["file"] == "ages.azee"
    assert (first["line"], first["column"], first["end_line"], first["end_column"]) == (2, 1, 4, 16)
    assert second["bindings"]["b"] == {
        "text": ":chat",
        "line": 5,
        "column": 18,
        "end_line": 5,
        "end_column": 23,
    }


def test_a_faulty_file_is_told_and_searched_as_far_as_it_goes(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("faulty.azee").write_text("key (\n:chat\n:f ?x\nuse 'nowhere\n", encoding="utf-8")
    assert run(["find", ":chat", "faulty.azee", "missing.azee", "one.azee"]) == 1
    captured = capsys.readouterr()
    assert captured.out == "faulty.azee:2:1: :chat\none.azee:1:1: :chat\n"
    for code in ("unclosed-paren", "template-hole", "library-not-found", "cannot-read"):
        assert f"error[{code}]" in captured.err


@pytest.mark.parametrize(
    ("template", "code"),
    [("info-about(?a", "unclosed-paren"), ("info-about(?a)", "missing-argument")],
)
def test_a_faulty_template_is_told_once(
    template: str, code: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["find", "--quiet", template, "ages.azee", "one.azee"]) == 1
    told = capsys.readouterr().err
    assert told.count("error[") == 1
    assert f"error[{code}]" in told
    assert "<template>:1:" in told


def test_rules_of_a_library_are_known(capsys: pytest.CaptureFixture[str]) -> None:
    Path("rules").mkdir()
    Path("rules/mine.azee").write_text("def katze\n    :chat\n", encoding="utf-8")
    Path("used.azee").write_text("use 'mine\nuse 'lsf\n:katze\n", encoding="utf-8")
    assert run(["find", "--quiet", ":chat", "used.azee", "--library", "rules"]) == 0
    assert capsys.readouterr().out == "used.azee:3:1: :katze\n"
    assert run(["find", "--quiet", ":chat", "used.azee"]) == 1


@pytest.mark.long
def test_standard_input_is_searched(python: Python) -> None:
    done = python("-m", "azee", "find", "--quiet", "chat()", "-", stdin=":chat\n", expect=0)
    assert done.stdout == "<stdin>:1:1: :chat\n"


def test_counts_are_told_by_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["find", "--count", "info-about(?a, ?b)", "one.azee", "ages.azee"]) == 0
    captured = capsys.readouterr()
    assert captured.out == "0\tone.azee\n2\tages.azee\n"
    assert captured.err == "2 found\n"
    assert run(["find", "--count", ":pays", "one.azee"]) == 3
    capsys.readouterr()
    assert run(["find", "--count", "--format", "json", ":chat", "one.azee", "ages.azee"]) == 0
    document = json.loads(capsys.readouterr().out)
    jsonschema.validate(document, schema("matches"))
    assert document == {"diagnostics": [], "counts": {"one.azee": 1, "ages.azee": 1}}
