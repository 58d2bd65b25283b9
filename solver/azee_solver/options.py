"""Options of the solver, with defaults that were measured."""

from __future__ import annotations

from dataclasses import dataclass, field

from azee_solver.tolerance import Tolerance


@dataclass(frozen=True, slots=True)
class SolveOptions:
    """How exactly, how comfortably and how long to solve."""

    tolerance: Tolerance = field(default_factory=Tolerance)
    """What counts as met. A miss by it costs 1 in the objective."""
    posture: float = 1.0
    """Cost of a squared radian from the reference, times the coordinate's squared stiffness."""
    comfort: float = 3.0
    """Joint-limit cost: of a squared part of a half range beyond 80 % of it."""
    overlap: float = 0.25e6
    """Cost of a squared metre that two capsules overlap; 0 lets bodies pass through each other."""
    overlap_m: float = 3e-3
    """Overlap that is tolerated, metres."""
    approach_evaluations: int = 4
    """Most evaluations of NLopt in the first stage of a soft descent."""
    max_evaluations: int = 600
    """Most evaluations of NLopt in a stiff descent."""
    descent_tolerance: float = 1e-2
    """Relative gain below which NLopt, and the first stage of a soft descent, end."""
    gauss_newton_rounds: int = 20
    """Most Gauss-Newton steps after either."""
    gauss_newton_tolerance: float = 1e-4
    """Relative gain below which these end."""
    finish_work: int = 2500
    """Most Gauss-Newton steps times coordinates that the best of all descents ends with."""
    finish_tolerance: float = 1e-6
    """Relative gain below which these end."""
    far: bool = True
    """Whether a search that fails goes on around the body and with straight arms."""
    patience: int = 6
    """Descents in a row that gain nothing and end a search."""
    precise: bool = True
    """Whether to meet constraints at any price of comfort. Movements of azee do not by default."""
    fixed: frozenset[int] = frozenset()
    """Coordinates that must not move from the start."""
    inertia: float = 0.0
    """How many times more than to the reference a posture is drawn to the start.

    0 for a posture that stands alone. Along a movement, inertia spreads over many steps what would
    else be a jump, such as a trunk that is no longer needed (ADR 26)."""
