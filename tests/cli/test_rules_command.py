"""`azee rules` tells what ships."""

from __future__ import annotations

import json
import os
from pathlib import Path

import jsonschema
import pytest
from formats import schema

from azee.cli.main import run
from azee.compilation import score_of
from azee.lang.library import shipped_library
from azee.lang.program import load
from azee.lang.rule import STATUSES, Rule
from azee.lang.rule_example import example_of, example_text
from azee_grammar.library import shipped_names
from azee_grammar.source import Source

SHIPPED = [
    rule for name in shipped_names() for rule in shipped_library(name).namespace.rules.values()
]


def test_the_list_has_every_rule_with_its_meaning(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["rules"]) == 0
    lines = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert len(SHIPPED) > 20
    for rule in SHIPPED:
        assert f"{rule.name} {' '.join((rule.entry('meaning') or '').split())}" in lines


@pytest.mark.parametrize("rule", SHIPPED, ids=lambda rule: rule.name)
def test_a_rule_tells_its_meaning_source_and_arguments(
    rule: Rule, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["rules", rule.name]) == 0
    words = " ".join(capsys.readouterr().out.split())
    for entry in ("meaning", "source", "status"):
        text = rule.entry(entry)
        assert text, f"{rule.name} has no {entry}"
        assert " ".join(text.split()) in words
    for parameter, mandatory in rule.parameters:
        assert f"'{parameter} {'mandatory' if mandatory else 'by default'}" in words


@pytest.mark.parametrize("rule", SHIPPED, ids=lambda rule: rule.name)
def test_the_example_of_a_rule_can_be_evaluated(
    rule: Rule, capsys: pytest.CaptureFixture[str]
) -> None:
    run(["rules", rule.name])
    shown = capsys.readouterr().out
    own = shown[shown.index(f"\n  library   {rule.library}\n") :]
    printed = own[own.index("\n  example   ") :].partition("\n\n")[0].split()[1:]
    assert " ".join(printed) == " ".join(example_of(rule).split())
    text = Source(rule.name, example_text(rule))
    assert score_of(load(text), None, None).duration >= 0


def test_the_colon_may_be_written(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["rules", ":info-about"]) == 0
    assert capsys.readouterr().out.startswith(":info-about\n  library   core\n")


def test_an_unknown_rule_gets_the_nearest(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["rules", "info-abuot"]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error[unknown-rule]: there is no rule `info-abuot`\n")
    assert "info-about" in captured.err


def test_a_search_finds_by_meaning_without_accents(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["rules", "--search", "CINEMA"]) == 0
    names = [line.split()[0] for line in capsys.readouterr().out.splitlines()[1:]]
    assert names == ["cinema", "cinéma"]
    assert run(["rules", "--search", "sondern"]) == 0
    assert "nicht-sondern" in capsys.readouterr().out


def test_a_search_in_vain_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["rules", "--search", "zeppelin"]) == 1
    assert capsys.readouterr().err == "error[unknown-rule]: no rule speaks of `zeppelin`\n\n"


@pytest.mark.parametrize("status", STATUSES)
def test_a_status_lists_its_rules(status: str, capsys: pytest.CaptureFixture[str]) -> None:
    wanted = {rule.name for rule in SHIPPED if rule.entry("status") == status}
    assert run(["rules", "--status", status, "--format", "json"]) == (0 if wanted else 1)
    listed = json.loads(capsys.readouterr().out)["rules"]
    assert {rule["name"] for rule in listed} == wanted
    assert {rule["status"] for rule in listed} <= {status}


def test_a_status_that_does_not_exist_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["rules", "--status", "guessed"]) == 2
    assert "`guessed` is no status; there are published," in capsys.readouterr().err
    assert run(["rules", "--status", "judged", "--search", "chat"]) == 1
    assert "no rule speaks of `chat` and has the status judged" in capsys.readouterr().err


def test_a_folder_adds_its_libraries(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mine").mkdir()
    text = 'def tea\n    \'meaning "a hot drink"\n    :bien\n'
    (tmp_path / "mine" / "drinks.azee").write_text(text, encoding="utf-8")
    (tmp_path / "notes.txt").write_text("no library", encoding="utf-8")
    assert run(["rules", "--library", str(tmp_path)]) == 0
    assert "mine\n  tea  a hot drink\n" in capsys.readouterr().out
    assert run(["rules", "tea", "--library", str(tmp_path)]) == 0
    assert "a hot drink" in capsys.readouterr().out
    (tmp_path / "mine" / "drinks.azee").write_text("def tea\n    :bein\n", encoding="utf-8")
    assert run(["rules", "--library", str(tmp_path)]) == 1
    assert "unknown-rule" in capsys.readouterr().err


def test_a_broken_library_does_not_hide_the_others(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    texts = {"bad/b.azee": "def (\n", "good/g.azee": "def fine\n    :bien\n"}
    texts |= {"half/h.azee": "def right\n    :bien\ndef wrong\n    :bein\n"}
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text(text, encoding="utf-8")
    os.mkfifo(tmp_path / "good" / "pipe.azee")
    os.mkfifo(tmp_path / "pipe.azee")
    (tmp_path / "out.azee").symlink_to("/etc/hosts")
    assert run(["rules", "--library", str(tmp_path)]) == 1
    captured = capsys.readouterr()
    assert "good\n  fine\n" in captured.out
    assert "half\n  right" in captured.out
    assert "info-about" in captured.out
    for absent in ("wrong", "out", "pipe"):
        assert f"\n  {absent}" not in captured.out
        assert f"\n{absent}\n" not in captured.out
    assert captured.err.count("error[") == 3
    for code in ("syntax", "unknown-rule", "cannot-read"):
        assert f"error[{code}]" in captured.err
    assert run(["rules", "fine", "--library", str(tmp_path)]) == 1
    assert capsys.readouterr().out.startswith(":fine\n")
    assert run(["rules", "--format", "json", "--library", str(tmp_path)]) == 1
    told = json.loads(capsys.readouterr().out)
    assert len(told["diagnostics"]) == 3
    assert {"fine", "right"} <= {rule["name"] for rule in told["rules"]}


def test_rules_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["rules", "--format", "json"]) == 0
    told = json.loads(capsys.readouterr().out)
    jsonschema.validate(told, schema("rules"))
    assert told["diagnostics"] == []
    assert {rule["name"] for rule in told["rules"]} == {rule.name for rule in SHIPPED}
    assert run(["rules", "info-about", "--format", "json"]) == 0
    (rule,) = json.loads(capsys.readouterr().out)["rules"]
    assert rule["library"] == "core"
    assert rule["arguments"][0] == {"name": "topic", "mandatory": True, "default": None}
    assert run(["rules", "no-such-rule", "--format", "json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert told["rules"] == []
    assert [d["code"] for d in told["diagnostics"]] == ["unknown-rule"]
