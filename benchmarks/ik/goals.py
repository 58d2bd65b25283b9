"""Goals of the comparison: each figure beside its bound, kept or missed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.ik.comparison import Row, behind_best, of_solvable
from benchmarks.ik.problems import TIGHT

FULL, APART, LAID_OUT = "ours, everything on", "ours, no collision", "ours, descents alone"
PLAIN, FULL_OBJECTIVE = "LM kernel", "LM kernel, full objective"
ITASC = "Blender iTaSC"
CLEAR_M = 3e-3
"""Overlap of capsules that is tolerated."""
REACHABLE = ("place", "place, 1 orientation", "4 orientations", "place, 2 at stops")


@dataclass(frozen=True, slots=True)
class Goal:
    """A figure and the bounds that it should keep, if there are any."""

    what: str
    value: float
    unit: str = ""
    at_least: float | None = None
    at_most: float | None = None

    @property
    def kept(self) -> bool | None:
        """Whether the figure keeps its bounds; none if it has none."""
        if self.at_least is None and self.at_most is None:
            return None
        low = -float("inf") if self.at_least is None else self.at_least
        high = float("inf") if self.at_most is None else self.at_most
        return low <= self.value <= high

    def as_json(self) -> dict[str, object]:
        return {
            "what": self.what,
            "value": self.value,
            "unit": self.unit,
            "at_least": self.at_least,
            "at_most": self.at_most,
            "kept": self.kept,
        }


def goals_of(classes: Sequence[Sequence[Row]]) -> list[Goal]:
    """Return the figures that follow from the rows of all classes, one sequence per class."""
    goals: list[Goal] = []
    for rows in classes:
        by_method = {row.method: row for row in rows}
        body, kind = rows[0].body, rows[0].kind
        where = f"{body}, {kind}"
        if kind in REACHABLE:
            goals += [_solved(by_method[name], where) for name in (FULL, APART)]
        if kind == "two-handed contact":
            shares = of_solvable(rows)
            goals += [
                Goal(f"{where}: of what any method solves, {m}", 100 * a / b, "%", at_least=98)
                for m, (a, b) in shares.items()
                if m in (FULL, APART) and b
            ]
        if kind in ("two-handed contact", "tree") and by_method[FULL].overlaps_m:
            met, of = of_solvable(rows, CLEAR_M)[FULL]
            if of:
                what = f"{where}: of what any method solves outside the body, {FULL}"
                goals.append(Goal(what, 100 * met / of, "%", at_least=98))
        if kind == "unreachable":
            for m, clear_m in ((APART, math.inf), (FULL, CLEAR_M)):
                outside = " outside the body" if m == FULL else ""
                what = f"{where}: behind the best{outside}, {m}"
                goals.append(Goal(what, 1000 * behind_best(rows, clear_m)[m], "mm", at_most=0.5))
        excess = max(by_method[name].excess_rad for name in (FULL, APART))
        goals.append(Goal(f"{where}: beyond limits, ours", excess, "rad", at_most=0.0))
        if ITASC in by_method:
            ratio = _over(by_method[ITASC], by_method[APART])
            bound = 10.0 if kind == "tree" else None
            goals.append(Goal(f"{where}: iTaSC / ours", ratio, "×", at_least=bound))
        if kind != "unreachable":
            goals += _ratios(by_method, where, collisions=bool(by_method[FULL].overlaps_m))
    return goals


def _solved(row: Row, where: str) -> Goal:
    share = 100 * row.met(TIGHT) / len(row.residuals)
    return Goal(f"{where}: met at 1 mm / 0.5°, {row.method}", share, "%", at_least=100)


def _ratios(by_method: dict[str, Row], where: str, *, collisions: bool) -> list[Goal]:
    laid_out = by_method[LAID_OUT]
    full, plain = (_over(laid_out, by_method[name]) for name in (FULL_OBJECTIVE, PLAIN))
    goals = [
        Goal(f"{where}: our descents / LM kernel, full objective", full, "×", at_most=4),
        Goal(f"{where}: our descents / LM kernel", plain, "×", at_most=4),
        Goal(f"{where}: our whole call / our descents", _over(by_method[APART], laid_out), "×"),
    ]
    if collisions:
        with_, without = by_method[FULL], by_method[APART]
        goals.append(Goal(f"{where}: collision on / off", _over(with_, without), "×"))
        both = [
            (a, b)
            for a, b, one, other in zip(
                with_.seconds, without.seconds, with_.residuals, without.residuals, strict=True
            )
            if one.within(TIGHT) and other.within(TIGHT)
        ]
        if both:
            times = np.median(np.array(both), axis=0)
            ratio = float(times[0] / times[1])
            what = f"{where}: collision on / off, where both meet all ({len(both)})"
            goals.append(Goal(what, ratio, "×", at_most=3))
    return goals


def _over(one: Row, other: Row) -> float:
    return one.median_s / other.median_s
