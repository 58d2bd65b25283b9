"""The outcome of solving in lines: a summary, and every constraint in a table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from azee.quality.outcome import (
    amount,
    eases,
    misses,
    outcome,
    self_contact,
    shortfall,
    strains,
)
from azee.repl.ink import Ink, Line, cut, width
from azee.wording import counted
from azee_solver.outcome import Outcome

if TYPE_CHECKING:
    from azee.quality.constraint_results import ConstraintResult
    from azee.quality.motion_report import MotionReport


def summary(report: MotionReport, took_s: float) -> Iterator[Line]:
    """Tell how long solving took, and name the constraints that are out of tolerance."""
    missed = misses(report)
    ink = Ink.BAD if report.missed else Ink.GOOD if report.constraints else Ink.FAINT
    keys = counted(len(report.postures), "key posture")
    yield ((Ink.FAINT, f"solved in {took_s:.2f} s: {keys}, "), (ink, outcome(report)))
    for result in (*missed, *eases(report)):
        where = "/".join(result.path)
        yield (
            (
                Ink.BAD if result.missed else Ink.FAINT,
                f"  {where + ': ' if where else ''}{result.text}",
            ),
            (Ink.PLAIN, f" {shortfall(result)}"),
        )
    for line in self_contact(report):
        yield ((Ink.BAD, f"  {line}"),)
    for strain in strains(report):
        yield ((Ink.FAINT, f"  {strain}"),)


def table(report: MotionReport, columns: int) -> Iterator[Line]:
    """Return a table of constraints in order of time: when, in which block, residual, tolerance."""
    rows = sorted(report.constraints, key=lambda r: (r.start_s, r.end_s, r.path))
    if not rows:
        return
    cells = [_cells(result) for result in rows]
    widths = [max(width(row[i]) for row in (_HEAD, *cells)) for i in range(len(_HEAD))]
    room = columns - widths[0] - widths[3] - widths[4] - 4 * 2 - 2
    widths[1] = min(widths[1], max(8, room // 3))
    widths[2] = min(widths[2], max(12, room - widths[1]))
    yield ((Ink.FAINT, _row(_HEAD, widths)),)
    for result, row in zip(rows, cells, strict=True):
        mark = _MARKS[result.outcome]
        yield ((Ink.PLAIN, _row(row, widths)), mark)
        why = result.reason or (f"it would take {result.price}" if not result.met else "")
        if why:
            yield ((mark[0], f"{' ' * (widths[0] + 2)}{why}"),)


_MARKS: dict[Outcome, tuple[Ink, str]] = {
    Outcome.MET: (Ink.GOOD, " ✓"),
    Outcome.EASED: (Ink.FAINT, " ≈"),
    Outcome.MISSED: (Ink.BAD, " ✗"),
}
_HEAD = ("seconds", "block", "constraint", "off by", "of")


def _cells(result: ConstraintResult) -> tuple[str, ...]:
    return (
        f"{result.start_s:.2f}–{result.end_s:.2f}",
        "/".join(result.path) or result.rule or "",
        result.text,
        amount(result.residual, result.unit),
        amount(result.tolerance, result.unit),
    )


def _row(cells: tuple[str, ...], widths: list[int]) -> str:
    shown = [cut(cell, size) for cell, size in zip(cells, widths, strict=True)]
    left = "  ".join(
        text + " " * (size - width(text)) for text, size in zip(shown[:3], widths[:3], strict=True)
    )
    right = "  ".join(
        " " * (size - width(text)) + text for text, size in zip(shown[3:], widths[3:], strict=True)
    )
    return f"{left}  {right}"
