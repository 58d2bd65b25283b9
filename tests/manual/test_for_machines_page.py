"""docs/for-machines.md: its examples hold, and its script mends mistakes by the messages alone."""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from pages import ROOT, blocks, page
from programs import Python

from azee.cli.main import run
from azee.lang.program import load
from azee_grammar.fixes import fixes
from azee_grammar.source import Source

BLOCKS = list(blocks((ROOT / "docs" / "for-machines.md").read_text(encoding="utf-8")))
EXAMPLES = [block.text for block in BLOCKS if block.kind == "azee"]
(SCRIPT,) = (block.text for block in BLOCKS if block.options.get("file") == "mend.py")
MISTAKES: Sequence[tuple[str, str]] = (
    (":arbre", ":arbe"),
    ("'topic", "’topic"),
    ("tree()", "tre()"),
    (".nb-5", ".nb5"),
    (":armoire", ":armoir"),
    ("'topic", "'topik"),
    (":with-surprise", ":with-suprise"),
    ("^Rssp", "^Rsp"),
    ("@I_TIP(s)", "@I_TIP"),
    ("@CH", "@CHIN_TIP"),
    ("!palm", "!palmm"),
    ("-.1", "–.1"),
    ("arc(", "ark("),
    ("lookat", "lokat"),
    ("1", "1s"),
    ("blank", "blnk"),
    ('"bonjour"', "“bonjour”"),
    ("3", "３"),
    ("def something at", "def :something at"),
    ("'lsf", "lsf"),
)
"""What stands in each example of the page, and the mistake that is planted there."""


def test_the_page_has_twenty_examples_without_mistakes() -> None:
    assert len(EXAMPLES) == 20
    for text in EXAMPLES:
        program = load(Source("example.azee", text))
        assert program.check() == ()
        assert list(program.utterances)


def _planted(number: int) -> str:
    good, bad = MISTAKES[number]
    assert good in EXAMPLES[number]
    return EXAMPLES[number].replace(good, bad, 1)


def _script(diagnostics: Any = None) -> dict[str, Any]:
    """Return the names of the page's script. diagnostics: in the place of its own function."""
    names: dict[str, Any] = {"__name__": "mend"}
    exec(compile(SCRIPT, "mend.py", "exec"), names)
    names["diagnostics"] = diagnostics or names["diagnostics"]
    return names


@pytest.mark.parametrize("number", range(len(MISTAKES)), ids=[bad for _, bad in MISTAKES])
def test_the_script_mends_a_planted_mistake(
    number: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def diagnostics(path: Path) -> list[Mapping[str, Any]]:
        code = run(["check", "--format", "json", str(path)])
        found: list[Mapping[str, Any]] = json.loads(capsys.readouterr().out)["diagnostics"]
        assert code == (1 if found else 0)
        return found

    path = tmp_path / "draft.azee"
    path.write_text(_planted(number), encoding="utf-8")
    assert diagnostics(path) != []
    assert _script(diagnostics)["mend"](path) == []
    assert path.read_text(encoding="utf-8") == EXAMPLES[number]


@pytest.mark.slow
def test_the_script_runs_the_command(
    tmp_path: Path, python: Python, monkeypatch: pytest.MonkeyPatch
) -> None:
    command = tmp_path / "azee"
    command.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} -m azee "$@"\n')
    command.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    path = tmp_path / "draft.azee"
    path.write_text("".join(_planted(n) + "\n" for n in (0, 16)), encoding="utf-8")
    (tmp_path / "mend.py").write_text(SCRIPT, encoding="utf-8")
    assert python("mend.py", "draft.azee", expect=0).stdout == ""
    mended = "".join(EXAMPLES[n] + "\n" for n in (0, 16))
    assert path.read_text(encoding="utf-8") == mended


def test_the_command_of_the_page_prints_what_stands_there(
    capsys: pytest.CaptureFixture[str],
) -> None:
    (block,) = (block for block in BLOCKS if block.kind == "console")
    command, _, shown = block.text.partition("\n")
    program, *arguments = shlex.split(command.removeprefix("$ "))
    assert program == "azee"
    run(arguments)
    assert capsys.readouterr().out == shown


def test_every_fix_of_the_page_of_errors_mends_its_mistake() -> None:
    tried = 0
    for block in blocks(page("errors.md")):
        if block.kind != "azee":
            continue
        program = load(Source("example.azee", block.text))
        found = program.check()
        for diagnostic in found:
            for fix in fixes(diagnostic):
                assert diagnostic.span is not None
                before = block.text[: diagnostic.span.start]
                text = f"{before}{fix}{block.text[diagnostic.span.end :]}"
                assert len(load(Source("example.azee", text)).check()) < len(found), block
                tried += 1
    assert tried >= 10
