"""Workers on this machine: a process each, started again when one dies.

A worker that is killed costs its task only: the task is tried once more by another, then given up.
A worker that has lost the command, because that was killed, ends at once. So nobody writes to the
outputs when the command is started again.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from pathlib import Path
from types import TracebackType

from azee.batch.record import Record, failure, passing
from azee.batch.task import Task

TRIES = 2
STOP_S = 5.0
"""How long a worker may take to tidy up after it was told to end."""
ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""Environment variables for BLAS: its threads would only wait for those of other workers."""


class _Worker:
    """A process, our end of its pipe, and the task that it is doing."""

    def __init__(self, out: Path) -> None:
        spawning = multiprocessing.get_context("spawn")
        self.pipe, theirs = spawning.Pipe()
        self.process: SpawnProcess = spawning.Process(
            target=_serve, args=(theirs, out), daemon=True
        )
        with _single_threads():
            self.process.start()
        theirs.close()
        self.task: Task | None = None

    def give(self, task: Task) -> None:
        """Send a task. If the worker is dead, `answer` tells so."""
        self.task = task
        with suppress(OSError):
            self.pipe.send(task)

    def answer(self) -> Record | None:
        """Return the record of the task, None if the worker died."""
        try:
            record: Record = self.pipe.recv()
        except (EOFError, OSError):
            return None
        self.task = None
        return record


class LocalWorkers:
    """Does tasks in some processes of this machine."""

    def __init__(self, count: int, out: Path) -> None:
        self._count, self._out = count, out
        self._workers: list[_Worker] = []

    def __enter__(self) -> LocalWorkers:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End all workers; one that is in the middle of a file leaves none of it."""
        for worker in self._workers:
            worker.process.terminate()
        for worker in self._workers:
            worker.process.join(STOP_S)
            if worker.process.is_alive():
                worker.process.kill()
                worker.process.join()
            worker.pipe.close()
        self._workers.clear()

    @property
    def process_ids(self) -> list[int]:
        """Numbers of the workers' processes, in the order in which they were started."""
        return [worker.process.pid or 0 for worker in self._workers]

    def do(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, Record]]:
        """Yield tasks with their records, as they get done."""
        coming = iter(tasks)
        again: deque[Task] = deque()
        tries: dict[str, int] = {}
        while True:
            self._hand_out(again, coming)
            busy = [worker for worker in self._workers if worker.task is not None]
            if not busy:
                return
            ready = wait([worker.pipe for worker in busy])
            for worker in busy:
                if worker.pipe not in ready:
                    continue
                task = worker.task
                assert task is not None
                record = worker.answer()
                if record is None:
                    self._bury(worker)
                    tries[task.key] = tries.get(task.key, 0) + 1
                    if tries[task.key] < TRIES:
                        again.append(task)
                        continue
                    record = passing(task, [failure(f"{TRIES} workers died of it")])
                yield task, record

    def _hand_out(self, again: deque[Task], coming: Iterator[Task]) -> None:
        """Give every idle worker a task; start workers as long as there is work for them."""
        idle = [worker for worker in self._workers if worker.task is None]
        while idle or len(self._workers) < self._count:
            task = again.popleft() if again else next(coming, None)
            if task is None:
                return
            if not idle:
                idle.append(_Worker(self._out))
                self._workers.append(idle[0])
            idle.pop().give(task)

    def _bury(self, worker: _Worker) -> None:
        worker.process.kill()
        worker.process.join()
        worker.pipe.close()
        self._workers.remove(worker)


@contextmanager
def _single_threads() -> Iterator[None]:
    """Let processes that are started have one thread of BLAS each, unless the user says more."""
    added = [name for name in ONE_THREAD if name not in os.environ]
    os.environ.update(dict.fromkeys(added, "1"))
    try:
        yield
    finally:
        for name in added:
            del os.environ[name]


def _serve(pipe: Connection, out: Path) -> None:
    """Do tasks until there are no more. This is the worker's process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the command, which ends us
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    threading.Thread(target=_end_with_the_command, daemon=True).start()
    from azee.batch.work import prepare, work

    prepare()
    with suppress(EOFError, OSError):
        while True:
            pipe.send(work(pipe.recv(), out))


def _end_with_the_command() -> None:
    command = multiprocessing.parent_process()
    assert command is not None
    command.join()
    os._exit(1)
