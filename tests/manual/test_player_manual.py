"""docs/player.md: its command exports a page, and its settings are those that the page reads."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest
from pages import ROOT, blocks

from azee.cli.main import run

PAGE = (ROOT / "docs" / "player.md").read_text(encoding="utf-8")
SETTINGS = ROOT / "azee" / "web" / "src" / "player" / "settings.ts"


@pytest.mark.slow
def test_the_command_exports_the_text_of_the_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for block in blocks(PAGE):
        if "file" in block.options:
            Path(block.options["file"]).write_text(block.text, encoding="utf-8")
        elif block.kind == "console":
            command, _, shown = block.text.partition("\n")
            program, *arguments = shlex.split(command.removeprefix("$ "))
            assert program == "azee"
            assert run(arguments) == 0
            assert capsys.readouterr() == (shown, "")
    catalogue = json.loads(Path("page/catalogue.json").read_text(encoding="utf-8"))
    (source,) = catalogue["sources"]
    assert source["signs"] == {"hello": "sign/0-0.azwc"}


def test_the_page_lists_every_setting() -> None:
    if not SETTINGS.is_file():
        pytest.skip("not a checkout")
    names = re.search(r"NAMES = \[(.*?)\]", SETTINGS.read_text(encoding="utf-8"), re.DOTALL)
    assert names is not None
    known = set(re.findall(r"'(\w+)'", names[1]))
    rows = [line.split("|")[1] for line in PAGE.splitlines() if line.startswith("| `")]
    listed = {name for row in rows for name in re.findall(r"`(\w+)`", row)}
    assert known <= listed
