"""Postures of a hand with its markers where they were recorded: a problem of `azee_solver`.

Every marker on a digit is a site that a constraint places. All frames are solved at once by damped
Gauss-Newton steps inside the limits. Joints stay near a reference posture, since a few markers do
not tell all of them; what differs from it is smooth in time.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from azee.capture.hand import Hand, HandShape
from azee.capture.markers import Floats
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.anatomy import anatomy
from azee_solver.broadphase import Collisions
from azee_solver.constraint import Place
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side, Site, WorldPoint
from azee_solver.program import Cost, Program
from azee_solver.residuals import Residuals, lower
from azee_solver.tape import Tape
from azee_solver.task import Task
from azee_solver.tolerance import Tolerance
from azee_solver.trajectory import ORDER, SMOOTH_S, Refills, Trajectory

TOLERANCE = Tolerance(length_m=0.001)
"""A marker that is off by it costs 1."""
KEEP = 0.5
"""Cost of a squared radian from the reference."""


@dataclass(frozen=True, eq=False)
class HandFit:
    """Fits one person's hand."""

    hand: Hand
    shape: HandShape

    @cached_property
    def rig(self) -> Rig:
        """The body with the person's hand."""
        return self.hand.of(self.shape)

    def tasks(self, targets: Floats) -> list[Task]:
        """Return the constraints of one posture: each marker at its target, (m, 3) in the palm."""
        idle = kinematics.frames(self.rig.chain, self.rig.coordinates.idle)
        P, p = idle.rotations[self.hand.palm], idle.positions[self.hand.palm]
        points = targets @ P.T + p
        return [
            Task(Place(Site(name), WorldPoint(*point)), rank=n)
            for n, (name, point) in enumerate(zip(self.rig.sites, points.tolist(), strict=True))
        ]

    def solved(
        self,
        targets: Floats,
        reference: Floats,
        rate_hz: float,
        off_m: Floats | None = None,
        keep: float = KEEP,
        smooth: float = 1.0,
    ) -> Floats:
        """Return postures (T, V) inside the limits.

        Args: targets: (T, m, 3) markers in the palm. reference: (T, V) postures to stay near.
            off_m: (m,) how far each target may be wrong; by default a millimetre. smooth: factor
            of the cost of being rough.
        """
        rig = self.rig
        c = rig.coordinates
        costs = (TOLERANCE.length_m / off_m) ** 2 if off_m is not None else np.ones(len(rig.sites))
        residuals, program = self._program(targets[0], costs)
        free = np.zeros(len(c), dtype=np.bool_)
        free[program.free] = True
        idle = kinematics.frames(rig.chain, c.idle)
        P, p = idle.rotations[self.hand.palm], idle.positions[self.hand.palm]
        start = np.tile(c.idle, (len(targets), 1))
        start[:, free] = np.clip(reference, c.lower, c.upper)[:, free]
        entries = [program.rows[residuals.runs[n][0]].b for n in range(len(rig.sites))]
        weights = np.where(free, keep, 0.0)
        found = Trajectory(
            [program],
            np.zeros(len(targets), dtype=np.int64),
            start,
            np.tile(weights, (len(targets), 1)),
            np.tile(~free, (len(targets), 1)),
            smooth * weights * (SMOOTH_S * rate_hz) ** (2 * ORDER),
            c.lower,
            c.upper,
            0.0,
            _Targets(np.array(entries), targets @ P.T + p),
        ).solve(rate_hz)
        return self.hand.completed(found)

    def _program(self, targets: Floats, costs: Floats) -> tuple[Residuals, Program]:
        """Return the problem of a frame: its rows, and it laid out for the digits' coordinates."""
        rig, columns = self.rig, self.hand.columns
        if self.hand.coupled:
            columns = np.setdiff1d(columns, self.hand.followers[0])
        dominant = Side.RIGHT if self.hand.side == "R" else Side.LEFT
        idle = rig.coordinates.idle
        moving = anatomy(rig.chain, rig.coordinates).moved_by(columns.tolist())
        tape = Tape(Evaluator(rig, dominant), kinematics.frames(rig.chain, idle), moving)
        tasks = dict(enumerate(self.tasks(targets)))
        factors = dict(enumerate(costs.tolist()))
        residuals = lower(tape, tasks, TOLERANCE, factors)
        nothing = np.zeros(len(idle))
        cost = Cost(np.array(idle), nothing, nothing, 0.0)
        none = Collisions.none()
        return residuals, Program(rig, idle, columns.tolist(), tape, residuals.rows, none, cost)


@dataclass(frozen=True, slots=True, eq=False)
class _Targets:
    """Fills in where the markers are in each frame: entries (m,), points (T, m, 3) in the world."""

    entries: Floats
    points: Floats

    def __call__(self, frames: range, q: Floats) -> Refills:
        count, m = len(frames), len(self.entries)
        numbers = np.zeros((count, m, 5))
        numbers[:, :, :3] = self.points[frames.start : frames.stop]
        return Refills(
            np.full(count, m, dtype=np.int64), np.tile(self.entries, (count, 1)), numbers
        )
