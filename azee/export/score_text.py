"""A score as a tree of lines for a terminal: times, names, rules and constraints."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from textwrap import TextWrapper

from azee.export.score_layout import Box, nested
from azee.score.score import Key, Score
from azee_solver.constraint import Morph
from azee_solver.notation import constraint_text

FOLDED = 4
"""So many morphs in a row, such as those of a hand shape, share lines."""
_LINES = TextWrapper(76, initial_indent="morph ", subsequent_indent=" " * 6)


def tree(score: Score) -> str:
    """Return the nested score as text: a line per block with its times, a line per constraint."""
    return "\n".join(_lines(nested(score), "", "")) + "\n"


def _lines(box: Box, first: str, rest: str) -> Iterator[str]:
    """Yield the lines of a box: `first` precedes the line of its name, `rest` the lines below."""
    start, end = (f"{float(t):.2f}" for t in (box.interval.start, box.interval.end))
    yield f"{start:>7} – {end:<7} {first}{box.title}"
    inner = sorted(box.inner, key=lambda b: (b.interval.start, b.interval.end))
    indent = " " * 18
    for detail in _details(box):
        yield f"{indent}{rest}  {detail}"
    for i, child in enumerate(inner):
        last = i == len(inner) - 1
        yield from _lines(
            child, rest + ("└─ " if last else "├─ "), rest + ("   " if last else "│  ")
        )


def _details(box: Box) -> Iterator[str]:
    """Yield the constraints of a box, a line each; many morphs in a row share lines."""
    if not isinstance(box.score, Key):
        yield from box.details
        return
    for is_morph, group in groupby(box.score.constraints, lambda c: isinstance(c, Morph)):
        constraints = list(group)
        if is_morph and len(constraints) >= FOLDED:
            names = (constraint_text(c).removeprefix("morph ") for c in constraints)
            # A blank that is no place to break keeps each morph whole.
            whole = ", ".join(name.replace(" ", "\0") for name in names)
            yield from (line.replace("\0", " ") for line in _LINES.wrap(whole))
        else:
            yield from map(constraint_text, constraints)
