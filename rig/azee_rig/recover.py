"""Coordinates from joint rotations: the inverse of `Rig.pose`.

Joints follow the chain in several ways: whole, with their twist shared, several by one coordinate.
These ways are not inverted one by one. Damped Gauss–Newton finds, for all frames at once, the
coordinates whose posture has the joints' rotations. The error is a rotation vector per joint,
relative to its parent, so that few coordinates act on each joint. Coordinates without a common
joint are varied together for the Jacobian.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig

Floats = NDArray[np.float64]

STEP_RAD = 1e-6
SWEEPS = 60
"""Most Gauss–Newton steps from one start."""
EXACT_RAD = 1e-5
"""Below this error, a posture has the wanted rotations; files round to 1e-8."""
STARTS, SEED = 6, 2010


@dataclass(frozen=True, eq=False, slots=True)
class Recovered:
    """coordinates: (T, V) radians, within the limits. error_rad: (T,) worst turn of any joint."""

    coordinates: Floats
    error_rad: Floats


def recover(rig: Rig, rotations: Floats) -> Recovered:
    """Return the coordinates whose postures have these joint rotations.

    Frames that one start does not solve try again from a solved neighbour, then from random
    postures. If no start solves a frame, it keeps the nearest posture found.

    Args: rotations: (T, J, 4) unit quaternions wxyz relative to the parents, as in `Pose`. Joints
        that no coordinate drives are ignored.
    """
    fit = _Fit(rig)
    c = rig.coordinates
    q = np.tile(c.idle, (len(rotations), 1))
    q, error = fit.improved(q, rotations)
    random = np.random.default_rng(SEED)
    for _ in range(STARTS):
        bad = np.flatnonzero(error > EXACT_RAD)
        if not len(bad):
            break
        good = np.flatnonzero(error <= EXACT_RAD)
        starts = (
            q[good[np.abs(good[None, :] - bad[:, None]).argmin(axis=1)]]
            if len(good)
            else c.idle + 0.7 * random.uniform(c.lower - c.idle, c.upper - c.idle, q[bad].shape)
        )
        again, left = fit.improved(starts, rotations[bad])
        better = left < error[bad]
        q[bad[better]], error[bad[better]] = again[better], left[better]
        if len(good) and not better.any():
            jitter = random.uniform(-0.5, 0.5, q[bad].shape)
            again, left = fit.improved(starts + jitter, rotations[bad])
            better = left < error[bad]
            q[bad[better]], error[bad[better]] = again[better], left[better]
    return Recovered(q, error)


class _Fit:
    """Gauss–Newton on one rig."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.joints = np.flatnonzero(rig.drive.node >= 0)
        c = rig.coordinates
        inside = 0.37 * c.lower + 0.63 * c.upper
        q = np.stack([inside, *(inside + 0.1 * np.eye(len(c)))])
        turned = rig.pose(q).rotations[:, self.joints]
        acts = np.abs(turned[1:] - turned[0]).max(axis=2) > 1e-12  # (V, joints)
        self.rounds = _independent(acts)
        self.acts = np.repeat(acts, 3, axis=1)

    def improved(self, q: Floats, rotations: Floats, chunk: int = 256) -> tuple[Floats, Floats]:
        """Improve postures (T, V); return them and the remaining error of each, radians."""
        parts = [
            self._improved(q[i : i + chunk], rotations[i : i + chunk])
            for i in range(0, len(q), chunk)
        ]
        return np.concatenate([p for p, _ in parts]), np.concatenate([e for _, e in parts])

    def _improved(self, q: Floats, rotations: Floats) -> tuple[Floats, Floats]:
        c = self.rig.coordinates
        wanted = rotations[:, self.joints]
        q = np.clip(q, c.lower, c.upper)
        r = self._residual(q, wanted)
        damping, exact = np.full(len(q), 1e-3), np.zeros(len(q), dtype=bool)
        for _ in range(SWEEPS):
            far = np.abs(r).max(axis=1) > 1e-9
            busy = np.flatnonzero(far & ~exact & (damping < 1e6))
            if not len(busy):
                break
            J = self._jacobian(q[busy], r[busy], wanted[busy])
            JT = np.swapaxes(J, 1, 2)
            normal = JT @ J
            normal += damping[busy, None, None] * np.eye(len(c))
            step = np.linalg.solve(normal, -(JT @ r[busy, :, None]))[..., 0]
            tried = np.clip(q[busy] + step, c.lower, c.upper)
            after = self._residual(tried, wanted[busy])
            better = (after**2).sum(axis=1) < (r[busy] ** 2).sum(axis=1)
            q[busy[better]], r[busy[better]] = tried[better], after[better]
            damping[busy] = np.where(better, damping[busy] * 0.1, damping[busy] * 10.0)
            np.maximum(damping, 1e-9, out=damping)
            # What is left now is how the file was rounded: no step takes that away.
            exact[busy] = ~better & (np.abs(r[busy]).max(axis=1) < EXACT_RAD)
        turns = np.linalg.norm(r.reshape(len(q), -1, 3), axis=2)
        return q, turns.max(axis=1)

    def _residual(self, q: Floats, wanted: Floats) -> Floats:
        """Return rotation vectors from the joints' rotations to the wanted ones, (T, 3 joints)."""
        w, x, y, z = np.moveaxis(self.rig.pose(q).rotations[:, self.joints], -1, 0)
        a, b, c, d = np.moveaxis(wanted, -1, 0)
        scalar = w * a + x * b + y * c + z * d
        vector = np.stack(
            [
                w * b - x * a - y * d + z * c,
                w * c - y * a - z * b + x * d,
                w * d - z * a - x * c + y * b,
            ],
            axis=-1,
        )
        vector *= np.where(scalar < 0.0, -1.0, 1.0)[..., None]
        length = np.linalg.norm(vector, axis=-1)
        angle = 2.0 * np.arctan2(length, np.abs(scalar))
        scale = np.where(length > 1e-12, angle / np.maximum(length, 1e-12), 2.0)
        return (vector * scale[..., None]).reshape(len(q), -1)

    def _jacobian(self, q: Floats, r: Floats, wanted: Floats) -> Floats:
        J = np.zeros((len(q), r.shape[1], q.shape[1]))
        for members in self.rounds:
            moved = q.copy()
            moved[:, members] += STEP_RAD
            change = (self._residual(moved, wanted) - r) / STEP_RAD
            for v in members:
                J[:, self.acts[v], v] = change[:, self.acts[v]]
        return J


def _independent(acts: NDArray[np.bool_]) -> list[list[int]]:
    """Distribute coordinates over few rounds: none of a round act on the same joint."""
    rounds: list[tuple[list[int], NDArray[np.bool_]]] = []
    for v, joints in enumerate(acts):
        for members, taken in rounds:
            if not (taken & joints).any():
                members.append(v)
                taken |= joints
                break
        else:
            rounds.append(([v], joints.copy()))
    return [members for members, _ in rounds]
