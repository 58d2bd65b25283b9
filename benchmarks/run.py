"""The benchmarks, all or those that are named: `make bench`.

`python benchmarks/run.py [waits] [language] [motion] [prompt] [solver OPTIONS…]`. What follows
`solver` goes to it; `python benchmarks/run.py solver --help` lists it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).parents[1]
MODULES = {
    "waits": "benchmarks.waits",
    "language": "benchmarks.language_growth",
    "motion": "benchmarks.motion_length",
    "prompt": "benchmarks.prompt",
    "solver": "benchmarks.solver_bench",
}


def main(arguments: Sequence[str]) -> None:
    """Run the named benchmarks, one after the other."""
    names = list(arguments)
    options: list[str] = []
    if "solver" in names:
        at = names.index("solver") + 1
        names, options = names[:at], names[at:]
    unknown = [name for name in names if name not in MODULES]
    if unknown:
        known = ", ".join(MODULES)
        sys.exit(f"no benchmark is called {', '.join(unknown)}; there are: {known}")
    for name in names or MODULES:
        run: Callable[[Sequence[str]], None] = import_module(MODULES[name]).main
        run(options if name == "solver" else [])


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    main(sys.argv[1:])
