"""How long a word takes to its clip in a running process: `benchmarks/run.py spelled-words`.

Words of ten letters, with the times of the model that ships. Each is spelled twice: when the
process has spelled nothing but a few words, and again, when it has spelled all of them. As in the
studio, postures that were solved are remembered; so are ways of fingers round fingers, always.
Times are those of the processor. `--text FILE` measures a whole text as well, as one score.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Sequence
from pathlib import Path

from azee.animation import default_solver
from azee.compilation import perform, score_of
from azee.lang.program import load
from azee.motion.timing.remembering import RememberingSolver
from azee.spelling.text import spelled
from azee.spelling.timing.schedule import schedule
from azee_grammar.source import Source
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.geometry import Side

FIRST = ("CAB", "DOG")
"""Spelled before anything is measured."""
WORDS = ("LOLLAPALOO", "KATHERINES", "PSYCHIATRY", "BLACKJUMPS", "WATERMELON", "GUITARISTS")
GOAL_S = 0.3


def spelled_s(text: str, rig: Rig, solver: RememberingSolver) -> tuple[float, float]:
    """Spell a text; return the seconds of the processor, and those that the movement lasts."""
    began = time.process_time()
    read = spelled(text, "asl")
    times = [
        [(t.hold_s, t.transition_s) for t in schedule("".join(word.letters))] for word in read.words
    ]
    score = score_of(load(Source("spelled", read.expression(times))), None, None)
    made = perform(score, rig, postures=solver)
    return time.process_time() - began, float(made.clip.times[-1])


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the time of each word, and of texts."""
    parser = argparse.ArgumentParser(prog="spelled-words", description=__doc__)
    parser.add_argument("words", nargs="*", default=WORDS)
    parser.add_argument("--text", type=Path, action="append", default=[], metavar="FILE.txt")
    parser.add_argument("--rig", default="signer")
    options = parser.parse_args(arguments)
    rig = load_rig(options.rig)
    for word in FIRST:
        spelled_s(word, rig, RememberingSolver(default_solver(rig, Side.RIGHT)))
    solver = RememberingSolver(default_solver(rig, Side.RIGHT))
    rounds = [[spelled_s(word, rig, solver)[0] for word in options.words] for _ in range(2)]
    print("word        first time   again")
    for word, first, again in zip(options.words, *rounds, strict=True):
        print(f"{word:<12}{first:>8.2f} s{again:>7.2f} s")
    print(f"{'median':<12}{'':>2}", end="")
    print("   ".join(f"{statistics.median(row):.2f} s" for row in rounds), f"goal {GOAL_S:g} s")
    for path in options.text:
        solver = RememberingSolver(default_solver(rig, Side.RIGHT))
        spent, lasts = spelled_s(path.read_text(encoding="utf-8"), rig, solver)
        print(f"{path.name}: {spent:.1f} s for {lasts:.0f} s of movement")


if __name__ == "__main__":
    main()
