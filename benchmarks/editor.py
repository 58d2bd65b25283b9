"""Measures how long an editor waits for messages after a key stroke; part of `make bench`.

A text of 1,000 lines, half of them rules, is open in a real server in a process of its own. The
time runs from the change in the editor to the arrival of its messages, and includes the pause in
which the server waits for further keys. The goal is 100 ms.
"""

from __future__ import annotations

import asyncio
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

RUNS = 15
GOAL_S = 0.1

RULE = """\
def rule-{n}
    'meaning "a rule of the benchmark"
    azop
        'pt
        ^Rssp
        sync
            'SIG
            :info-about
                'topic :personne
                'info :âge
            'GAZE key(.2, lookat(^pt))
            'start 'SIG:start:-.09
:rule-{n}
"""
TEXT = "".join(RULE.format(n=n) for n in range(77))
EDITS = {
    "an utterance is changed": (":rule-5\n", ":personne\n"),
    "an utterance is broken": (":rule-5\n", ":rule-5(\n"),
    "a rule is changed": ("def rule-5\n    'meaning \"a", "def rule-5\n    'meaning \"another"),
    "a rule is broken": ("^Rssp", "^Rsp"),
}


async def waits() -> dict[str, list[float]]:
    """Return the seconds from change to messages, by the kind of change; undo each change."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "lsp"))
    editor: Any = import_module("editor")
    found: dict[str, list[float]] = {name: [] for name in EDITS}
    with tempfile.TemporaryDirectory() as folder:
        async with editor.editor(Path(folder)) as one:
            began = time.perf_counter()
            await one.open("a.azee", TEXT)
            found = {"the text is opened": [time.perf_counter() - began], **found}
            for _ in range(RUNS):
                for name, (old, new) in EDITS.items():
                    for pair in ((old, new), (new, old)):
                        began = time.perf_counter()
                        await one.replace("a.azee", *pair)
                        found[name].append(time.perf_counter() - began)
    return found


def rows() -> Iterator[str]:
    """Yield the lines of the table."""
    yield f"{f'{len(TEXT.splitlines())} lines':<30}{'median':>10}{'longest':>10}"
    for name, seconds in asyncio.run(waits()).items():
        middle, most = statistics.median(seconds), max(seconds)
        yield f"{name:<30}{middle * 1e3:>7.0f} ms{most * 1e3:>7.0f} ms"
    yield f"{'goal':<30}{GOAL_S * 1e3:>7.0f} ms"


if __name__ == "__main__":
    print("\n".join(rows()))
