"""Trills: small rapid oscillations, added to the movement that the other constraints fix.

A bone turns about the trill's axis by the angle (a − b)/2 + (a + b)/2 · sin(2πft + φ), between a
and −b, faded in and out inside the block. Where that would pass a limit of a joint, the middle of
the oscillation moves away from the limit by up to `MOST_SHIFT_RAD`, and the rest is clamped. An
axis means what it means to
`rotate`: without bones or sites in it, it has the components x, dir and nrm of the parent bone's
frame; otherwise it is a direction of the signer's frame. Where a bone's own joint cannot turn about
the axis (a palm about its own length), the joint before it helps (the forearm turns).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.overlay.turning import angular_velocity
from azee.motion.tasks.timed_task import TimedTask
from azee_rig.chain import Frames
from azee_rig.coordinates import Coordinates
from azee_solver import kinematics
from azee_solver.anatomy import anatomy
from azee_solver.constraint import Trill
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import depends_on

Array = NDArray[np.float64]

FADE_S = 0.1
MOST_SHIFT_RAD = math.radians(5.0)
"""How far the middle may move, per coordinate, and never more than a quarter of the whole swing:
that its ends differ in size is read, that both lie a little to one side is not."""
OWN_JOINT_SHARE = 0.9
"""Share of the axis that a bone's own joint must be able to turn about, or the next one helps."""


@dataclass(frozen=True, slots=True, eq=False)
class Oscillation:
    """A trill on one body.

    direction: (V,) change of the coordinates per radian of the angle. turnable: share of the axis
    that the joints can turn about, 0 to 1.
    """

    task: TimedTask
    direction: Array
    turnable: float

    @property
    def half_rad(self) -> float:
        """Half of the angle between its two ends."""
        trill = self.task.constraint
        assert isinstance(trill, Trill)
        return 0.5 * (trill.amplitude_rad + trill.other_rad)

    def envelope(self, times_s: Array) -> Array:
        """Return the share of it that is faded in at times, (T,)."""
        start, end = float(self.task.interval.start), float(self.task.interval.end)
        fade = min(FADE_S, (end - start) / 2)
        if fade <= 0:
            return np.zeros(len(times_s))
        return np.asarray(
            minimum_jerk((times_s - start) / fade) * minimum_jerk((end - times_s) / fade)
        )

    def angles(self, times_s: Array) -> Array:
        """Return the angle at times, (T,) radians."""
        trill = self.task.constraint
        assert isinstance(trill, Trill)
        start, end = float(self.task.interval.start), float(self.task.interval.end)
        passed = 2 * math.pi * trill.hz(end - start) * (times_s - start)
        middle = 0.5 * (trill.amplitude_rad - trill.other_rad)
        wave = middle + self.half_rad * np.sin(passed + trill.phase_rad)
        return np.asarray(self.envelope(times_s) * wave)


def oscillation(task: TimedTask, q: Array, evaluator: Evaluator) -> Oscillation:
    """Find how the coordinates turn a trilled bone about its axis.

    The direction d is the least-squares solution of J d = axis, J being the (3, n) angular
    velocities of the bone per unit speed of the coordinates of its joint.

    Args: q: (V,) posture in the middle of the trill.
    """
    trill = task.constraint
    assert isinstance(trill, Trill)
    chain, coordinates = evaluator.rig.chain, evaluator.rig.coordinates
    nodes = evaluator.binding.bone(trill.bone)
    frames = kinematics.frames(chain, q)
    axis = _world_axis(trill, frames, evaluator)
    body = anatomy(chain, coordinates)
    best = Oscillation(task, np.zeros(len(coordinates)), 0.0)
    first = int(chain.parents[nodes.origin_node])
    for _ in range(2):
        movers = sorted(body.below(first, nodes.node))
        J = np.stack([angular_velocity(evaluator.rig, q, v, nodes.node) for v in movers], axis=1)
        change = np.linalg.lstsq(J, axis, rcond=1e-6)[0]
        turnable = float(np.linalg.norm(J @ change))
        if turnable > best.turnable + 1e-6:
            direction = np.zeros(len(coordinates))
            direction[movers] = change
            best = Oscillation(task, direction, turnable)
        if turnable >= OWN_JOINT_SHARE or first < 0:
            break
        first = _joint_before(first, evaluator)
    return best


def add_trills(
    q: Array, times_s: Array, trills: Sequence[Oscillation], coordinates: Coordinates
) -> tuple[Array, dict[int, float]]:
    """Add trills to a movement, inside the limits.

    Args: q: (T, V). times_s: (T,) on the score's time line.
    Returns: coordinates (T, V), and per rank of a trill the largest angle it falls short by.
    """
    out = q.copy()
    shortfalls: dict[int, float] = {}
    for trill in trills:
        interval = trill.task.interval
        ends = np.searchsorted(times_s, (float(interval.start), float(interval.end)))
        rows = slice(int(ends[0]), int(ends[1]))
        wanted = out[rows] + trill.angles(times_s[rows])[:, None] * trill.direction
        shift = _shift(trill, wanted, coordinates)
        wanted += trill.envelope(times_s[rows])[:, None] * shift
        out[rows] = np.clip(wanted, coordinates.lower, coordinates.upper)
        clamped = float(np.max(np.abs(wanted - out[rows]), initial=0.0))
        constraint = trill.task.constraint
        assert isinstance(constraint, Trill)
        widest = max(abs(constraint.amplitude_rad), abs(constraint.other_rad))
        not_turnable = (1.0 - trill.turnable) * widest
        shortfalls[trill.task.rank] = max(clamped, not_turnable)
    return out, shortfalls


def _shift(trill: Oscillation, wanted: Array, coordinates: Coordinates) -> Array:
    """Return how far the middle of a trill moves, (V,) radians, to keep it inside the limits.

    Args: wanted: (T, V) coordinates of the body with the trill.
    """
    above = np.max(wanted - coordinates.upper, axis=0, initial=0.0)
    below = np.max(coordinates.lower - wanted, axis=0, initial=0.0)
    most = np.minimum(MOST_SHIFT_RAD, 0.5 * trill.half_rad * np.abs(trill.direction))
    return np.asarray(np.clip(below - above, -most, most))


def _joint_before(node: int, evaluator: Evaluator) -> int:
    """Return the node that the bone above a node hangs on, −1 for none."""
    parents = evaluator.rig.chain.parents
    origins = {bone.node: bone.origin_node for bone in evaluator.rig.bones.values()}
    while node >= 0 and node not in origins:
        node = int(parents[node])
    return int(parents[origins[node]]) if node >= 0 else -1


def _world_axis(trill: Trill, frames: Frames, evaluator: Evaluator) -> Array:
    axis = evaluator.vector(trill.axis, frames)
    length = float(np.linalg.norm(axis))
    if not np.isfinite(length) or length < 1e-9:
        return np.zeros(3)
    if not depends_on(trill.axis):
        nodes = evaluator.binding.bone(trill.bone)
        parent = int(evaluator.rig.chain.parents[nodes.origin_node])
        if parent >= 0:
            axis = frames.rotations[parent] @ axis
    return np.asarray(axis / length)
