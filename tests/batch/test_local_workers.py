"""Workers on this machine: the same bytes as serially, and nothing lost when any process dies."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from batches import FAULTY, clips, listed, ran, ran_by, rows, states

from azee.batch.local import LocalWorkers

TEXTS, KILLS = 10, 3
COMMAND = ("--formats", "bvh,json", "--hands", "right,left", "--speeds", "1,0.8", "--quiet")


@pytest.fixture(scope="module")
def serial(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, bytes]]:
    """A list of texts, and what is written of it without workers."""
    folder = tmp_path_factory.mktemp("serial")
    source = listed(folder, TEXTS)
    ran(source, folder / "out")
    return source, clips(folder / "out")


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
def test_a_killed_worker_costs_its_task_only(
    serial: tuple[Path, dict[str, bytes]], tmp_path: Path
) -> None:
    source, expected = serial
    out = tmp_path / "out"

    class Killing(LocalWorkers):
        """Kills a worker after each of the first records."""

        killed = 0

        def do(self, tasks):  # type: ignore[no-untyped-def]
            for done in super().do(tasks):
                yield done
                if self.killed < 2:
                    self.killed += 1
                    os.kill(self.process_ids[0], signal.SIGKILL)

    out.mkdir()
    workers = Killing(2, out)
    with workers:
        summary = ran_by(workers, source, out)
    assert workers.killed == 2
    assert (summary.tasks, summary.done, summary.faulty) == (TEXTS, TEXTS, 1)
    assert clips(out) == expected
    assert [row["name"] for row in rows(out) if row["error"]] == [f"t{FAULTY}"]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
def test_a_command_killed_at_random_goes_on_where_it_was(
    serial: tuple[Path, dict[str, bytes]], tmp_path: Path
) -> None:
    source, expected = serial
    out = tmp_path / "out"
    arguments = ["-m", "azee", "batch", str(source), "-o", str(out), *COMMAND, "--workers", "2"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    chance, kept = random.Random(22), dict[str, tuple[int, int]]()
    for kill in range(KILLS + 1):
        command = subprocess.Popen([sys.executable, *arguments], env=environment)
        if kill < KILLS:
            while len(states(out)) < 2 * kill + 1 and command.poll() is None:
                time.sleep(0.02)
            time.sleep(chance.uniform(0.0, 0.3))
            command.kill()
            command.wait()
        else:
            assert command.wait() == 1  # one text is at fault
        found = states(out)
        assert kept.items() <= found.items(), "a task was done twice"
        kept = found
    assert len(kept) == TEXTS
    assert clips(out) == expected


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGINT")
def test_ctrl_c_leaves_whole_files_and_a_manifest(
    serial: tuple[Path, dict[str, bytes]], tmp_path: Path
) -> None:
    source, expected = serial
    out = tmp_path / "out"
    arguments = ["-m", "azee", "batch", str(source), "-o", str(out), *COMMAND, "--workers", "1"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    command = subprocess.Popen(
        [sys.executable, *arguments],
        env=environment,
        stderr=subprocess.PIPE,
        start_new_session=True,
        # What starts the tests may ignore Ctrl-C, as shells have it for jobs in the background.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    while not states(out) and command.poll() is None:
        time.sleep(0.02)
    os.killpg(command.pid, signal.SIGINT)  # as a terminal does, to all processes
    _, told = command.communicate()
    assert command.returncode == 130
    assert b"Traceback" not in told
    written = clips(out)
    assert 0 < len(written) < len(expected)
    assert written.items() <= expected.items()
