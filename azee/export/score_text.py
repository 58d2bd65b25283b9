"""A score as a tree of lines for a terminal: times, names, rules and constraints."""

from __future__ import annotations

from collections.abc import Iterator

from azee.export.score_layout import Box, nested
from azee.score.score import Score


def tree(score: Score) -> str:
    """Return the nested score as text: a line per block with its times, a line per constraint."""
    return "\n".join(_lines(nested(score), "", "")) + "\n"


def _lines(box: Box, first: str, rest: str) -> Iterator[str]:
    """Yield the lines of a box: `first` precedes the line of its name, `rest` the lines below."""
    start, end = (f"{float(t):.2f}" for t in (box.interval.start, box.interval.end))
    yield f"{start:>7} – {end:<7} {first}{box.title}"
    inner = sorted(box.inner, key=lambda b: (b.interval.start, b.interval.end))
    indent = " " * 18
    for detail in box.details:
        yield f"{indent}{rest}  {detail}"
    for i, child in enumerate(inner):
        last = i == len(inner) - 1
        yield from _lines(
            child, rest + ("└─ " if last else "├─ "), rest + ("   " if last else "│  ")
        )
