"""`azee manifest` writes and verifies, `azee rules --diff` compares, `check --trust` counts."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
from formats import schema

from azee.cli.main import run

TEA = 'def tea\n    \'meaning "tea"\n    \'status "placeholder"\n    blank 1\n'
SAID = ("--version=1.0", "--licence=CC0-1.0", "--language=fsl", "--citation=Tea")


@pytest.fixture(autouse=True)
def _in_a_folder_with_a_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("tea").mkdir()
    Path("tea/tea.azee").write_text(TEA, encoding="utf-8")


def test_a_new_manifest_needs_what_only_people_can_say(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["manifest", "tea", "--version", "1.0"]) == 2
    assert "give --licence, --language, --citation too" in capsys.readouterr().err
    assert not Path("tea/library.json").exists()


def test_what_was_said_stays_until_it_is_said_anew() -> None:
    assert run(["manifest", "tea", *SAID]) == 0
    first = json.loads(Path("tea/library.json").read_text(encoding="utf-8"))
    jsonschema.validate(first, schema("manifest"))
    assert run(["manifest", "tea", "--version", "1.1"]) == 0
    second = json.loads(Path("tea/library.json").read_text(encoding="utf-8"))
    assert second == {**first, "version": "1.1"}


def test_a_rule_that_changes_makes_the_manifest_stale(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["manifest", "--quiet", "tea", *SAID]) == 0
    assert run(["manifest", "--check", "tea"]) == 0
    Path("tea/tea.azee").write_text(TEA.replace("blank 1", "blank 2"), encoding="utf-8")
    capsys.readouterr()
    assert run(["manifest", "--check", "tea"]) == 1
    assert "error[stale-manifest]: `tea/library.json` is not current: `tea`" in (
        capsys.readouterr().err.replace("\\", "/")
    )
    assert run(["manifest", "--quiet", "tea"]) == 0
    assert run(["manifest", "--check", "tea"]) == 0


def test_a_manifest_of_another_library_is_stale(capsys: pytest.CaptureFixture[str]) -> None:
    run(["manifest", "--quiet", "tea", *SAID])
    Path("tea").rename("coffee")
    capsys.readouterr()
    assert run(["manifest", "--check", "coffee"]) == 1
    assert "names another library: `tea`" in capsys.readouterr().err


def test_a_library_with_mistakes_gets_no_manifest(capsys: pytest.CaptureFixture[str]) -> None:
    Path("tea/tea.azee").write_text("def tea\n    blanc 1\n", encoding="utf-8")
    assert run(["manifest", "tea", *SAID]) == 1
    assert "error[unknown-operator]" in capsys.readouterr().err
    assert not Path("tea/library.json").exists()
    assert run(["manifest", "--check", "tea", *SAID]) == 2


def test_differences_are_printed_as_json_too(capsys: pytest.CaptureFixture[str]) -> None:
    run(["manifest", "--quiet", "tea", *SAID])
    Path("tea/library.json").rename("kept.json")
    Path("tea/tea.azee").write_text(TEA.replace("placeholder", "published"), encoding="utf-8")
    capsys.readouterr()
    assert run(["rules", "--diff", "kept.json", "tea", "--format", "json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["before"]["name"], found["before"]["version"]) == ("tea", "1.0")
    (change,) = found["changes"]
    assert (change["name"], change["kind"]) == ("tea", "status")
    assert change["before"]["status"] == "placeholder"
    assert change["after"]["status"] == "published"
    assert run(["rules", "--diff", "tea", "tea"]) == 0
    assert capsys.readouterr().out == "tea → tea: no rule differs\n"
    assert run(["rules", "tea", "--diff", "tea", "tea"]) == 2


def test_trust_counts_all_texts_together_also_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.azee").write_text("use 'tea\n:tea\n", encoding="utf-8")
    Path("b.azee").write_text("info-about(:arbre, :arbre)\n", encoding="utf-8")
    assert run(["check", "--trust", "--quiet", "a.azee", "b.azee"]) == 0
    assert capsys.readouterr().out.startswith(
        "4 applications: 2 published, 1 read-off, 1 placeholder\n  published: arbre\n"
    )
    assert (
        run(["check", "--trust", "--format", "json", "b.azee", "-e", "seq(list(:tea, :chat))"]) == 1
    )
    capsys.readouterr()
    assert (
        run(["check", "--trust", "--format", "json", "b.azee", "-e", "seq(list(:chat, :bien))"])
        == 0
    )
    found = json.loads(capsys.readouterr().out)["provenance"]
    assert found["rules"] == {"inferred": ["bien", "chat"]}
    names = found.pop("rules")
    assert names
    jsonschema.validate(found, schema("report")["properties"]["provenance"])
