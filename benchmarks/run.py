"""How long things take that a user waits for, with the goals beside; `make bench`.

Each row is the median of a few runs after one that warms caches; whole processes are started
anew each time. Run it on a machine that does nothing else.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
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
    """A median and what it should be, seconds."""

    what: str
    seconds: float
    goal_s: float | None = None

    def __str__(self) -> str:
        goal = "" if self.goal_s is None else f"{_time(self.goal_s):>12}"
        return f"{self.what:<58}{_time(self.seconds):>12}{goal}"


def _time(seconds: float) -> str:
    return f"{seconds:.2f} s" if seconds >= 1 else f"{seconds * 1000:.1f} ms"


def median(action: Callable[[], object]) -> float:
    """Median of what an action takes."""

    def timed() -> float:
        began = time.perf_counter()
        action()
        return time.perf_counter() - began

    return median_of(timed)


def median_of(measure: Callable[[], float]) -> float:
    """Median of what is measured."""
    return statistics.median([measure() for _ in range(RUNS + 1)][1:])


def process(*arguments: str | Path) -> Callable[[], None]:
    """Return an action that runs `azee` in a process of its own."""
    command = [sys.executable, "-m", "azee", *map(str, arguments)]

    def action() -> None:
        subprocess.run(command, check=True, capture_output=True)

    return action


def score(source: Path) -> Score:
    """Return the score of an example, read and evaluated anew."""
    return score_of(load(read_source(source)), None, None)


def rows(folder: Path) -> Iterator[Row]:
    """Measure everything, in the order of the table."""
    glb = folder / "sentence.glb"
    yield Row("azee --help, whole process", median(process("--help")), 0.3)
    yield Row("azee check SENTENCE, whole process", median(process("check", SENTENCE)), 0.5)
    yield Row(
        "azee compile SENTENCE -o GLB, whole process",
        median(process("compile", SENTENCE, "-o", glb)),
        2.0,
    )
    rig = load_rig()
    scores = {"tree": score(TREE), "SENTENCE": score(SENTENCE)}
    goals = {"tree": 0.05, "SENTENCE": 0.5}
    for name, found in scores.items():
        yield Row(f"{name}: solving alone", median_of(partial(solving, found, rig)), goals[name])
    for name, found in scores.items():
        yield Row(f"{name}: score to clip, with solving", median(partial(perform, found, rig)))
    yield Row("SENTENCE: text to score", median(partial(score, SENTENCE)))
    made = perform(scores["SENTENCE"], rig)
    for suffix in SUFFIXES:
        path = folder / f"sentence{suffix}"
        yield Row(f"SENTENCE: writing {suffix}", median(partial(made.save, path)))
    yield Row("loading the body", median(load_rig))


def solving(found: Score, rig: Rig) -> float:
    """Return the time that solving all key postures of a score takes."""
    return perform(found, rig).report.solve_s


def main() -> None:
    """Print the table."""
    print(f"{'SENTENCE is ' + SENTENCE.stem:<58}{'median':>12}{'goal':>12}")
    with tempfile.TemporaryDirectory() as folder:
        for row in rows(Path(folder)):
            print(row, flush=True)


if __name__ == "__main__":
    main()
