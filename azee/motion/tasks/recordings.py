"""Recorded signs of a score, bound to a body: which limbs they move, when and how.

A recording owns limbs while it plays. Whatever else asks something of a limb then, such as a block
that points with the other hand or looks somewhere, has it instead. In its attack and decay the body
only comes from where it was, or goes where it is needed next.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.clip.edit import left_handed
from azee.clip.quintic import STEP_S, State
from azee.clip.resample import sampled
from azee.motion.tasks.flatten import RecordedLeaf
from azee.motion.tasks.limbs import Limbs, channel_of_limb, is_finger
from azee.motion.tasks.timed_task import TimedTask
from azee.score.interval import Interval
from azee_rig.coordinates import Coordinates
from azee_rig.rig import Rig
from azee_solver.constraint import Morph
from azee_solver.geometry import Side

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

HAND_RAD = np.radians(8.0)
"""A recording moves an arm with its hand if any of their coordinates changes by more than this."""
CARRIED_RAD = np.radians(3.0)
"""The same of trunk, head and eyes: nobody holds them still."""


@dataclass(frozen=True, slots=True, eq=False)
class RecordedBlock:
    """A recorded sign on the score's time line.

    interval: of its block. body: when the movement is that of the recording. clip: on the body,
    from 0 on. first_s, last_s: the part of the clip that the body plays. limbs: that it owns.
    """

    path: tuple[str, ...]
    name: str
    interval: Interval
    body: Interval
    clip: Clip
    first_s: float
    last_s: float
    limbs: frozenset[str]
    coordinates: Coordinates
    members: NDArray[np.int64] = field(repr=False)

    @property
    def start_s(self) -> float:
        """When the body starts."""
        return float(self.body.start)

    @property
    def end_s(self) -> float:
        """When the body ends."""
        return float(self.body.end)

    @property
    def moments_s(self) -> tuple[float, float, float]:
        """Start, middle and end of its body, for pictures."""
        return self.start_s, (self.start_s + self.end_s) / 2.0, self.end_s

    def sample(self, times_s: Array) -> Array:
        """Return its postures, (T, V) radians, at increasing times; outside the body it goes on."""
        return self._at(times_s).coordinates

    def face(self, times_s: Array) -> Array:
        """Return its weights of the clip's face units, (T, M), at increasing times."""
        return self._at(times_s).unit_weights

    def state(self, time_s: float) -> State:
        """Return where its coordinates are and how they move, (V,)."""
        return State.between(*self.sample(np.array([time_s - STEP_S, time_s, time_s + STEP_S])))

    def plays(self, time: Fraction) -> bool:
        """Whether an instant is in its body."""
        return self.body.start <= time <= self.body.end

    def _at(self, times_s: Array) -> Clip:
        lasts_s = self.end_s - self.start_s
        slope = (self.last_s - self.first_s) / lasts_s if lasts_s else 1.0
        inside = self.first_s + (np.asarray(times_s) - self.start_s) * slope
        return sampled(self.clip, inside, self.coordinates)


def recorded_blocks(
    leaves: Iterable[RecordedLeaf],
    tasks: Sequence[TimedTask],
    rig: Rig,
    limbs: Limbs,
    dominant: Side,
) -> tuple[RecordedBlock, ...]:
    """Bind the recordings of a score to a body, in order of time.

    Args: tasks: what else asks something of bones, sites or handshapes.
    Raises: RecordingError: one cannot be played.
    """
    found = []
    for leaf in leaves:
        clip = leaf.score.motion.clip(rig)
        if leaf.score.mirrored != (dominant is Side.LEFT):
            clip = left_handed(clip, rig.coordinates)
        attack_s, decay_s = float(leaf.score.attack_s), float(leaf.score.decay_s)
        own = leaf.score.body.shifted(leaf.interval.start)
        block = RecordedBlock(
            leaf.path, leaf.score.motion.name, leaf.interval, own, clip,
            attack_s, max(attack_s, clip.duration_s - decay_s),
            _moved(clip, limbs), rig.coordinates, np.empty(0, dtype=np.int64),
        )  # fmt: skip
        found.append(_without(block, _asked_elsewhere(block, tasks), limbs))
    return tuple(sorted(found, key=lambda b: (b.body.start, b.body.end)))


def _without(block: RecordedBlock, others: frozenset[str], limbs: Limbs) -> RecordedBlock:
    own = block.limbs - others
    members = [v for limb in sorted(own) for v in limbs.members[limb].tolist()]
    return replace(block, limbs=own, members=np.array(sorted(members), dtype=np.int64))


def _moved(clip: Clip, limbs: Limbs) -> frozenset[str]:
    """Return the limbs that a recording moves; an arm and its fingers go together."""
    range_rad = np.ptp(clip.coordinates, axis=0)
    moved = {limb: float(range_rad[v].max(initial=0.0)) for limb, v in limbs.members.items()}
    hands = {limb[-2:] for limb, turn in moved.items() if _is_hand(limb) and turn > HAND_RAD}
    return frozenset(
        limb
        for limb, turn in moved.items()
        if (limb[-2:] in hands if _is_hand(limb) else turn > CARRIED_RAD)
    )


def _is_hand(limb: str) -> bool:
    return channel_of_limb(limb) == "hands"


def _asked_elsewhere(block: RecordedBlock, tasks: Iterable[TimedTask]) -> frozenset[str]:
    """Return the limbs that tasks name while a recording plays.

    A handshape leaves the arm to the recording; all else that names a hand takes it with its arm.
    """
    out: set[str] = set()
    for task in tasks:
        span = task.interval
        if not (span.start < block.body.end and block.body.start < span.end):
            continue
        if not _is_hand(task.limb):
            out.add(task.limb)
        elif isinstance(task.constraint, Morph):
            out |= {limb for limb in task.limbs if is_finger(limb)} or {task.limb}
        else:
            out |= {limb for limb in block.limbs if _is_hand(limb) and limb[-2:] == task.limb[-2:]}
    return frozenset(out)


@dataclass(frozen=True, slots=True, eq=False)
class Imposed:
    """What recordings have the body do at some instants: which coordinates, (…, V), and where."""

    mask: Mask
    values: Array


def imposed(blocks: Iterable[RecordedBlock], times: Sequence[Fraction], count: int) -> Imposed:
    """Return what recordings impose on `count` coordinates at increasing instants, (T, V) each."""
    mask = np.zeros((len(times), count), dtype=np.bool_)
    values = np.zeros((len(times), count))
    for block in blocks:
        rows = [i for i, time in enumerate(times) if block.plays(time)]
        if rows:
            at = np.ix_(np.array(rows), block.members)
            seconds = np.array([float(times[i]) for i in rows])
            mask[at], values[at] = True, block.sample(seconds)[:, block.members]
    return Imposed(mask, values)
