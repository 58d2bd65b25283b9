"""Measures how many postures tracks save, and how they grow: `python benchmarks/motion_keys.py`.

For sequences of real signs of two hands, 10 to 1,000 by default, it counts the postures that tracks
solve. It compares them with a key in every frame at the same tolerance, that is, one posture for
each frame with a task. It also prints the time of either part of the work per sign.
"""

from __future__ import annotations

import argparse
import time
from itertools import cycle, islice

import azee
from azee.compilation import perform
from azee.lang.program import load
from azee_grammar.source import Source
from azee_rig.load import load_rig

SIGNS = ("arbre", "bien", "pays", "chat", "cinéma", "personne", "Irak", "âge")


def text(signs: int) -> str:
    """Return a sequence of signs."""
    return "seq\n    list\n" + "".join(f"        :{n}\n" for n in islice(cycle(SIGNS), signs))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("signs", nargs="*", type=int, default=[10, 100, 1000])
    parser.add_argument("--fps", type=float, default=30.0, help="frames a second")
    options = parser.parse_args()
    rig = load_rig()
    azee.compile(text(1), rig.name, life=False)
    print("signs  clip s  keys  solved  every frame  times fewer  missed  text ms  motion ms/sign")
    for signs in options.signs:
        began = time.perf_counter()
        score = load(Source("signs", text(signs))).score(None)
        read = time.perf_counter()
        animation = perform(score, rig, fps=options.fps, life=False).animation
        ended = time.perf_counter()
        postures = animation.report.postures
        solved = sum(not p.reused for p in postures)
        frames = int(float(score.duration) * options.fps) + 1
        print(
            f"{signs:5d} {animation.clip.times[-1]:7.1f} {len(postures):5d} {solved:7d} "
            f"{frames:12d} {frames / solved:12.1f} "
            f"{sum(not c.met for c in animation.report.constraints):7d} "
            f"{1e3 * (read - began):8.0f} {1e3 * (ended - read) / signs:15.1f}"
        )


if __name__ == "__main__":
    main()
