"""Measures the memory that a process keeps after many texts: `benchmarks/run.py memory`, on Linux.

One process compiles the same small text 200 times, another compiles 200 different ones. The first
twenty load modules, kernels and the body. What the process takes on after them belongs to texts.
"""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import azee

STATM = Path("/proc/self/statm")
WARM = 20
"""After this number of texts everything is loaded."""
MOST_MB = 10.0
"""Largest growth after those texts, MB."""
COUNTS = (1, WARM, 50, 100, 150, 200)


def same(_: int) -> str:
    """Return the text that is repeated."""
    return different(0)


def different(n: int) -> str:
    """Return one of many small texts with different places, hand shapes and durations."""
    x, y = 0.1 - 0.01 * (n % 20), 0.02 * (n // 20) - 0.1
    text = (
        f"key {0.2 + 0.001 * n:.3f}\n"
        "    cstr\n"
        f"        place @I_TIP(s) point({x:.2f}, {y:.2f}, .35)\n"
        f"        orient 'dir !f_arm(w) 'along vec({x:.2f}, -1, {y:.2f})\n"
        f"        morph 'fist_close w {1 - 0.004 * (n % 100):.3f}\n"
    )
    return text if n % 4 else f"{text}:bien\n"


TEXTS: Mapping[str, Callable[[int], str]] = {"the same": same, "different": different}


def resident_mb(kind: str, counts: Sequence[int]) -> list[float]:
    """Compile texts of a kind; return the resident memory after each of the counts, MB."""
    out = []
    for n in range(counts[-1]):
        azee.compile(TEXTS[kind](n))
        if n + 1 in counts:
            pages = int(STATM.read_text(encoding="ascii").split()[1])
            out.append(pages * os.sysconf("SC_PAGE_SIZE") / 1e6)
    return out


def main(_: Sequence[str] = ()) -> None:
    """Print the resident memory of both processes, and its growth."""
    if not STATM.exists():
        print("memory: this benchmark reads /proc, which exists on Linux only")
        return
    print(f"{'MB after texts':<16}{''.join(f'{count:>8}' for count in COUNTS)}{'growth':>10}")
    for kind in TEXTS:
        spawning = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(max_workers=1, mp_context=spawning) as pool:
            found = pool.submit(resident_mb, kind, COUNTS).result()
        growth = found[-1] - found[COUNTS.index(WARM)]
        row = "".join(f"{mb:8.1f}" for mb in found)
        kept = "kept" if growth <= MOST_MB else "missed"
        print(f"{kind:<16}{row}{growth:10.1f}   goal: at most {MOST_MB:.0f}, {kept}", flush=True)
