"""How fast a person's arms go, and how long a way takes them.

Between two postures, T apart, a site on a straight way of length L moves by minimum jerk (Flash &
Hogan 1985), L (10τ³ − 15τ⁴ + 6τ⁵) with τ = t/T. Its largest speed is 15/8 · L/T, in the middle, and
its largest acceleration 10/√3 · L/T², at τ = (3 ± √3)/6. A turn of a joint by an angle has the
same. So limits on speed and acceleration are limits on T.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

PEAK_SPEED = 15.0 / 8.0
"""Largest |s′| of s(τ) = 10τ³ − 15τ⁴ + 6τ⁵ over 0 ≤ τ ≤ 1."""
PEAK_ACCELERATION = 10.0 / math.sqrt(3.0)
"""Largest |s″| of the same."""
SHOULDERS_M = 0.36
"""Limits are those of a body whose shoulders are so far apart, as speeds of recordings are."""


@dataclass(frozen=True, slots=True)
class Pace:
    """The most that arms do on their own, between places and along paths.

    wrist_m_s, wrist_m_s2: speed and acceleration of a wrist, or of a site on its path. joint_rad_s:
    speed of a coordinate of the arm, from clavicle to wrist. docs/likeness.md tells where such
    limits come from; these keep a distance from the 2.5 m/s, 40 m/s² and 600 °/s there, for the
    movement may still have to go round the body.

    Raises: ValueError: a limit is not above zero.
    """

    wrist_m_s: float = 1.9
    wrist_m_s2: float = 34.0
    joint_rad_s: float = math.radians(570.0)

    def __post_init__(self) -> None:
        limits = (self.wrist_m_s, self.wrist_m_s2, self.joint_rad_s)
        if not all(math.isfinite(limit) and limit > 0 for limit in limits):
            raise ValueError(f"the limits of a pace are above zero, not {limits}")

    def stretch(self, speed_m_s: float, acceleration_m_s2: float, joint_rad_s: float) -> float:
        """Return how many times longer a movement must take to keep to this pace.

        A movement that takes f times as long has 1/f of its speeds and 1/f² of its accelerations.
        Below 1 there is time left.
        """
        return max(
            speed_m_s / self.wrist_m_s,
            math.sqrt(acceleration_m_s2 / self.wrist_m_s2),
            joint_rad_s / self.joint_rad_s,
        )

    def least_s(self, way_m: float, turn_rad: float = 0.0) -> float:
        """Return the least time for a way of the wrist with a turn of a joint, by minimum jerk.

        T = max( 15/8 · L/v, √(10/√3 · L/a), 15/8 · Δq/w ).
        """
        return self.stretch(PEAK_SPEED * way_m, PEAK_ACCELERATION * way_m, PEAK_SPEED * turn_rad)
