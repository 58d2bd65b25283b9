"""Movements from one state to another: quintic polynomials with given ends.

Between the states (q₀, v₀, a₀) and (q₁, v₁, a₁), T apart, there is one polynomial of degree 5. With
τ = t/T, minimum jerk s(τ) = 10τ³ − 15τ⁴ + 6τ⁵ and their mirror images for the other end,

    q(t) = q₀ + (q₁ − q₀) s(τ) + T v₀ h₁(τ) − T v₁ h₁(1 − τ) + T² a₀ h₂(τ) + T² a₁ h₂(1 − τ)
    h₁(τ) = τ − 6τ³ + 8τ⁴ − 3τ⁵,   h₂(τ) = (τ² − 3τ³ + 3τ⁴ − τ⁵)/2

It is the movement of least jerk between them (Flash and Hogan 1985).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk

Array = NDArray[np.float64]

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
    tau = (np.asarray(times_s, dtype=np.float64) / span_s)[:, None]
    most = SPREAD_RAD / (_PEAK * span_s**2)
    a0, a1 = (np.clip(state.acceleration, -most, most) for state in (start, end))
    return np.asarray(
        start.values
        + (end.values - start.values) * minimum_jerk(tau)
        + span_s * (start.velocity * _h1(tau) - end.velocity * _h1(1.0 - tau))
        + span_s**2 * (a0 * _h2(tau) + a1 * _h2(1.0 - tau))
    )


def _h1(tau: Array) -> Array:
    return tau + tau**3 * (-6.0 + tau * (8.0 - 3.0 * tau))


def _h2(tau: Array) -> Array:
    return tau**2 * (1.0 - tau) ** 3 / 2.0
