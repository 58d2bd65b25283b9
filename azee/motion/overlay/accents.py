"""Accents: what rules ask of head, neck, trunk and shoulders by angle adds to what is there.

A chin that is raised, a head that shakes and a trunk that leans do not exclude each other, nor what
the gaze makes of the head: each is an offset of joint coordinates that is laid on the posture
beneath it, and offsets along the nesting of the score add up (Sharma 2024 blends motion templates
likewise). Rotations of one bone that one group of the score asks for are one accent: it rises
before the first, goes from each to the next, and decays after the last.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.overlay.turning import angular_velocity
from azee.motion.tasks.timed_task import TimedTask
from azee_solver import kinematics
from azee_solver.constraint import Rotate
from azee_solver.evaluate import Evaluator

Array = NDArray[np.float64]

ATTACK_S, DECAY_S = 0.15, 0.2
"""Before an accent's first rotation and after its last."""
SHORTEST_STEP_S = 0.06
SHORTEST_STEP_OF_ARMS_S = 0.2
"""From one rotation of an accent to the next, where the score leaves less; the second where the
bone carries the arms. Half a metre away, 5° of the trunk in .06 s would be 70 m/s²."""


@dataclass(frozen=True, slots=True, eq=False)
class Layers:
    """What all accents of a score add to a movement.

    offsets: (T, V) radians, not limited. asked: (T, V), where a rotation holds that needs them.
    """

    offsets: Array
    asked: NDArray[np.bool_]


def layers(accents: Iterable[TimedTask], times_s: Array, evaluator: Evaluator) -> Layers:
    """Return what accents add at increasing times on the score's time line, (T,)."""
    count = len(evaluator.rig.coordinates)
    offsets = np.zeros((len(times_s), count))
    asked = np.zeros(offsets.shape, dtype=np.bool_)
    for group in _grouped(accents, evaluator):
        turns = [_offset(task, evaluator) for task in group]
        offsets += _curve(group, turns, times_s)
        for task, turn in zip(group, turns, strict=True):
            rows = rows_of(task, times_s)
            asked[rows] |= turn != 0.0
    return Layers(offsets, asked)


def rows_of(task: TimedTask, times_s: Array) -> slice:
    """Return the times at which a task holds; the nearest one if it holds between two of them."""
    start, end = float(task.interval.start), float(task.interval.end)
    first, stop = np.searchsorted(times_s, (start - 1e-9, end + 1e-9))
    if first == stop:
        first = int(np.abs(times_s - (start + end) / 2).argmin())
        stop = first + 1
    return slice(int(first), int(stop))


def _grouped(accents: Iterable[TimedTask], evaluator: Evaluator) -> list[list[TimedTask]]:
    """Group rotations of one bone in one group of the score, in order of time.

    Rotations that overlap in time are accents of their own: they add up too.
    """
    groups: dict[tuple[object, ...], list[list[TimedTask]]] = {}
    for task in sorted(accents, key=lambda t: (t.interval.start, t.rank)):
        assert isinstance(task.constraint, Rotate)
        bone = task.constraint.bone.key(evaluator.binding.dominant)
        chains = groups.setdefault((task.path[:-1], bone), [])
        for chain in chains:
            if chain[-1].interval.end <= task.interval.start:
                chain.append(task)
                break
        else:
            chains.append([task])
    return [chain for chains in groups.values() for chain in chains]


def _curve(group: Sequence[TimedTask], turns: Sequence[Array], times_s: Array) -> Array:
    """Return a chain's offsets, (T, V): minimum jerk from each rotation to the next.

    Where two are farther apart than decay and attack take, the accent is gone between them.
    """
    shortest_s = SHORTEST_STEP_S if group[0].limb == "head" else SHORTEST_STEP_OF_ARMS_S
    spans = [(float(t.interval.start), float(t.interval.end)) for t in group]
    out = np.zeros((len(times_s), len(turns[0])))
    knots = [(spans[0][0] - ATTACK_S, spans[0][0], turns[0])]
    for (a, b), before, after in zip(pairwise(spans), turns, turns[1:], strict=False):
        gap = b[0] - a[1]
        if gap >= ATTACK_S + DECAY_S:
            knots += [(a[1], a[1] + DECAY_S, -before), (b[0] - ATTACK_S, b[0], after)]
            continue
        borrowed = max(0.0, shortest_s - gap) / 2
        start = max(a[1] - borrowed, (a[0] + a[1]) / 2)
        end = min(b[0] + borrowed, (b[0] + b[1]) / 2)
        knots.append((start, max(end, start + 1e-3), after - before))
    knots.append((spans[-1][1], spans[-1][1] + DECAY_S, -turns[-1]))
    for start, end, change in knots:
        out += minimum_jerk((times_s - start) / (end - start))[:, None] * change
    return out


@dataclass(frozen=True, slots=True, eq=False)
class _Joint:
    """The joint of a bone: its own coordinates (n,), and the axes (3, n) that they turn it about.

    The axes are those in the neutral posture, in the parent's frame.
    """

    coordinates: list[int]
    axes: Array


def _joint(constraint: Rotate, evaluator: Evaluator) -> _Joint:
    rig, nodes = evaluator.rig, evaluator.binding.bone(constraint.bone)
    neutral = np.asarray(rig.coordinates.idle)
    key = constraint.bone.key(evaluator.binding.dominant)
    own = [v for v, name in enumerate(rig.coordinates.names) if name.partition(".")[0] == key]
    parent = int(rig.chain.parents[nodes.origin_node])
    into = kinematics.frames(rig.chain, neutral).rotations[parent].T if parent >= 0 else np.eye(3)
    axes = [into @ angular_velocity(rig, neutral, v, nodes.node) for v in own]
    return _Joint(own, np.stack(axes, axis=1))


def _offset(task: TimedTask, evaluator: Evaluator) -> Array:
    """Return the change of coordinates, (V,), that turns a bone by its rotation's angle.

    It is the least-squares solution c of A c = axis · angle, A being the axes of its joint.
    """
    constraint = task.constraint
    assert isinstance(constraint, Rotate)
    joint = _joint(constraint, evaluator)
    neutral = np.asarray(evaluator.rig.coordinates.idle)
    axis = evaluator.vector(constraint.axis, kinematics.frames(evaluator.rig.chain, neutral))
    length = float(np.linalg.norm(axis))
    out = np.zeros(len(neutral))
    if np.isfinite(length) and length > 1e-9:
        turn = axis / length * constraint.angle_rad
        out[joint.coordinates] = np.linalg.lstsq(joint.axes, turn, rcond=1e-6)[0]
    return out


def shortfalls(
    accents: Iterable[TimedTask], asked: Array, performed: Array, times_s: Array,
    evaluator: Evaluator,
) -> dict[int, float]:  # fmt: skip
    """Return by how much accents fall short, radians, by rank.

    That is the largest turn, while the rotation holds, from the bone as performed to the bone as
    the sum of all layers asks for it, about those axes of its joint that the rotation needs.

    Args: asked, performed: (T, V).
    """
    out = {}
    for task in accents:
        assert isinstance(task.constraint, Rotate)
        joint, rows = _joint(task.constraint, evaluator), rows_of(task, times_s)
        needed = _offset(task, evaluator)[joint.coordinates] != 0.0
        lacking = ((asked - performed)[rows][:, joint.coordinates] * needed) @ joint.axes.T
        out[task.rank] = float(np.max(np.linalg.norm(lacking, axis=1), initial=0.0))
    return out
