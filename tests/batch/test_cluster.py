"""A Dask cluster: the same bytes as serially, and one message where there is none."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from batches import FAULTY, clips, listed, ran, ran_by, rows

from azee.batch.cluster import ClusterWorkers
from azee.cli.main import run

TEXTS = 8
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL"),
    pytest.mark.filterwarnings("default::DeprecationWarning", "default::ResourceWarning"),
]


@pytest.fixture(scope="module")
def serial(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, bytes]]:
    """A list of texts, and what is written of it without workers."""
    folder = tmp_path_factory.mktemp("serial")
    source = listed(folder, TEXTS)
    ran(source, folder / "out")
    return source, clips(folder / "out")


def test_a_local_cluster_of_two_writes_the_same_bytes(
    serial: tuple[Path, dict[str, bytes]], tmp_path: Path
) -> None:
    from distributed import LocalCluster

    source, expected = serial
    out = tmp_path / "out"
    out.mkdir()
    with LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0", host="127.0.0.1",
        local_directory=str(tmp_path),
    ) as workers, ClusterWorkers(workers.scheduler_address, out) as hands:  # fmt: skip
        summary = ran_by(hands, source, out)
    assert (summary.tasks, summary.done, summary.faulty) == (TEXTS, TEXTS, 1)
    assert clips(out) == expected
    assert [row["name"] for row in rows(out) if row["error"]] == [f"t{FAULTY}"]


def test_a_scheduler_that_is_not_there_gets_one_message(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("azee.batch.cluster.CONNECT_S", 0.5)
    source = listed(tmp_path, 1)
    where = ["--scheduler", "tcp://127.0.0.1:9"]
    assert run(["batch", str(source), "-o", str(tmp_path / "out"), *where]) == 1
    told = capsys.readouterr().err
    assert "error[no-cluster]: there is no Dask scheduler at tcp://127.0.0.1:9" in told
    assert "Traceback" not in told
