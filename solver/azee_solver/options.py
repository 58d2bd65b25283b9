"""Choices of a solver, with the values that measurement settled."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from azee_solver.residuals import Tolerance


@dataclass(frozen=True, slots=True)
class SolveOptions:
    """How exactly, how humanly and how long.

    tolerance: what counts as met. A miss by it costs 1 in the objective, beside which stand
    posture: per squared radian away from the reference, times the coordinate's squared stiffness;
    comfort: per squared part of a half range beyond 80 % of it; overlap: per squared metre that
    two capsules overlap, 0 to let bodies pass through each other; overlap_m: what is tolerated of
    that. approach_evaluations end NLopt's part of a descent that begins soft, max_evaluations one
    at the full price, descent_tolerance either; polish_rounds and polish_tolerance the
    Gauss-Newton steps after it, finish_work (steps times coordinates) and
    finish_tolerance those that the best of all descents ends with. further_starts: of the Halton
    sequence. patience: so many descents in a row that gain nothing end the search; twice as many
    if no wider problem can take over. explain: find out why what misses misses, by solving
    smaller problems. fixed: coordinates that must not move from the start. inertia: how many times
    more than to the reference a posture is drawn to the start, 0 for a posture that stands alone:
    along a movement it spreads over many steps what would else be a jump, such as a trunk that is
    no longer needed.
    """

    tolerance: Tolerance = field(default_factory=lambda: Tolerance(1e-3, math.radians(0.5)))
    posture: float = 1.0
    comfort: float = 3.0
    overlap: float = 0.25e6
    overlap_m: float = 3e-3
    approach_evaluations: int = 4
    max_evaluations: int = 600
    descent_tolerance: float = 1e-2
    polish_rounds: int = 20
    polish_tolerance: float = 1e-4
    finish_work: int = 2500
    finish_tolerance: float = 1e-6
    further_starts: int = 6
    patience: int = 6
    explain: bool = True
    fixed: frozenset[int] = frozenset()
    inertia: float = 0.0
