"""Runs all benchmarks, or those that are named: `make bench`.

`python benchmarks/run.py [NAME…] [OPTIONS…]`. Options belong to the last name. `python
benchmarks/run.py solver --help` lists those of `solver`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from itertools import takewhile
from pathlib import Path

ROOT = Path(__file__).parents[1]
MODULES = {
    "waits": "benchmarks.waits",
    "first-run": "benchmarks.first_run",
    "language": "benchmarks.language_growth",
    "signs": "benchmarks.signs",
    "signs-db": "benchmarks.sign_database",
    "bit-rates": "benchmarks.bit_rates",
    "motion": "benchmarks.motion_length",
    "prompt": "benchmarks.prompt",
    "frames": "benchmarks.frames",
    "films": "benchmarks.films",
    "threads": "benchmarks.threads",
    "memory": "benchmarks.memory",
    "continuity": "benchmarks.continuity",
    "posing": "benchmarks.posing",
    "penetration": "benchmarks.penetration",
    "spelled-pairs": "benchmarks.spelled_pairs",
    "spelled-words": "benchmarks.spelled_words",
    "letters": "benchmarks.letters_on_bodies",
    "likeness": "benchmarks.likeness",
    "lexicon": "benchmarks.lexicon",
    "formats": "benchmarks.formats",
    "batch": "benchmarks.batch",
    "capture": "benchmarks.capture",
    "studio": "benchmarks.studio",
    "solver": "benchmarks.solver_bench",
}


def main(arguments: Sequence[str]) -> None:
    """Run the named benchmarks, one after the other."""
    names = list(takewhile(MODULES.__contains__, arguments))
    options = list(arguments[len(names) :])
    if not names and options and options[0] in ("-h", "--help"):
        print(f"{(__doc__ or '').strip()}\n\nThere are: {', '.join(MODULES)}")
        return
    if options and not names:
        sys.exit(f"no benchmark is called {options[0]}; there are: {', '.join(MODULES)}")
    for name in names or MODULES:
        run: Callable[[Sequence[str]], object] = import_module(MODULES[name]).main
        run(options if names and name == names[-1] else [])


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    main(sys.argv[1:])
