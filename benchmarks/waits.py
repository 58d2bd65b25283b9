"""Measures what a user waits for, beside the goals: `benchmarks/run.py waits`.

Each row is the median of a few runs after one that warms caches, by the clock and in processor
time. Whole processes are started again each time. On a busy machine only processor time means much.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from azee.compilation import perform, score_of
from azee.formats import SUFFIXES
from azee.lang.program import load
from azee.score.score import Score
from azee_grammar.files import read_source
from azee_rig.load import load_rig
from azee_rig.rig import Rig

EXAMPLES = Path(__file__).parents[1] / "examples"
TREE = EXAMPLES / "tree" / "tree.azee"
SENTENCE = EXAMPLES / "person-aged-52" / "person-aged-52.azee"
RUNS = 7


@dataclass(frozen=True)
class Row:
    """Medians by the clock and of the processor, and the goal of the first; seconds."""

    what: str
    clock_s: float
    processor_s: float | None = None
    goal_s: float | None = None

    def __str__(self) -> str:
        times = (self.clock_s, self.processor_s, self.goal_s)
        return f"{self.what:<48}{''.join(f'{_time(s):>12}' for s in times)}".rstrip()


def _time(seconds: float | None) -> str:
    if seconds is None:
        return ""
    return f"{seconds:.2f} s" if seconds >= 1 else f"{seconds * 1000:.1f} ms"


def timed(what: str, action: Callable[[], object], goal_s: float | None = None) -> Row:
    """Return the row of an action; the time of processes that it starts and waits for counts."""
    runs = []
    for _ in range(RUNS + 1):
        spent, began = _processor_s(), time.perf_counter()
        action()
        runs.append((time.perf_counter() - began, _processor_s() - spent))
    clock, processor = zip(*runs[1:], strict=True)
    return Row(what, statistics.median(clock), statistics.median(processor), goal_s)


def _processor_s() -> float:
    """Processor time of this process so far, and of those it has waited for."""
    children = os.times()
    return time.process_time() + children.children_user + children.children_system


def told(what: str, measure: Callable[[], float], goal_s: float | None = None) -> Row:
    """Return the row of something that measures itself."""
    return Row(what, statistics.median([measure() for _ in range(RUNS + 1)][1:]), goal_s=goal_s)


def process(*arguments: str | Path) -> Callable[[], None]:
    """Return an action that runs `azee` in a process of its own."""
    command = [sys.executable, "-m", "azee", *map(str, arguments)]

    def action() -> None:
        subprocess.run(command, check=True, capture_output=True)

    return action


def score(source: Path) -> Score:
    """Return the score of an example, read and evaluated again."""
    return score_of(load(read_source(source)), None, None)


def rows(folder: Path) -> Iterator[Row]:
    """Measure everything, in the order of the table."""
    glb = folder / "sentence.glb"
    yield timed("azee --help, whole process", process("--help"), 0.3)
    yield timed("azee check SENTENCE, whole process", process("check", SENTENCE), 0.5)
    compiling = process("compile", SENTENCE, "-o", glb)
    yield timed("azee compile SENTENCE -o GLB, whole process", compiling, 2.0)
    rig = load_rig()
    scores = {"tree": score(TREE), "SENTENCE": score(SENTENCE)}
    goals = {"tree": 0.05, "SENTENCE": 0.5}
    for name, found in scores.items():
        yield told(f"{name}: solving alone", partial(solving, found, rig), goals[name])
    yield told("tree: why its thumb misses", partial(explaining, scores["tree"], rig))
    for name, found in scores.items():
        yield timed(f"{name}: score to clip, with solving", partial(perform, found, rig))
    yield timed("SENTENCE: text to score", partial(score, SENTENCE))
    made = perform(scores["SENTENCE"], rig)
    for suffix in SUFFIXES:
        path = folder / f"sentence{suffix}"
        yield timed(f"SENTENCE: writing {suffix}", partial(made.save, path))
    yield timed("loading the body", load_rig)


def solving(found: Score, rig: Rig) -> float:
    """Return the time that solving all key postures of a score takes."""
    return perform(found, rig).report.solve_s


def explaining(found: Score, rig: Rig) -> float:
    """Return the time for finding the reasons of a score's missed constraints."""
    report = perform(found, rig).report
    for result in report.constraints:
        assert result.met or result.reason or result.price
    return report.explain_s


def main(_: Sequence[str] = ()) -> None:
    """Print the table."""
    print(f"{'SENTENCE is ' + SENTENCE.stem:<48}{'clock':>12}{'processor':>12}{'goal':>12}")
    with tempfile.TemporaryDirectory() as folder:
        for row in rows(Path(folder)):
            print(row, flush=True)
