"""How well a score was met, in a phrase; the same words in the command, prompt and notebook."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from azee.wording import counted
from azee_solver.outcome import Outcome

if TYPE_CHECKING:
    from azee.quality.constraint_results import ConstraintResult
    from azee.quality.measures import Penetration
    from azee.quality.motion_report import MotionReport
    from azee_solver.outcome import Strain


def outcome(report: MotionReport) -> str:
    """Return `all 16 constraints are met`, `1 of 16 constraints is out of tolerance`.

    Fingers inside each other are added: `…, a finger is inside another`.
    """
    inside = len({p.pair for p in report.self_contact})
    added = ["", ", a finger is inside another"]
    return _constraints(report) + (
        added[inside] if inside < 2 else f", {inside} pairs of fingers are inside each other"
    )


def _constraints(report: MotionReport) -> str:
    everything, missed, eased = len(report.constraints), len(misses(report)), len(eases(report))
    if not everything:
        return "no constraint to meet"
    if not missed and not eased:
        return "1 constraint is met" if everything == 1 else f"all {everything} constraints are met"
    parts = [(missed, "out of tolerance"), (eased, "eased for comfort")]
    some = counted(everything, "constraint")
    said: list[str] = []
    for count, what in parts:
        if count:
            subject = str(count) if said else f"{count} of {some}" if everything > 1 else some
            said.append(f"{subject} {'is' if count == 1 else 'are'} {what}")
    return ", ".join(said)


def longer(report: MotionReport) -> list[str]:
    """Return `2 transitions are longer than the score says, by 0.31 s in all; …`, or nothing."""
    many = len(report.stretched)
    if not many:
        return []
    are, in_all = ("is", "") if many == 1 else ("are", " in all")
    longer = f"{counted(many, 'transition')} {are} longer than the score says"
    return [f"{longer}, by {report.extra_s:.2f} s{in_all}; --timing exact keeps its times"]


def self_contact(report: MotionReport) -> list[str]:
    """Say which fingers are inside each other, how deep and when: a line for each pair."""
    worst: dict[tuple[str, str], Penetration] = {}
    for found in report.self_contact:
        known = worst.get(found.pair)
        if known is None or known.depth_m < found.depth_m:
            worst[found.pair] = found
    return [
        f"{p.start_s:.2f}–{p.end_s:.2f} s: {p.pair[0]} and {p.pair[1]} are "
        f"{amount(p.depth_m, 'm')} inside each other"
        for p in worst.values()
    ]


def misses(report: MotionReport) -> list[ConstraintResult]:
    """Return the constraints that are out of tolerance."""
    return [result for result in report.constraints if result.missed]


def eases(report: MotionReport) -> list[ConstraintResult]:
    """Return the constraints that are eased for comfort, inside 1 cm and 5°."""
    return [result for result in report.constraints if result.outcome is Outcome.EASED]


def shortfall(result: ConstraintResult) -> str:
    """Say of a constraint that is not met by how much and why."""
    off = f"off by {amount(result.residual, result.unit)}"
    if result.outcome is Outcome.EASED:
        return f"{off} for comfort: meeting it would take {result.price}"
    return f"{off}, {result.reason}"


def strains(report: MotionReport) -> list[str]:
    """Say where the body is beyond the comfortable, and for what: a line for each such purpose."""
    worst: dict[tuple[str, ...], tuple[float, Strain]] = {}
    for time_s, strain in report.strains:
        known = worst.get(strain.subjects)
        if known is None or known[1].price < strain.price:
            worst[strain.subjects] = time_s, strain
    return [f"{time_s:.2f} s: {strain}" for time_s, strain in worst.values()]


def amount(residual: float | None, unit: str) -> str:
    """Return metres or radians as people measure them: millimetres or degrees."""
    if residual is None:
        return "what cannot be measured"
    return f"{residual * 1000:.1f} mm" if unit == "m" else f"{math.degrees(residual):.1f}°"
