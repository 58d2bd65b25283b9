"""The same text gives the same files: on three runs, in two processes, whatever they hash."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from programs import Python

from azee.cli.main import run

TREE = Path(__file__).parents[2] / "examples" / "tree" / "tree.azee"
SUFFIXES = (".glb", ".json", ".bvh")


@pytest.mark.slow
def test_three_runs_and_another_process_write_the_same_bytes(
    python: Python, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def options(name: str) -> list[str]:
        outputs = [f"{tmp_path / name}{suffix}" for suffix in SUFFIXES]
        named = [word for output in outputs for word in ("-o", output)]
        return [str(TREE), *named, "--report", f"{tmp_path / name}.report.json", "--quiet"]

    for name in ("first", "second"):
        assert run(["compile", *options(name)]) == 0
    for seed in ("1", "2"):
        monkeypatch.setenv("PYTHONHASHSEED", seed)
        python("-m", "azee", "compile", *options(seed), expect=0)
    for suffix in SUFFIXES:
        files = [
            (tmp_path / f"{name}{suffix}").read_bytes() for name in ("first", "second", "1", "2")
        ]
        assert all(file == files[0] for file in files), suffix
    reports = [timeless(tmp_path / f"{name}.report.json") for name in ("first", "second", "1", "2")]
    assert all(report == reports[0] for report in reports)


def timeless(path: Path) -> dict[str, Any]:
    """A report without what differs from run to run."""
    report: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return {key: value for key, value in report.items() if key not in ("solve_s", "explain_s")}
