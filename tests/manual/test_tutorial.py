"""docs/language/tutorial.md: its files and commands, in order, do what the page says."""

from __future__ import annotations

import re
import shlex
from itertools import pairwise
from pathlib import Path

import pytest
from pages import LANGUAGE, Block, blocks, page, pairs
from PIL import Image

from azee.cli.main import run

PAGE = page("tutorial.md")
BLOCKS = list(blocks(PAGE))
PICTURES = re.findall(r"!\[[^]]+\]\((pictures/\S+)\)", PAGE)
PREPARING = ["make demo", ". .venv/bin/activate"]
"""What is done once, before the first file is written."""
MOST_BYTES = 120_000


def _commands(block: Block) -> list[list[str]]:
    return [shlex.split(line) for line in block.text.splitlines() if line not in PREPARING]


def _told(shown: str, said: str) -> bool:
    """Whether what a page shows was said, in this order; a line `…` leaves something out."""
    at = 0
    for part in re.split(r"^…\n", shown, flags=re.M):
        if (found := said.find(part, at)) < 0:
            return False
        at = found + len(part)
    return True


@pytest.mark.parametrize(
    "compiling", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["quick", "whole"]
)
def test_the_files_and_commands_of_the_page_in_order(
    compiling: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    done = 0
    for block, following in pairs(BLOCKS):
        if block.kind == "azee":
            Path(block.options["file"]).write_text(block.text, encoding="utf-8", newline="\n")
        if block.kind != "sh":
            continue
        shown = following.text if following is not None and following.kind == "text" else ""
        said = ""
        for program, *arguments in _commands(block):
            assert program == "azee"
            if arguments[0] == "compile" and not compiling:
                continue
            assert run(arguments) == (1 if "error[" in shown else 0), block
            captured = capsys.readouterr()
            said += captured.out + captured.err
            done += 1
            for option, value in pairwise(arguments):
                assert option != "-o" or Path(value).stat().st_size > 1000
            assert "out of tolerance" not in said or "iraq.glb" in arguments
        assert _told(shown, said), block
    assert done > (15 if compiling else 8)
    if compiling:
        assert all(Path(picture).name in {p.name for p in Path().iterdir()} for picture in PICTURES)


def test_every_block_has_its_part() -> None:
    assert {block.kind for block in BLOCKS} == {"azee", "sh", "text"}
    shell = [b for b in BLOCKS if b.kind == "sh"]
    assert [b.text.strip() for b in shell if not _commands(b)] == PREPARING
    for before, block in pairs(BLOCKS):
        assert block is None or block.kind != "text" or before.kind in ("sh", "text")


@pytest.mark.parametrize("picture", PICTURES)
def test_a_picture_is_there_and_small(picture: str) -> None:
    path = LANGUAGE / picture
    assert path.stat().st_size <= MOST_BYTES
    with Image.open(path) as image:
        assert image.height > 300


def test_no_picture_is_left_over() -> None:
    kept = {path.relative_to(LANGUAGE).as_posix() for path in (LANGUAGE / "pictures").iterdir()}
    assert kept == set(PICTURES)
