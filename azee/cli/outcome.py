"""What came of a compilation, in a few lines: how long, how well, and which constraints missed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from azee.cli.outputs import size_of
from azee.quality.outcome import eases, longer, misses, outcome, self_contact, shortfall, strains
from azee.wording import counted

if TYPE_CHECKING:
    from azee.compilation import Compilation
    from azee.lang.shortcuts import Taken
    from azee.quality.constraint_results import ConstraintResult


def outcome_lines(made: Compilation, written: Sequence[Path]) -> str:
    """Return the lines: length, key postures, longer transitions, shortfalls, strains, files."""
    report = made.report
    length = f"{report.duration_s:.2f} s at {report.fps:g} frames a second"
    fallen_short = [*misses(report), *eases(report)]
    lines = [
        f"{length}, {counted(len(report.postures), 'key posture')}",
        *longer(report),
        *map(_shortcut, made.shortcuts),
        *_iterations(made),
        outcome(report) + (":" if fallen_short or report.self_contact else ""),
        *map(_shortfall, fallen_short),
        *(f"  {line}" for line in self_contact(report)),
        *strains(report),
        *([made.provenance.text] if made.provenance and made.provenance.applications else ()),
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
    return [f"{counted(len(took), 'IK problem')} in {counted(sum(took), 'iteration')}; {hard}"]


def _shortcut(taken: Taken) -> str:
    return f"{taken.span}: {taken.recording} is played for {taken.text}"


def _shortfall(result: ConstraintResult) -> str:
    where = "/".join(result.path)
    when = f"{result.start_s:.2f}–{result.end_s:.2f} s"
    return f"  {when} {where + ': ' if where else ''}{result.text}: {shortfall(result)}"
