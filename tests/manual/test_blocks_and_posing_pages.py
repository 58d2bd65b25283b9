"""docs/blocks.md and docs/posing.md: their commands print what they show, their code runs."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest
from pages import ROOT, Block, blocks

from azee.cli.main import run


def _blocks(name: str) -> list[Block]:
    return list(blocks((ROOT / "docs" / name).read_text(encoding="utf-8")))


PAGES = ["blocks.md", pytest.param("posing.md", marks=pytest.mark.slow)]


@pytest.mark.parametrize("page", PAGES)
def test_every_command_prints_what_the_page_shows(
    page: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for block in _blocks(page):
        if name := block.options.get("file"):
            Path(name).write_text(block.text, encoding="utf-8")
        if block.kind != "console":
            continue
        command, _, shown = block.text.partition("\n")
        program, *arguments = shlex.split(command.removeprefix("$ "))
        assert program == "azee"
        assert run(arguments) == int(block.options.get("exit", "0")), command
        captured = capsys.readouterr()
        assert (captured.out + captured.err).rstrip("\n") == shown.rstrip("\n"), block


@pytest.mark.parametrize("page", PAGES)
def test_the_code_of_the_page_runs(page: str) -> None:
    (code,) = [block for block in _blocks(page) if block.kind == "python"]
    exec(compile(code.text, page, "exec"), {})


def test_the_pages_list_all_edits_and_kinds() -> None:
    from typing import get_args

    from azee.blocks.edits import Edit, edit_as_json

    text = (ROOT / "docs" / "blocks.md").read_text(encoding="utf-8")
    for kind in get_args(Edit):
        made = kind(*[()] * len(kind.__dataclass_fields__))
        assert f"| `{edit_as_json(made)['edit']}` |" in text
