"""Workers on a Dask cluster that is there already: the extra `batch`.

The folder of outputs, libraries and bodies outside the package must have the same paths on all
machines. A worker does one task at a time, whatever number of threads it has. What a worker was
doing when it died, the scheduler gives to another one. What was done when the scheduler died is
kept, and the next run goes on from there.
"""

from __future__ import annotations

import logging
import re
import threading
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import CancelledError
from itertools import islice
from pathlib import Path
from types import TracebackType
from typing import Any

from azee.batch.record import Record, failure, passing
from azee.batch.task import Task
from azee.batch.version import installed_version
from azee_grammar.diagnostic import AZeeError, Diagnostic

ADDRESS = re.compile(r"((tcp|tls)://)?([\w.-]+|\[[\da-fA-F:.%\w]+\]):\d{1,5}")
"""Dask waits for ever where it knows no such protocol."""
CONNECT_S = 10
WAITING = 4
"""Tasks that are handed to the scheduler for each worker: one is done, the others wait."""
LOOK_S = 0.02
"""Between looks whether a task is done, and whether the scheduler is there."""

_ONE_AT_A_TIME = threading.Lock()


class ClusterWorkers:
    """Does tasks on the workers of a scheduler.

    Raises: AZeeError: no-cluster: there is no scheduler, or its workers are none or have another
        azee; not-installed.
    """

    def __init__(self, address: str, out: Path) -> None:
        self._address, self._out = address, out
        self._client = _connected(address)
        try:
            self._count = self._sound_workers()
        except BaseException:
            self._client.close()
            raise

    def __enter__(self) -> ClusterWorkers:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave the cluster; what waits there is given up."""
        self._client.close(timeout=CONNECT_S)

    def do(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, Record]]:
        """Yield tasks with their records, as they get done.

        Raises: AZeeError: no-cluster: the scheduler is gone.
        """
        from distributed import as_completed

        coming = iter(tasks)
        doing = {self._submitted(task): task for task in islice(coming, WAITING * self._count)}
        completed = as_completed([*doing])
        while doing:
            done = completed.next_batch(block=False)
            if not done:
                if self._client.status != "running":
                    raise AZeeError(self._gone())
                time.sleep(LOOK_S)
            for future in done:
                task = doing.pop(future)
                yield task, self._record(task, future)
                for task in islice(coming, 1):
                    another = self._submitted(task)
                    doing[another] = task
                    completed.add(another)

    def _record(self, task: Task, future: Any) -> Record:
        """Return the record of a task, also of one that no worker survived.

        Raises: AZeeError: no-cluster: the scheduler is gone, perhaps with the record on its way.
        """
        try:
            error = future.exception()
            if error is None and not future.cancelled():
                record: Record = future.result()
                return record
        except (OSError, CancelledError) as cause:
            raise AZeeError(self._gone()) from cause
        if error is None or isinstance(error, CancelledError):
            raise AZeeError(self._gone())
        return passing(task, [failure(f"{type(error).__name__}: {error}")])

    def _gone(self) -> Diagnostic:
        return _no_cluster(f"the scheduler at {self._address} is gone")

    def _submitted(self, task: Task) -> Any:
        return self._client.submit(_work, task, str(self._out), key=f"azee-{task.key}")

    def _sound_workers(self) -> int:
        """Return how many workers there are; they have the same azee."""
        try:
            self._client.wait_for_workers(1, timeout=CONNECT_S)
        except TimeoutError as error:
            message = f"the scheduler at {self._address} has no workers"
            raise AZeeError(_no_cluster(message)) from error
        try:
            versions = self._client.run(installed_version)
        except Exception as error:
            message = f"a worker of {self._address} cannot run azee: {error}"
            raise AZeeError(_no_cluster(message)) from error
        others = {version for version in versions.values() if version != installed_version()}
        if others:
            message = f"workers of {self._address} have azee {', '.join(sorted(others))}"
            mine = f"here it is {installed_version()}; install the same everywhere"
            raise AZeeError(_no_cluster(message, mine))
        return len(versions)


def _work(task: Task, out: str) -> Record:
    """Do a task in a thread of a worker. Solving is not for several threads at once."""
    from azee.batch.work import work

    with _ONE_AT_A_TIME:
        return work(task, Path(out))


def _connected(address: str) -> Any:
    """Return a client of a scheduler. Raises: AZeeError: no-cluster, not-installed."""
    try:
        from distributed import Client
    except ImportError as error:
        raise AZeeError(
            Diagnostic(
                "not-installed",
                "clusters are reached by Dask, which is not installed",
                None,
                help="install it with: pip install 'azee[batch]'",
            )
        ) from error
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    help_ = "an address is such as tcp://10.0.0.1:8786; `dask scheduler` prints its own"
    if not ADDRESS.fullmatch(address):
        message = f"`{address}` is no address of a Dask scheduler"
        raise AZeeError(_no_cluster(message, help_))
    try:
        return Client(address, timeout=CONNECT_S)
    except (OSError, ValueError) as error:
        message = f"there is no Dask scheduler at {address}"
        raise AZeeError(_no_cluster(message, help_)) from error


def _no_cluster(message: str, help_: str | None = None) -> Diagnostic:
    remedy = help_ or "start it again, then this command: it goes on where it was"
    return Diagnostic("no-cluster", message, None, help=remedy)
