"""The same text gives the same files: on three runs, in two processes, whatever they hash."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from programs import Python

from azee.cli.main import run
from azee.formats import SUFFIXES

TREE = Path(__file__).parents[2] / "examples" / "tree" / "tree.azee"
ARBRE = """
import sys, time
import azee

def others_s():
    return time.process_time() - time.thread_time()

outputs = sys.argv[1:]
azee.compile(":arbre")
before = others_s()
made = azee.compile(":arbre")
print(others_s() - before)
for path in outputs:
    made.save(path)
made.save_report(outputs[0] + ".report.json")
"""
"""Compiles a sign whose ways lead round the body; prints the time of all threads but this one."""


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


@pytest.mark.slow
def test_threads_of_blas_change_no_byte_and_take_no_time(
    python: Python, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    suffixes = (".glb", ".npz")  # of which the latter has all digits
    for count in ("1", "2"):
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", count)
        outputs = [str(tmp_path / f"{count}{suffix}") for suffix in suffixes]
        done = python("-c", ARBRE, *outputs, expect=0)
        assert float(done.stdout) < 0.02
    for suffix in suffixes:
        one, two = ((tmp_path / f"{count}{suffix}").read_bytes() for count in ("1", "2"))
        assert one == two, suffix
    one_report, two_report = (timeless(tmp_path / f"{c}.glb.report.json") for c in ("1", "2"))
    assert one_report == two_report


def timeless(path: Path) -> dict[str, Any]:
    """A report without what differs from run to run."""
    report: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return {key: value for key, value in report.items() if key not in ("solve_s", "explain_s")}
