"""The smallest offsets of coordinates with which pairs of capsules keep their distance.

An offset c, (n,), is added to samples of a movement by weights that grow from nothing and return to
it. With d_tp(c) the depth of pair p at sample t, a_tp the depth that it may have there, and m the
price of an offset, it minimises

    Σ_tp max(0, d_tp(c) − a_tp)² + m² |c|²

in Levenberg–Marquardt steps −(JᵀJ + (m² + λ) I)⁻¹ (Jᵀe + m² c), e being the positive parts and J
their derivatives by c.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.curves.capsule_overlap import CapsuleOverlaps

Array = NDArray[np.float64]

CONSIDERED_M = 0.025
"""Pairs that are farther apart in all samples are not considered."""
TAPER = 0.35
"""Share of the stretch in which pairs that are near at its end reach their clearance."""
MAX_ITERATIONS, MAX_STEP_RAD = 40, 0.15
LEAST_GAIN = 0.05
"""A step that lowers the sum by less than this share is the last one."""
DAMPING = 0.03


@dataclass(frozen=True, slots=True, eq=False)
class Offset:
    """An offset, (n,) radians, and how deep any pair is beyond what it may be, metres."""

    values: Array
    shortfall_m: float


@dataclass(frozen=True, slots=True, eq=False)
class OffsetSearch:
    """Damped least squares for the smallest offset with which all pairs keep their distance.

    q: (T, V) samples of the stretch. members: (n,) coordinates to offset; one may come twice, with
    other weights. weights: (T, n) share of the offset at each sample. most: (n,) largest offset
    either way. axis_distances: (P,) metres. clearance: (P,) distance to keep, metres. price_m: an
    offset of one radian costs as much as this overlap in one sample. step_rad: largest step.
    lower, upper: (V,) limits.
    """

    q: Array
    members: NDArray[np.int64]
    weights: Array
    most: Array
    overlaps: CapsuleOverlaps
    axis_distances: Array
    clearance: Array
    price_m: float
    step_rad: float
    lower: Array
    upper: Array

    def smallest(
        self, start: Array, pairs: NDArray[np.int64], allowed: Array, enough_m: float
    ) -> Offset:
        """Return the offset that a search from `start` finds.

        Args: pairs: indices of those that matter. allowed: (T, P) the depths that they may have.
            enough_m: it ends when no pair lacks more.
        """
        c, damping = start, DAMPING
        error, J = self._errors(c, pairs, allowed)
        cost = float(np.sum(error**2) + self.price_m**2 * np.sum(c**2))
        for _ in range(MAX_ITERATIONS):
            if np.max(error) <= enough_m:
                break
            lhs, rhs = _normal_equations(J, error)
            lhs += (self.price_m**2 + damping) * np.eye(len(c))
            step = -np.linalg.solve(lhs, rhs + self.price_m**2 * c)
            step *= min(1.0, self.step_rad / max(1e-9, float(np.max(np.abs(step)))))
            step = np.clip(c + step, -self.most, self.most) - c
            new_error, new_J = self._errors(c + step, pairs, allowed)
            new_cost = float(np.sum(new_error**2) + self.price_m**2 * np.sum((c + step) ** 2))
            gain = 1.0 - new_cost / cost
            if gain > 0.0:
                c, error, J, cost, damping = c + step, new_error, new_J, new_cost, damping / 3
            else:
                damping *= 8
            if 0.0 < gain < LEAST_GAIN:
                break
        return Offset(c, float(np.max(error)))

    def allowed_depths(self, depths: Array, pairs: NDArray[np.int64]) -> Array:
        """Return the depths that pairs may have in the samples, (T, P) metres.

        Minus the clearance; but a pair that is nearer at an end of the stretch may be so near
        beside that end, and reaches the clearance by minimum jerk within the share `TAPER`.

        Args: depths: (T, P) those that they have. pairs: their indices.
        """
        clearance = self.clearance[pairs]
        ends = np.maximum(depths[[0, -1]], -clearance)
        along = np.linspace(0.0, 1.0, len(self.q))[:, None]
        leaving = 1.0 - minimum_jerk(along / TAPER)
        arriving = 1.0 - minimum_jerk((1.0 - along) / TAPER)
        near = np.maximum((ends[0] + clearance) * leaving, (ends[1] + clearance) * arriving)
        return np.asarray(near - clearance)

    def _errors(
        self, offset: Array, pairs: NDArray[np.int64], allowed: Array
    ) -> tuple[Array, Array]:
        """Return depths beyond the allowed ones, (T · P,) metres, and derivatives, (T · P, n)."""
        own, column = np.unique(self.members, return_inverse=True)
        wanted = self.offset_by(offset)
        q = np.clip(wanted, self.lower, self.upper)
        least = float(allowed.min(initial=math.inf))
        depths, gradients = self.overlaps.depths_and_gradients(
            q, self.axis_distances, pairs, own, least
        )
        beyond = depths - allowed
        # A coordinate at its limit does not move, and a pair that is far enough does not count.
        counts = (wanted == q)[:, None, self.members] & (beyond > 0.0)[..., None]
        J = gradients[..., column] * self.weights[:, None, :] * counts
        return np.maximum(beyond, 0.0).ravel(), J.reshape(beyond.size, -1)

    def offset_by(self, offset: Array) -> Array:
        """Return the samples with an offset, (T, V), not limited."""
        wanted = self.q.copy()
        np.add.at(wanted.T, self.members, (self.weights * offset).T)
        return wanted


def _normal_equations(J: Array, error: Array) -> tuple[Array, Array]:
    """Return Jᵀ J, (n, n), and Jᵀ e, (n,), of slopes (R, n) that are zero where errors (R,) are.

    Without BLAS, which may share products of this size among threads: their number could then
    show in the result, and on busy cores they wait for each other longer than the product takes.
    """
    rows = np.flatnonzero(error)
    columns = np.ascontiguousarray(J[rows].T)
    return np.einsum("ir,jr->ij", columns, columns), np.einsum("ir,r->i", columns, error[rows])
