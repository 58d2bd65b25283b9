"""docs/batch.md: its commands do what it says, and its table has every field of a manifest."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest
from pages import ROOT

from azee.cli.main import run

PAGE = (ROOT / "docs" / "batch.md").read_text(encoding="utf-8")
COMMANDS = [line.strip() for line in re.findall(r"^    azee batch .*$", PAGE, re.M)]
LINES = re.findall(r"^    (\{.*\})$", PAGE, re.M)


@pytest.mark.slow
def test_the_commands_of_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("texts.jsonl").write_text("\n".join(LINES[:1]) + "\n", encoding="utf-8")
    # A cluster is tried in tests/batch/test_cluster.py, a library's rules in test_rules.py there.
    here = [c for c in COMMANDS if "--scheduler" not in c and "--rules" not in c]
    assert len(here) == 2
    for command in here:
        assert run([*shlex.split(command)[1:], "--quiet"]) == 0
    for name in re.findall(r"^    ((?:out|varied)/\S+)$", PAGE, re.M):
        assert Path(name).is_file()
    row = json.loads(Path("varied/manifest.jsonl").read_text(encoding="utf-8").splitlines()[0])
    fields = "\n".join(line for line in PAGE.splitlines() if line.startswith("| "))
    for field in (*row, *row["seconds"]):
        assert f"`{field}`" in fields
