"""Measures memory: what texts leave behind, and what long clips take: `benchmarks/run.py memory`.

One process compiles the same small text 200 times, another compiles 200 different ones. The first
twenty load modules, kernels and the body. What the process takes on after them belongs to texts.

Further processes write or read a clip of 10,000 frames of the signer. What the most memory of each
is above that after a clip of ten frames belongs to the length of the clip. On Linux only.
"""

from __future__ import annotations

import multiprocessing
import os
import resource
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

import azee
from azee.clip.bvh import read_bvh
from azee.clip.clip import Clip
from azee.formats import CLIP_WRITERS
from azee_rig.load import load_rig

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


FRAMES, FEW = 10_000, 10
"""Of the long clip, and of the one after which everything is loaded."""
WAYS = (*(f"writing {suffix}" for suffix in CLIP_WRITERS), "reading .bvh")


def swaying(frames: int) -> Clip:
    """Return a clip of the signer in which every coordinate and twenty face units move."""
    rig = load_rig("signer")
    times = np.arange(frames) / 60
    names, units = rig.coordinates.names, rig.mesh.units[:20]
    q = rig.coordinates.idle + 0.1 * np.sin(times[:, None] * np.linspace(0.5, 3, len(names)))
    q = np.clip(q, rig.coordinates.lower, rig.coordinates.upper)
    weights = 0.5 + 0.5 * np.sin(times[:, None] * np.linspace(1, 2, len(units)))
    return Clip(times, q, tuple(units), weights)


def most_mb(way: str) -> tuple[float, float]:
    """Write or read a long clip; return the most memory it takes and its file's size, MB."""
    done, suffix = way.split()
    rig, clips = load_rig("signer"), (swaying(FEW), swaying(FRAMES))
    with tempfile.TemporaryDirectory() as folder:
        before = 0.0
        for n, clip in enumerate(clips):
            path = Path(folder) / f"{n}{suffix}"
            if done == "writing":
                before = _peak_mb() if n else before
                CLIP_WRITERS[suffix](clip, rig, path)
            else:
                _in_a_process(_write, clip, path)
                before = _peak_mb() if n else before
                read_bvh(path)
        return _peak_mb() - before, path.stat().st_size / 1e6


def _write(clip: Clip, path: Path) -> None:
    CLIP_WRITERS[path.suffix](clip, load_rig("signer"), path)


def _peak_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6


def _in_a_process(function: Callable[..., Any], *arguments: object) -> Any:
    """Call a function in a new process, whose memory is its own."""
    spawning = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(max_workers=1, mp_context=spawning) as pool:
        return pool.submit(function, *arguments).result()


def main(_: Sequence[str] = ()) -> None:
    """Print the resident memory of processes that compile, and the most of those with clips."""
    if not STATM.exists():
        print("memory: this benchmark reads /proc, which exists on Linux only")
        return
    print(f"{'MB after texts':<16}{''.join(f'{count:>8}' for count in COUNTS)}{'growth':>10}")
    for kind in TEXTS:
        found = _in_a_process(resident_mb, kind, COUNTS)
        growth = found[-1] - found[COUNTS.index(WARM)]
        row = "".join(f"{mb:8.1f}" for mb in found)
        kept = "kept" if growth <= MOST_MB else "missed"
        print(f"{kind:<16}{row}{growth:10.1f}   goal: at most {MOST_MB:.0f}, {kept}", flush=True)
    print(f"\n{f'{FRAMES:,} frames':<16}{'file MB':>10}{'memory MB':>12}")
    for way in WAYS:
        memory, size = _in_a_process(most_mb, way)
        print(f"{way:<16}{size:10.1f}{memory:12.1f}", flush=True)
