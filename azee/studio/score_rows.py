"""A score as rows for a time line: every block with its times and its place in the text."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from azee.export.score_layout import title
from azee.score.score import Blank, Group, Hold, Key, Recorded, Score
from azee_solver.constraint import Origin
from azee_solver.notation import constraint_text

MOST_ROWS = 20_000
"""Of one score; a page shows no more."""


def score_rows(score: Score, file: str) -> list[dict[str, Any]]:
    """Return all blocks of a score, outer before inner, in the order of the score.

    Each has `path` (the names that lead to it), `parent` (the row's index, -1 for the outermost),
    `title`, `rule`, `kind`, `start_s` and `end_s` on the score's time line, `place` (line and
    column, from 1, in `file`; none for what a library wrote), `constraints` (texts with places).

    Args: file: name of the source that the page shows.
    """
    rows: list[dict[str, Any]] = []
    for row in _rows(score, "", (), Fraction(0), -1, file, rows):
        rows.append(row)
        if len(rows) >= MOST_ROWS:
            break
    return rows


def _rows(
    score: Score,
    name: str,
    path: tuple[str, ...],
    start: Fraction,
    parent: int,
    file: str,
    rows: list[dict[str, Any]],
) -> Iterator[dict[str, Any]]:
    index = len(rows)
    yield {
        "path": path,
        "parent": parent,
        "title": title(name, score),
        "rule": score.calls[0].rule if score.calls else None,
        "kind": _kind(score),
        "start_s": _seconds(start),
        "end_s": _seconds(start + score.duration),
        "place": next((p for call in score.calls if (p := _place(call.origin, file))), None),
        "constraints": [
            {"text": constraint_text(c), "place": _place(c.origin, file)}
            for c in (score.constraints if isinstance(score, Key) else ())
        ],
    }
    for block in score.blocks if isinstance(score, Group) else ():
        inside = start + block.interval_in_parent.start
        inner = (*path, block.name)
        yield from _rows(block.score, block.name, inner, inside, index, file, rows)


def _kind(score: Score) -> str:
    match score:
        case Key():
            return "key"
        case Hold():
            return "hold"
        case Blank():
            return "blank"
        case Recorded():
            return "recorded"
        case Group(arrangement=arrangement):
            return arrangement.value


def _place(origin: Origin | None, file: str) -> tuple[int, int] | None:
    return (origin.line, origin.column) if origin is not None and origin.file == file else None


def _seconds(time: Fraction) -> float:
    return round(float(time), 6)
