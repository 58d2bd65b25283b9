"""`azee check` tells what is wrong, for people and for programs."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
from formats import schema

from azee.cli.main import run

FINE = "key 1 (look ^fwd)\n"
FAULTY = "# a comment\nkey 1\n    cstr\n        place @CHIN_TIP ^Mssp\n        place @CH ^Nssp\n"


@pytest.fixture(autouse=True)
def _in_a_folder_with_texts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("fine.azee").write_text(FINE, encoding="utf-8")
    Path("faulty.azee").write_text(FAULTY, encoding="utf-8")


def test_all_files_are_checked_and_counted(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["check", "fine.azee", "faulty.azee", "missing.azee"]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("error[") == 3
    assert captured.err.endswith("3 files: 3 errors\n")


def test_no_faults(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["check", "fine.azee"]) == 0
    assert capsys.readouterr().err == "1 file: no errors\n"
    assert run(["check", "--quiet", "fine.azee"]) == 0
    assert capsys.readouterr().err == ""


def test_json_keeps_to_the_documented_schema(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["check", "--format", "json", "faulty.azee", "missing.azee"]) == 1
    captured = capsys.readouterr()
    assert captured.err == ""
    document = json.loads(captured.out)
    jsonschema.validate(document, schema("diagnostics"))
    first, second, third = document["diagnostics"]
    assert first["code"] == "unknown-site"
    assert (first["line"], first["column"], first["end_line"], first["end_column"]) == (
        4,
        15,
        4,
        24,
    )
    assert second["code"] == "unknown-name"
    assert (third["code"], third["line"]) == ("cannot-read", None)


def test_json_without_faults(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["check", "--format", "json", "fine.azee"]) == 0
    assert json.loads(capsys.readouterr().out) == {"diagnostics": []}


def test_an_expression_is_checked(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["check", "-e", ":bonjour"]) == 0
    assert capsys.readouterr().err == "1 expression: no errors\n"
    assert run(["check", "-e", "key 1 (place @CHIN_TIP ^Mssp)"]) == 1
    told = capsys.readouterr().err
    assert "error[unknown-site]: AZee has no site `@CHIN_TIP`\n --> <expression>:1:14\n" in told
    assert told.endswith("1 expression: 1 error\n")
    assert run(["check", "-e", "^up"]) == 1
    assert "error[not-a-score]" in capsys.readouterr().err


def test_an_expression_sees_the_rules_of_a_file(capsys: pytest.CaptureFixture[str]) -> None:
    Path("rules.azee").write_text("def here\n    key 1 (look ^fwd)\n", encoding="utf-8")
    assert run(["check", "rules.azee", "-e", ":here"]) == 0
    assert capsys.readouterr().err == "1 file and 1 expression: no errors\n"
    assert run(["check", "--format", "json", "rules.azee", "-e", ":there"]) == 1
    (problem,) = json.loads(capsys.readouterr().out)["diagnostics"]
    assert (problem["code"], problem["file"]) == ("unknown-rule", "<expression>")
    assert run(["check", "faulty.azee", "-e", ":bonjour"]) == 1
    assert capsys.readouterr().err.count("error[") == 2


@pytest.mark.parametrize(
    ("text", "word", "remedy"),
    [
        ("def tea", "def", "`:tea`"),
        ("def tea\n    :bien\n:tea", "def", "`:tea`"),
        ("use 'lsf\n:bien", "use", "`use 'lsf`"),
        ("use lsf", "use", "`use 'lsf`"),
        ("use", "use", "`use 'lsf`"),
    ],
)
def test_a_definition_is_no_expression(
    text: str, word: str, remedy: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["check", "-e", text]) == 1
    told = capsys.readouterr().err
    assert told.startswith(f"error[syntax]: `{word}` is no expression")
    assert told.count("error[") == 1
    assert remedy in told
    assert "give the file" in told


def test_an_expression_goes_with_one_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["check", "fine.azee", "faulty.azee", "-e", ":bonjour"]) == 2
    assert "-e sees the rules of one FILE" in capsys.readouterr().err
    assert run(["check"]) == 2
    assert "name a FILE (`-` is standard input) or give an expression" in capsys.readouterr().err


def test_a_text_is_bound_to_a_body_when_asked(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from dataclasses import replace

    from azee_rig.load import load_rig

    Path("touch.azee").write_text("key 1 (place @I_TIP(s) @CH)\n", encoding="utf-8")
    assert run(["check", "--quiet", "--rig", "signer", "touch.azee"]) == 0
    rig = load_rig()
    chinless = replace(rig, sites={k: v for k, v in rig.sites.items() if k != "CH"})
    monkeypatch.setattr("azee_rig.load.load_rig", lambda _: chinless)
    strict = ["check", "--quiet", "--strict-body", "--rig", "signer"]
    assert run([*strict, "touch.azee"]) == 1
    told = capsys.readouterr().err
    assert "error[rig-lacks-site]: the rig `signer` has no site `@CH`" in told
    assert "note: written at touch.azee:1:8" in told
    assert run([*strict, "-e", "key 1 (place @I_TIP(s) @CH)"]) == 1
    assert "error[rig-lacks-site]" in capsys.readouterr().err
    assert run(["check", "--rig", "signer", "touch.azee"]) == 0
    told = capsys.readouterr().err
    lacking = "warning[rig-lacks-site]: the rig `signer` has no site `@CH`"
    assert f"{lacking}; 1 constraint with it left out" in told


def test_colours_only_where_somebody_looks(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    run(["check", "faulty.azee"])
    assert "\x1b[" not in capsys.readouterr().err
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    run(["check", "faulty.azee"])
    assert "\x1b[" in capsys.readouterr().err
    monkeypatch.setenv("NO_COLOR", "1")
    run(["check", "faulty.azee"])
    assert "\x1b[" not in capsys.readouterr().err


def test_an_expression_is_warned_of_what_no_body_shows(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["check", "-e", "key 1 (morph 'AU12 5)"]) == 0
    told = capsys.readouterr().err
    assert "warning[beyond-body]: no face shows `'AU12` with weight 5" in told
    assert told.endswith("1 expression: 1 warning\n")
