"""A batch from its sources to its manifest."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from azee.batch.options import Options
from azee.batch.record import Record, files_of, kept_record, write_manifest
from azee.batch.task import Body, Task, tasks_of
from azee.batch.text import Text
from azee.formats import writing


class Workers(Protocol):
    """Who does tasks."""

    def do(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, Record]]:
        """Yield tasks with their records, as they get done; each is done once."""


@dataclass(slots=True)
class Summary:
    """What came of a batch. tasks: all; done: in this run. Faulty tasks were done, too."""

    tasks: int = 0
    done: int = 0
    faulty: int = 0
    clips: int = 0
    files: int = 0
    size_bytes: int = 0
    seconds: float = 0.0
    errors: list[str] = field(default_factory=list)
    """The first diagnostics, a line each."""


MOST_ERRORS = 10


def run_batch(
    texts: Sequence[Text],
    bodies: Sequence[Body],
    options: Options,
    out: Path,
    workers: Callable[[], AbstractContextManager[Workers]],
    libraries: Sequence[Path] = (),
    progress: Callable[[int, int], None] | None = None,
) -> Summary:
    """Do what is not done yet of a batch, then write its manifest, also after an exception.

    Args: out: the folder of outputs, which exists. workers: starts them, if there is work.
        progress: called with the tasks that are done, and all of them.
    Raises: AZeeError: cannot-write; what the workers raise.
    """
    began = time.perf_counter()
    tasks = list(tasks_of(texts, bodies, options, libraries))
    missing = [task for task in tasks if kept_record(out, task) is None]
    passing: dict[str, Record] = {}
    summary = Summary(tasks=len(tasks))
    try:
        if progress:
            progress(len(tasks) - len(missing), len(tasks))
        if missing:
            with workers() as hands:
                for task, record in hands.do(missing):
                    summary.done += 1
                    if record.get("passing"):
                        passing[task.key] = record
                    if progress:
                        progress(len(tasks) - len(missing) + summary.done, len(tasks))
    finally:
        with writing(out):
            write_manifest(out, _told(_in_order(tasks, len(texts)), out, passing, summary))
    summary.seconds = time.perf_counter() - began
    return summary


def _in_order(tasks: Sequence[Task], texts: int) -> Iterator[Task]:
    """Yield tasks by text, then by body."""
    for number in range(texts):
        yield from tasks[number::texts]


def _told(
    tasks: Iterable[Task], out: Path, passing: dict[str, Record], summary: Summary
) -> Iterator[tuple[Task, Record]]:
    """Yield the tasks that have a record, and count what they have."""
    for task in tasks:
        record = passing.get(task.key) or kept_record(out, task)
        if record is None:
            continue  # not done yet
        yield task, record
        summary.clips += len(record.get("rows", ()))
        found = files_of(record)
        summary.files += len(found)
        summary.size_bytes += sum((out / name).stat().st_size for name in found)
        if "error" in record:
            summary.faulty += 1
            summary.errors += _lines(task, record)[: MOST_ERRORS - len(summary.errors)]


def _lines(task: Task, record: Record) -> list[str]:
    lines = []
    for found in record["error"]:
        place = f" ({found['file']}:{found['line']})" if found.get("file") else ""
        lines.append(f"{task.title}: {found['code']}: {found['message']}{place}")
    return lines
