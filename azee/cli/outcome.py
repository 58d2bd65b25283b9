"""What came of a compilation, in a few lines: how long, how well, and which constraints missed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from azee.compilation import Compilation
    from azee.quality.motion_report import ConstraintResult


def outcome(made: Compilation, written: Sequence[Path]) -> str:
    """Return the lines: length, key postures, misses with their reasons, files."""
    report = made.report
    length = f"{report.duration_s:.2f} s at {report.fps:g} frames a second"
    lines = [
        f"{length}, {len(report.postures)} key postures, {len(report.constraints)} constraints",
        *_iterations(made),
        *_misses([result for result in report.constraints if not result.met]),
        *(f"wrote {path} ({size_of(path)})" for path in written),
    ]
    if not written:
        lines.append("nothing written: name files with -o")
    return "\n".join(lines)


def _iterations(made: Compilation) -> list[str]:
    """Say what the two-level method took, counted as the paper does."""
    postures = (posture for posture in made.report.postures if not posture.reused)
    counts = [p.iterations for posture in postures for p in posture.report.problems]
    took = [count for count in counts if count is not None]
    if not took:
        return []
    more = sum(count > 1 for count in took)
    hard = f"{more} took more than one, the hardest {max(took)}"
    return [f"{len(took)} IK problems in {sum(took)} iterations; {hard}"]


def _misses(missed: Sequence[ConstraintResult]) -> list[str]:
    if not missed:
        return ["all constraints are met"]
    head = "1 constraint is" if len(missed) == 1 else f"{len(missed)} constraints are"
    return [f"{head} out of tolerance:", *map(_miss, missed)]


def _miss(result: ConstraintResult) -> str:
    where = "/".join(result.path)
    by = amount(result.residual, result.unit)
    return (
        f"  {result.start_s:.2f}–{result.end_s:.2f} s {where + ': ' if where else ''}"
        f"{result.subject} {result.target}: off by {by}, {result.reason}"
    )


def amount(residual: float | None, unit: str) -> str:
    """Return a residual as people measure it."""
    if residual is None:
        return "what cannot be measured"
    return f"{residual * 1000:.1f} mm" if unit == "m" else f"{math.degrees(residual):.1f}°"


def size_of(path: Path) -> str:
    """Size of a file in kB or MB, for people."""
    size = path.stat().st_size
    return f"{size / 1e6:.1f} MB" if size >= 1e6 else f"{max(1, round(size / 1e3))} kB"
