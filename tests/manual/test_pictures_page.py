"""docs/pictures-and-films.md: its commands, in order, write what the page says they do."""

from __future__ import annotations

import shlex
from itertools import pairwise
from pathlib import Path

import pytest
from pages import ROOT, blocks
from PIL import Image

from azee.cli.main import run

PAGE = (ROOT / "docs" / "pictures-and-films.md").read_text(encoding="utf-8")
BLOCKS = list(blocks(PAGE))
SMALL = {"render": ["--size", "96x96", "--fps", "3"]}
"""What makes a command quick; the last word counts."""


@pytest.mark.slow
def test_the_commands_of_the_page_in_order(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    done = 0
    for block in BLOCKS:
        if block.kind == "python":
            exec(compile(block.text, "page", "exec"), {})
            assert Path("both.glb").stat().st_size > 1e6
            continue
        assert block.kind == "sh"
        for line in block.text.splitlines():
            program, *arguments = shlex.split(line)
            assert program == "azee"
            assert run([*arguments, *SMALL.get(arguments[0], [])]) == 0, line
            capsys.readouterr()
            done += 1
            for option, value in pairwise(arguments):
                assert option != "-o" or Path(value).stat().st_size > 400, line
    assert done >= 15
    with Image.open("three.png") as three, Image.open("cut-out.png") as clear:
        assert three.width == 3 * 96
        assert clear.mode == "RGBA"


def test_its_pictures_are_small() -> None:
    for name in ("not-but-sheet", "not-but-tracks"):
        assert f"pictures/{name}.png" in PAGE
        assert (ROOT / "docs" / "pictures" / f"{name}.png").stat().st_size < 300_000
