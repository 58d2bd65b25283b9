"""The examples of recorded signs: the commands on their pages do what they say."""

from __future__ import annotations

import re
import shlex
import shutil
from itertools import pairwise
from pathlib import Path

import pytest
from PIL import Image
from programs import Python

EXAMPLES = Path(__file__).parents[2] / "examples"
FOLDERS = ("recorded-tree", "letters-l-j")


@pytest.mark.parametrize("folder", FOLDERS)
def test_the_page_shows_a_picture(folder: str) -> None:
    readme = (EXAMPLES / folder / "README.md").read_text(encoding="utf-8")
    assert f"({folder}.png)" in readme
    with Image.open(EXAMPLES / folder / f"{folder}.png") as picture:
        assert picture.width > 300


@pytest.mark.slow
@pytest.mark.parametrize("folder", FOLDERS)
def test_the_commands_write_their_files(folder: str, python: Python, tmp_path: Path) -> None:
    shutil.copytree(EXAMPLES, tmp_path / "examples")
    text = (EXAMPLES / folder / "README.md").read_text(encoding="utf-8")
    lines = re.findall(r"^    azee (.*)$", text, re.M)
    assert len(lines) > 2
    for line in lines:
        arguments = shlex.split(line)
        python("-m", "azee", *arguments, expect=0)
        for option, value in pairwise(arguments):
            if option == "-o":
                assert (tmp_path / value).stat().st_size > 1000
