"""A Dask cluster: the same bytes as serially, and nothing lost when worker or scheduler dies."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from batches import FAULTY, clips, listed, ran, ran_by, rows, states

from azee.batch.cluster import ClusterWorkers
from azee.cli.main import run
from azee_grammar.diagnostic import AZeeError

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


@contextmanager
def part(folder: Path, *arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """A scheduler or a worker of Dask in a process of its own, which can be killed."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    process = subprocess.Popen(
        [sys.executable, "-m", "dask", *arguments],
        cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        yield process
    finally:
        process.kill()
        process.wait()


@contextmanager
def cluster(folder: Path, workers: int) -> Iterator[list[subprocess.Popen[bytes]]]:
    """A scheduler on this machine and some workers, in this order; its address is in a file."""
    folder.mkdir()
    file = folder / "scheduler.json"
    where = ("--host", "127.0.0.1", "--no-dashboard")
    with ExitStack() as stack:
        scheduler = part(folder, "scheduler", *where, "--port", "0", "--scheduler-file", str(file))
        processes = [stack.enter_context(scheduler)]
        while not file.exists():
            assert processes[0].poll() is None
            time.sleep(0.05)
        for _ in range(workers):
            one = ("worker", *where, "--scheduler-file", str(file), "--nthreads", "1", "--no-nanny")
            processes.append(stack.enter_context(part(folder, *one)))
        yield processes


def address(folder: Path) -> str:
    """The address of the scheduler of a folder."""
    return str(json.loads((folder / "scheduler.json").read_text("utf-8"))["address"])


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


def test_worker_and_scheduler_are_killed_and_nothing_is_lost_or_done_twice(
    serial: tuple[Path, dict[str, bytes]], tmp_path: Path
) -> None:
    source, expected = serial
    out = tmp_path / "out"
    out.mkdir()

    class Killing(ClusterWorkers):
        """Kills a worker after the first record, and the scheduler after the third."""

        def do(self, tasks):  # type: ignore[no-untyped-def]
            for number, done in enumerate(super().do(tasks), 1):
                yield done
                if number in (1, 3):
                    victim = processes[-1] if number == 1 else processes[0]
                    victim.send_signal(signal.SIGKILL)

    with cluster(tmp_path / "first", 2) as processes:
        gone = pytest.raises(AZeeError, match=r"no-cluster: the scheduler at .* is gone")
        with Killing(address(tmp_path / "first"), out) as hands, gone:
            ran_by(hands, source, out)
        time.sleep(0.5)
    kept = states(out)
    assert len(kept) >= 3
    listed_then = {name for row in rows(out) for name in row["files"].values()}
    assert {name: (out / name).read_bytes() for name in listed_then}.items() <= expected.items()
    second = tmp_path / "second"
    with cluster(second, 1), ClusterWorkers(address(second), out) as hands:
        summary = ran_by(hands, source, out)
    assert summary.done == TEXTS - len(kept)
    assert kept.items() <= states(out).items()
    assert clips(out) == expected


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
