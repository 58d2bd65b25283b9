"""How well a score was met, in a phrase; the same words in the command, prompt and notebook."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from azee.wording import counted

if TYPE_CHECKING:
    from azee.quality.motion_report import ConstraintResult, MotionReport


def outcome(report: MotionReport) -> str:
    """Return `all 16 constraints are met`, `1 of 16 constraints is out of tolerance`."""
    everything, missed = len(report.constraints), len(misses(report))
    if not everything:
        return "no constraint to meet"
    if not missed:
        return "1 constraint is met" if everything == 1 else f"all {everything} constraints are met"
    some = counted(everything, "constraint")
    if everything > 1:
        some = f"{missed} of {some}"
    return f"{some} {'is' if missed == 1 else 'are'} out of tolerance"


def longer(report: MotionReport) -> list[str]:
    """Return `2 transitions are longer than the score says, by 0.31 s in all; …`, or nothing."""
    many = len(report.stretched)
    if not many:
        return []
    are, in_all = ("is", "") if many == 1 else ("are", " in all")
    longer = f"{counted(many, 'transition')} {are} longer than the score says"
    return [f"{longer}, by {report.extra_s:.2f} s{in_all}; --timing exact keeps its times"]


def misses(report: MotionReport) -> list[ConstraintResult]:
    """Return the constraints that are out of tolerance."""
    return [result for result in report.constraints if not result.met]


def shortfall(result: ConstraintResult) -> str:
    """Say of a constraint that is not met by how much and why."""
    return f"off by {amount(result.residual, result.unit)}, {result.reason}"


def amount(residual: float | None, unit: str) -> str:
    """Return metres or radians as people measure them: millimetres or degrees."""
    if residual is None:
        return "what cannot be measured"
    return f"{residual * 1000:.1f} mm" if unit == "m" else f"{math.degrees(residual):.1f}°"
