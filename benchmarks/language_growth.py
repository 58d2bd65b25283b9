"""Measures how reading and evaluating grow, and what hostile texts cost; part of `make bench`.

Each row is a process of its own: processor seconds for parsing and for checking (names, evaluation,
timing), the largest memory of the process, and the diagnostic that ended it. Runs on Linux and
macOS.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from importlib import import_module
from pathlib import Path

from azee.lang.program import load
from azee_grammar.parser import parse
from azee_grammar.source import Source

TEXTS = Path(__file__).parents[1] / "tests" / "lang"
COUNTS = (10, 100, 1_000, 10_000)
DEPTH = 100


def texts() -> Iterator[tuple[str, str]]:
    """Names and texts, in the order of the table; the tests use the same."""
    sys.path.insert(0, str(TEXTS))
    hostile = import_module("hostile_texts")
    for count in COUNTS:
        yield f"seq of {count:,} :info-about", hostile.sequence(count)
    yield f":info-about {DEPTH} deep", hostile.nested(DEPTH)
    for case in hostile.HOSTILE:
        yield case.name, case.text


def measure(text: str) -> dict[str, object]:
    """Return the cost of one text in this process."""
    from resource import RUSAGE_SELF, getrusage

    source = Source("text.azee", text)
    load(Source("warm.azee", ":info-about(:bien, :chat)\n")).check()
    started = time.process_time()
    parse(source)
    parsed = time.process_time()
    diagnostics = load(source).check()
    checked = time.process_time()
    kilobyte = 1024 if sys.platform != "darwin" else 1
    return {
        "parse_s": parsed - started,
        # `load` parses once more.
        "check_s": max(0.0, checked - parsed - (parsed - started)),
        "memory_mb": getrusage(RUSAGE_SELF).ru_maxrss * kilobyte / 1e6,
        "codes": [diagnostic.code for diagnostic in diagnostics],
    }


def main(_: Sequence[str] = ()) -> None:
    """Print the table."""
    print(f"{'text':<42}{'parse':>9}{'check':>9}{'memory':>9}  diagnostic")
    for i, (name, _) in enumerate(texts()):
        done = subprocess.run(
            [sys.executable, __file__, str(i)], check=True, capture_output=True, text=True
        )
        row = json.loads(done.stdout)
        times = f"{row['parse_s']:>7.2f} s{row['check_s']:>7.2f} s{row['memory_mb']:>6.0f} MB"
        print(f"{name:<42}{times}  {', '.join(row['codes'])}".rstrip(), flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(measure(list(texts())[int(sys.argv[1])][1])))
    else:
        main()
