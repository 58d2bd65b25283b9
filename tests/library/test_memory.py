"""The memory that a process keeps after many texts stays small."""

from __future__ import annotations

import gc
import multiprocessing
import tracemalloc
from concurrent.futures import ProcessPoolExecutor

import pytest

import azee
from benchmarks.memory import TEXTS

LOADING, MORE = 20, 30


def kept_mb(kind: str) -> float:
    """Compile texts of a kind; return the memory that is kept of `MORE` of them, MB.

    That is the smaller of two figures: a table of Python's own that happens to grow while texts are
    compiled, such as that of interned names, grows once.
    """
    make = TEXTS[kind]
    for n in range(LOADING):
        azee.compile(make(n))
    kept = []
    for first in (LOADING, LOADING + MORE):
        gc.collect()
        tracemalloc.start()
        for n in range(first, first + MORE):
            azee.compile(make(n))
        gc.collect()
        kept.append(tracemalloc.get_traced_memory()[0] / 1e6)
        tracemalloc.stop()
    return min(kept)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "most_mb"), [("the same", 2.0), ("different", 6.0)])
def test_little_stays_of_texts(kind: str, most_mb: float) -> None:
    """A body that is loaded anew by each call would keep 0.8 MB a call."""
    spawning = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(max_workers=1, mp_context=spawning) as pool:
        assert pool.submit(kept_mb, kind).result() < most_mb
