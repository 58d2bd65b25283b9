"""Movements from one state to another: quintic polynomials with given ends.

Between the states (q₀, v₀, a₀) and (q₁, v₁, a₁), T apart, there is one polynomial of degree 5. With
τ = t/T, minimum jerk s(τ) = 10τ³ − 15τ⁴ + 6τ⁵ and the mirror images of h₁ and h₂ for the other end,

    q(t) = q₀ + (q₁ − q₀) s(τ) + T v₀ h₁(τ) − T v₁ h₁(1 − τ) + T² a₀ h₂(τ) + T² a₁ h₂(1 − τ)
    h₁(τ) = τ − 6τ³ + 8τ⁴ − 3τ⁵,   h₂(τ) = (τ² − 3τ³ + 3τ⁴ − τ⁵)/2

A body that has a whole second would go on for long as it came: |T v h₁| is up to T |v|/5. Nobody
needs more than `BRAKE_S` to stop. So in h₁ and h₂ T is at most that; since h₁ and h₂ vanish at
their far end with two derivatives, q stays C².
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk

Array = NDArray[np.float64]

BRAKE_S = 0.4
"""In this time what a body did before is over, and what it will do begins."""
SPREAD_RAD = 0.1
"""How far an acceleration at an end may lead a coordinate astray: those of recordings are noisy."""
_PEAK = 0.0173
"""Largest h₂."""
STEP_S = 1 / 120
"""Half of the time over which the velocity of a sampled movement is taken."""


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """Where coordinates are, how fast they go and what pulls them: (n,) rad, rad/s, rad/s²."""

    values: Array
    velocity: Array
    acceleration: Array

    @classmethod
    def at_rest(cls, values: Array) -> State:
        """Return a state without movement."""
        return cls(values, np.zeros_like(values), np.zeros_like(values))

    @classmethod
    def between(cls, before: Array, now: Array, after: Array, step_s: float = STEP_S) -> State:
        """Return the state at the middle of three samples, so far apart, by central differences."""
        velocity = (after - before) / (2.0 * step_s)
        return cls(now, velocity, (after - 2.0 * now + before) / step_s**2)

    def part(self, members: NDArray[np.int64]) -> State:
        """Return the state of some coordinates."""
        return State(self.values[members], self.velocity[members], self.acceleration[members])


def quintic(start: State, end: State, span_s: float, times_s: Array) -> Array:
    """Return the movement between two states at times (m,) from 0 to `span_s`, (m, n).

    Accelerations count only as far as they lead astray by `SPREAD_RAD` at most: T² |a| h₂ ≤ that.
    """
    t = np.asarray(times_s, dtype=np.float64)[:, None]
    brake_s = min(span_s, BRAKE_S)
    leaving = np.minimum(t / brake_s, 1.0)
    arriving = np.minimum((span_s - t) / brake_s, 1.0)
    most = SPREAD_RAD / (_PEAK * brake_s**2)
    a0, a1 = (np.clip(state.acceleration, -most, most) for state in (start, end))
    return np.asarray(
        start.values
        + (end.values - start.values) * minimum_jerk(t / span_s)
        + brake_s * (start.velocity * _h1(leaving) - end.velocity * _h1(arriving))
        + brake_s**2 * (a0 * _h2(leaving) + a1 * _h2(arriving))
    )


def _h1(tau: Array) -> Array:
    return tau + tau**3 * (-6.0 + tau * (8.0 - 3.0 * tau))


def _h2(tau: Array) -> Array:
    return tau**2 * (1.0 - tau) ** 3 / 2.0
