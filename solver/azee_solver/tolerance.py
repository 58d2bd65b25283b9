"""What counts as met: the one place where tolerances are set."""

from __future__ import annotations

import math
from dataclasses import dataclass

from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Rotate,
    Transpath,
    Trill,
)


@dataclass(frozen=True, slots=True)
class Tolerance:
    """Residuals up to which a constraint counts as met: metres for places, radians for directions.

    By default 1 mm and 0.5°.
    """

    length_m: float = 1e-3
    angle_rad: float = math.radians(0.5)

    def of(self, constraint: Constraint) -> float:
        """Return the tolerance of a constraint, in the unit of its residual."""
        match constraint:
            case Place() | Transpath():
                return self.length_m
            case Orient() | Look() | LookAt() | Morph() | Trill() | Rotate():
                return self.angle_rad


PAPER = Tolerance(length_m=0.01, angle_rad=math.radians(5.0))
"""PLACE_THRSHLD and ROT_THRSH of Nunnari, Filhol & Heloir 2018, section 4.5: 1 cm and 5°."""
