"""Measures whether threads of BLAS slow down a compile: `benchmarks/run.py threads`.

Two processes compile `:arbre` in turns: one with BLAS's default number of threads, one with a
single thread. Both should take the same time, because all products are small. Threads that wait for
each other cost most where other programs use the processor too.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType

ROOT = Path(__file__).parents[1]
SETTINGS = (
    "OPENBLAS_NUM_THREADS",
    "OMP_NUM_THREADS",
    "MKL_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
)
"""Environment variables that set the number of threads of OpenBLAS, MKL and Accelerate."""
RUNS = 15
AT_MOST = 1.1
"""Largest ratio of the time with default threads to the time with one."""
WORKER = """
import sys, time
import azee

for _ in sys.stdin:
    began = time.perf_counter()
    azee.compile(":arbre")
    print(time.perf_counter() - began, flush=True)
"""


class Worker:
    """A process that compiles when asked, and reports the time."""

    def __init__(self, settings: Mapping[str, str]) -> None:
        """Start it with environment variables for BLAS; others of `SETTINGS` are unset."""
        kept = {name: value for name, value in os.environ.items() if name not in SETTINGS}
        self._process = subprocess.Popen(
            [sys.executable, "-c", WORKER],
            cwd=ROOT,
            env={**kept, **settings},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __enter__(self) -> Worker:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._process.communicate()

    def run_s(self) -> float:
        """Compile once; return the wall-clock time in seconds."""
        asked, told = self._process.stdin, self._process.stdout
        assert asked is not None
        assert told is not None
        asked.write("\n")
        asked.flush()
        return float(told.readline())


def medians_s(runs: int) -> tuple[float, float]:
    """Return the median time with default threads and with one thread, after two warm-up runs."""
    with Worker({}) as default, Worker(dict.fromkeys(SETTINGS, "1")) as single:
        took = [(default.run_s(), single.run_s()) for _ in range(runs + 2)][2:]
    by_default, alone = zip(*took, strict=True)
    return statistics.median(by_default), statistics.median(alone)


def main(arguments: Sequence[str] = ()) -> None:
    """Print both medians and their ratio. The first argument is the number of runs."""
    runs = int(arguments[0]) if arguments else RUNS
    by_default, alone = medians_s(runs)
    ratio = by_default / alone
    print(f":arbre in a running process, median of {runs} runs in turns")
    print(f"  default threads of BLAS  {1000 * by_default:8.1f} ms")
    print(f"  one thread               {1000 * alone:8.1f} ms")
    kept = "kept" if ratio <= AT_MOST else "missed"
    print(f"  ratio                    {ratio:8.2f}     goal: at most {AT_MOST}, {kept}")
