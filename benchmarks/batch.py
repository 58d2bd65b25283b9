"""Measures `azee batch`: `benchmarks/run.py batch [--count N] [--texts N]`.

The same texts are compiled by one worker and by two, in turns, each after warm-up tasks that load
language, body and solver. The ratio of their rates shows what is lost to the batch itself; it
means something on a quiet machine with two processors only. Then one worker does `--count`
different texts, and its resident memory (Linux) is read after some of them: in the first half what
a process remembers fills, and the allocator keeps what is free.
"""

from __future__ import annotations

import argparse
import os
import statistics
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from azee.batch.local import LocalWorkers
from azee.batch.options import Options
from azee.batch.record import Record
from azee.batch.task import Task, body_of, tasks_of
from azee.batch.text import Text
from azee_grammar.source import Source
from benchmarks.memory import STATM, WARM, different

LEAST_RATIO = 1.8
MOST_GROWTH_MB = 10.0
"""In the second half of the texts."""
TURNS = 3
SIMILAR = 200
"""After so many texts their places come again, with another time."""
OPTIONS = Options((".glb",), speeds=(1.0, 0.8))
MACHINES = 1000


def tasks(first: int, count: int) -> list[Task]:
    """Return tasks of short texts, no two alike."""
    texts = [Text(f"t{n}", Source(f"t{n}", _text(n))) for n in range(first, first + count)]
    return list(tasks_of(texts, [body_of("signer")], OPTIONS, []))


def _text(n: int) -> str:
    return f"{different(n % SIMILAR)}key {0.2 + 1e-4 * n:.4f} (look ^fwd)\n"


def rate(workers: LocalWorkers, some: Sequence[Task]) -> float:
    """Do some tasks; return how many a second."""
    began = time.perf_counter()
    for _, record in workers.do(some):
        _require_sound(record)
    return len(some) / (time.perf_counter() - began)


def resident_mb(process: int) -> float:
    """Return the resident memory of a process, MB."""
    pages = int(Path(f"/proc/{process}/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def processor_s(process: int) -> float:
    """Return the processor time of a process, seconds: other programs do not change it much."""
    _, _, fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")
    user, system = fields.split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


def growth(count: int, out: Path) -> Iterator[tuple[int, float]]:
    """Do many texts by one worker; yield how many are done, and its memory, MB."""
    marks = {WARM, *(round(count * part / 10) for part in range(1, 11))}
    with LocalWorkers(1, out) as workers:
        for number, (_, record) in enumerate(workers.do(tasks(0, count)), 1):
            _require_sound(record)
            if number in marks:
                yield number, resident_mb(workers.process_ids[0])


def _require_sound(record: Record) -> None:
    if "error" in record:
        raise SystemExit(f"a text failed: {record['error']}")


def _compared(texts: int, folder: Path) -> None:
    rates: dict[int, list[float]] = {1: [], 2: []}
    with LocalWorkers(1, folder / "1") as one, LocalWorkers(2, folder / "2") as two:
        pools = {1: one, 2: two}
        warm = {count: tasks(0, 4 * count) for count in pools}
        for count, workers in pools.items():
            rate(workers, warm[count])
        before_s = processor_s(one.process_ids[0]) if STATM.exists() else 0.0
        for turn in range(TURNS):
            some = tasks(SIMILAR + turn * texts, texts)
            for count, workers in pools.items():
                rates[count].append(rate(workers, some))
        after_s = processor_s(one.process_ids[0]) if STATM.exists() else 0.0
    one_s, two_s = (statistics.median(rates[count]) for count in (1, 2))
    ratio = two_s / one_s
    kept = "kept" if ratio >= LEAST_RATIO else "missed"
    print(f"batches of {texts} short texts, median of {TURNS} turns")
    print(f"  1 worker   {one_s:8.2f} texts a second, {1000 / one_s:8.0f} ms a text")
    print(f"  2 workers  {two_s:8.2f} texts a second")
    print(f"  ratio      {ratio:8.2f}     goal: at least {LEAST_RATIO}, {kept}")
    cost_s = (after_s - before_s) / (TURNS * texts) or 1 / one_s
    print(f"  cost       {1000 * cost_s:8.0f} ms of a processor a text")
    million_min = 1e6 * cost_s / MACHINES / 60
    print(f"  {MACHINES:,} machines with a worker each: a million texts in {million_min:.0f} min")


def main(arguments: Sequence[str] = ()) -> None:
    """Print rates and memory."""
    parser = argparse.ArgumentParser(prog="benchmarks/run.py batch", description=__doc__)
    parser.add_argument("--count", type=int, default=1000, help="texts for memory; 0 leaves it out")
    parser.add_argument("--texts", type=int, default=40, help="texts for rates; 0 leaves them out")
    chosen = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as name:
        if chosen.texts:
            _compared(chosen.texts, Path(name))
        if not chosen.count:
            return
        if not STATM.exists():
            print("memory: this benchmark reads /proc, which exists on Linux only")
            return
        print(f"memory of one worker over {chosen.count:,} texts")
        found = dict(growth(chosen.count, Path(name) / "memory"))
        for number, mb in found.items():
            print(f"  after {number:>6,} texts {mb:8.1f} MB", flush=True)
        second = [mb for number, mb in found.items() if number >= chosen.count / 2]
        grown = max(second) - second[0]
        kept = "kept" if grown <= MOST_GROWTH_MB else "missed"
        print(f"  growth in the second half {grown:.1f} MB; goal {MOST_GROWTH_MB:.0f}, {kept}")
