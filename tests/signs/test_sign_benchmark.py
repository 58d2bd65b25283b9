"""The benchmark of the database runs, at a tiny size."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import sign_database


@pytest.mark.slow
def test_a_small_database_is_measured(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sign_database.measured(str(tmp_path / "signs.db"), 40)
    told = capsys.readouterr().out
    assert "40 signs stored" in told
    assert told.count("goal 10 ms") == 5
    assert "by name, 1 found" in told
