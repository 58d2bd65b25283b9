"""docs/signs.md: its commands print what the page shows, on files like those that it names."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import numpy as np
import pytest
from pages import ROOT, Block, blocks
from recorded_files import STATUE, wave

from azee.cli.main import run
from azee.clip.clip import Clip
from azee.clips import save_clip
from azee_rig.rig import Rig

BLOCKS = list(blocks((ROOT / "docs" / "signs.md").read_text(encoding="utf-8")))


def _prepare(folder: Path, signer: Rig) -> None:
    (folder / "recordings").mkdir()
    (folder / "recordings" / "MERHABA.bvh").write_text(wave(), encoding="utf-8")
    (folder / "statue.bvh").write_text(STATUE, encoding="utf-8")
    still = np.tile(signer.coordinates.idle, (61, 1))
    save_clip(Clip(np.arange(61) / 30, still, (), np.zeros((61, 0))), signer, folder / "TREE.npz")


def _run(block: Block, capsys: pytest.CaptureFixture[str]) -> None:
    command, _, shown = block.text.partition("\n")
    program, *arguments = shlex.split(command.removeprefix("$ "))
    assert program == "azee"
    assert run(arguments) == int(block.options.get("exit", "0")), command
    captured = capsys.readouterr()
    told = (captured.out + captured.err).replace("\\", "/")
    assert _plain(told) == _plain(shown), command


@pytest.mark.long
def test_every_command_prints_what_the_page_shows(
    tmp_path: Path,
    signer: Rig,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The commands run one after the other, as a reader would type them."""
    _prepare(tmp_path, signer)
    monkeypatch.chdir(tmp_path)
    done = [block.kind for block in BLOCKS]
    assert done.count("console") > 10
    assert done.count("python") == 1
    for block in BLOCKS:
        if block.kind == "python":
            exec(compile(block.text, "page", "exec"), {})
        else:
            _run(block, capsys)


def _plain(text: str) -> str:
    """Without digests."""
    return re.sub("[0-9a-f]{64}", "…", text).rstrip("\n")
