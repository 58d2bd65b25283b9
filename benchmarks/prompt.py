"""Measures how long the prompt takes to answer: reading, evaluating, drawing and solving.

Each row is the median of a few answers of one warm session. The last solution is forgotten in
between, so that every answer solves again. A user notices completion and reloading while typing.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from functools import partial

from azee.assist.completion import completions
from azee.repl import commands
from azee.repl.performer import Performer
from azee.repl.repl import Repl
from azee.repl.screen import Screen
from azee.repl.session import Session

RUNS = 7
SENTENCE_S = 0.3
"""The bound for an expression of the size of a sentence, with its solution."""
SENTENCES = (
    ":info-about(:cinéma, :bien)",
    ":info-about(:personne, :mignon)",
    ":info-about(:pays, :info-about(:arbre, :bien))",
    "not-but(tree(), wardrobe())",
)
TYPED = ("arb", ":info-about 'to", "key 1 (place @I_", "morph 'sm")


def main(_: Sequence[str] = ()) -> None:
    """Print the table."""
    lines: list[str] = []
    screen = Screen(lines.append, lines.append, colour=True, fixed_columns=100)
    repl = Repl(Session(), Performer("signer", "right"), screen, interactive=False, solving=True)
    print(f"{'':<52}{'clock':>12}{'processor':>12}{'goal':>12}")
    for text in SENTENCES:
        row(text, partial(answer, repl, text), SENTENCE_S)
    row("an expression that is not solved", partial(answer, repl, "vsum ^up ^fwd"))
    for text in TYPED:
        knowledge = repl.session.knowledge
        row(f"completing {text}", partial(completions, text, len(text), knowledge))
    row("looking whether files have changed", repl.refresh)


def answer(repl: Repl, text: str) -> None:
    """Let the prompt answer as if it had not solved the expression before."""
    repl.performer.change(hand="right")
    if not commands.answer(repl, text):
        raise SystemExit(f"{text} is at fault")


def row(what: str, action: Callable[[], object], goal_s: float | None = None) -> None:
    """Print a row: medians by the clock and in processor time."""
    clock, processor = [], []
    for _ in range(RUNS + 1):
        began, spent = time.perf_counter(), time.process_time()
        action()
        clock.append(time.perf_counter() - began)
        processor.append(time.process_time() - spent)
    medians = [statistics.median(times[1:]) for times in (clock, processor)]
    goal = "" if goal_s is None else f"{goal_s * 1000:.0f} ms"
    times = "".join(f"{median * 1000:>9.1f} ms" for median in medians)
    print(f"{what:<52}{times}{goal:>12}", flush=True)


if __name__ == "__main__":
    main()
