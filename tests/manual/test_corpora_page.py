"""docs/corpora.md: its commands print what the page shows, on the files that it gives."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pympi
import pytest
from pages import ROOT, Block, blocks

from azee.cli.main import run

BLOCKS = list(blocks((ROOT / "docs" / "corpora.md").read_text(encoding="utf-8")))
COMMANDS = [block for block in BLOCKS if block.kind == "console"]
EXAMPLES = {
    "cinema-good.azee",
    "not-but.azee",
    "person-aged-52.azee",
}


def _prepare(folder: Path) -> None:
    (folder / "examples").mkdir()
    for path in sorted((ROOT / "examples").glob("*/*.azee")):
        if path.name in EXAMPLES:
            shutil.copy(path, folder / "examples")
    for block in BLOCKS:
        if name := block.options.get("file"):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(block.text, encoding="utf-8")


def _record(path: Path) -> None:
    """Annotate a recording as the page says; ours is made with pympi, not with our writer."""
    file = pympi.Elan.Eaf()
    file.add_tier("RH")
    for start, end, text in ((2100, 2760, "ARBRE"), (3000, 3200, "PAS"), (3320, 4980, "ARMOIRE")):
        file.add_annotation("RH", start, end, text)
    file.to_file(str(path))


def _said(block: Block, capsys: pytest.CaptureFixture[str]) -> tuple[str, str]:
    command, _, shown = block.text.partition("\n")
    program, *arguments = shlex.split(command.removeprefix("$ "))
    assert program == "azee"
    assert run(arguments) == int(block.options.get("exit", "0")), command
    captured = capsys.readouterr()
    return (captured.out + captured.err).replace("\\", "/"), shown


def test_every_command_prints_what_the_page_shows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The commands run one after the other, as a reader would type them."""
    _prepare(tmp_path)
    _record(tmp_path / "recording.eaf")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    assert len(COMMANDS) > 3
    for block in COMMANDS:
        told, shown = _said(block, capsys)
        assert _plain(told) == _plain(shown), block


def _plain(text: str) -> str:
    """Without the digests of libraries, which any change of their rules changes."""
    return re.sub("[0-9a-f]{16}", "…", text).rstrip("\n")
