"""Small batches for tests, and what they wrote."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any

from azee.batch.options import Options
from azee.batch.record import MANIFEST, RECORD, Record
from azee.batch.run import Summary, Workers, run_batch
from azee.batch.task import Task, body_of
from azee.batch.text import texts_of
from azee.batch.work import work

OPTIONS = Options((".bvh", ".json"), hands=("right", "left"), speeds=(1.0, 0.8))
FAULTY = 3
"""Which line of a list names a rule that is not there."""


class Serial:
    """Does tasks in this process, one after the other."""

    def __init__(self, out: Path) -> None:
        self._out = out
        self.done: list[str] = []

    def do(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, Record]]:
        for task in tasks:
            self.done.append(task.title)
            yield task, work(task, self._out)


def listed(folder: Path, count: int) -> Path:
    """A list of texts that are solved quickly; one of them is at fault."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "texts.jsonl"
    lines = []
    for n in range(count):
        text = f"def sign\n    key .2 (place @I_TIP(s) point(.1, {0.02 * n:.2f}, .4))\n:sign"
        line = {"name": f"t{n}", "text": ":nobody" if n == FAULTY else text, "gloss": f"G{n}"}
        lines.append(json.dumps(line))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def ran(
    source: Path, out: Path, options: Options = OPTIONS, bodies: Sequence[str] = ("signer",)
) -> tuple[Summary, list[str]]:
    """Run a batch serially; return what came of it, and the tasks that were done."""
    serial = Serial(out)
    return ran_by(serial, source, out, options, bodies), serial.done


def ran_by(
    workers: Workers,
    source: Path,
    out: Path,
    options: Options = OPTIONS,
    bodies: Sequence[str] = ("signer",),
) -> Summary:
    """Run a batch by some workers."""
    out.mkdir(exist_ok=True)
    found = [body_of(body) for body in bodies]
    return run_batch(texts_of([source]), found, options, out, lambda: nullcontext(workers))


def rows(out: Path) -> list[dict[str, Any]]:
    """The lines of a manifest."""
    return [json.loads(line) for line in (out / MANIFEST).read_text("utf-8").splitlines()]


def clips(out: Path) -> dict[str, bytes]:
    """The bytes of all files of clips; nothing else may be there but records."""
    named = {name for row in rows(out) for name in row["files"].values()}
    there = {p.relative_to(out).as_posix(): p for p in out.rglob("*") if p.is_file()}
    records = {name for name in there if name.endswith(RECORD)}
    assert set(there) - named - records <= {MANIFEST, ".lock"}
    return {name: there[name].read_bytes() for name in named}


def states(out: Path) -> dict[str, tuple[int, int]]:
    """Which file each record is, and when it was written: a task done twice changes that."""
    found = {}
    for path in out.glob(f"*/*{RECORD}"):
        state = path.stat()
        found[path.parent.name] = state.st_ino, state.st_mtime_ns
    return found
