"""The whole body's movement: a curve for every limb, and via points added to them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.limb_curves import (
    SHORTEST_S,
    LimbCurve,
    LimbKey,
    Onsets,
    calm_transition_s,
    limb_curve,
)
from azee.motion.curves.via_points import ViaPoint
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.key_posture import KeyPosture
from azee.motion.tasks.limbs import Limbs, channel_of_limb, is_finger, place_in_arm
from azee.motion.tasks.recordings import RecordedBlock
from azee.score.interval import Interval
from azee_rig.coordinates import Coordinates
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.constraint import Manner

Array = NDArray[np.float64]

WAY_PARTS = 4
"""Parts of a way from or to rest whose lengths are measured."""
AT_ONCE = 256
"""Postures that are measured together."""


@dataclass(frozen=True, slots=True, eq=False)
class Movement:
    """Curves of all limbs, by name, on the score's time line, and the via points added to them."""

    coordinates: Coordinates
    limbs: Limbs
    curves: Mapping[str, LimbCurve]
    via_points: tuple[ViaPoint, ...] = ()

    def sample(self, times_s: Array) -> Array:
        """Return coordinates at increasing times, (T, V) radians, inside the limits."""
        out = np.empty((len(times_s), len(self.coordinates)))
        for limb, members in self.limbs.members.items():
            out[:, members] = self.curves[limb].sample(times_s)
        for via_point in self.via_points:
            via_point.add_to(out, times_s)
        return np.clip(out, self.coordinates.lower, self.coordinates.upper, out=out)

    @property
    def start_s(self) -> float:
        """When the first limb leaves its rest."""
        return min((c.start_s for c in self.curves.values() if c.keys), default=0.0)

    @property
    def end_s(self) -> float:
        """When the last limb is back at rest."""
        return max((c.end_s for c in self.curves.values() if c.keys), default=0.0)


@dataclass(frozen=True, slots=True, eq=False)
class Interpolation:
    """Joins key postures to a movement, limb by limb.

    limbs_in_use: limbs that something needs, by when. rest: (V,) where limbs are that nothing
    needs. hands_together: an arm and its fingers leave their rest and return to it in the same
    time; otherwise each limb takes its own. recorded: signs that are played meanwhile.
    """

    rig: Rig
    limbs: Limbs
    limbs_in_use: IntervalIndex[frozenset[str]]
    rest: Array
    hands_together: bool = True
    recorded: Sequence[RecordedBlock] = ()

    def through(self, postures: Iterable[KeyPosture]) -> Movement:
        """Return the movement through key postures: each limb goes through those that key it."""
        ordered = sorted(postures, key=lambda p: p.time)
        times = self._rest_s(ordered) if self.hands_together else {}
        curves = {}
        for limb, members in self.limbs.members.items():
            recorded = [block for block in self.recorded if limb in block.limbs]
            own = [
                p
                for p in ordered
                if limb in p.limbs and not any(block.plays(p.time) for block in recorded)
            ]
            held = [self._is_held(limb, a, b) for a, b in pairwise(own)]
            keys = [
                LimbKey(
                    float(p.time), p.coordinates[members], limb in p.passing, h,
                    times[p][limb] if times else None, _manner(limb, p),
                )
                for p, h in zip(own, [*held, False], strict=False)
            ]  # fmt: skip
            keys += [key for block in recorded for key in _recorded_keys(block, members)]
            keys.sort(key=lambda key: key.time_s)
            curves[limb] = limb_curve(keys, self.rest[members], self._onsets(limb))
        return Movement(self.rig.coordinates, self.limbs, curves)

    def _onsets(self, limb: str) -> Onsets | None:
        """Return when the coordinates of a limb set out; none if all do at once."""
        names = [self.rig.coordinates.names[v] for v in self.limbs.members[limb]]
        places = np.array([place_in_arm(name) for name in names])
        fingers = is_finger(limb)
        if not self.hands_together or not (fingers or places.any()):
            return None
        return Onsets(places, fingers)

    def _is_held(self, limb: str, a: KeyPosture, b: KeyPosture) -> bool:
        """Whether something needs a limb all the time from one of its keys to the next."""
        return any(
            a.holds(limb, needed) or b.holds(limb, needed)
            for needed in self.limbs_in_use.covering(Interval(a.time, b.time))
        )

    def _rest_s(self, postures: Sequence[KeyPosture]) -> dict[KeyPosture, dict[str, float]]:
        """Return the times from or to rest that limbs take together with what moves with them.

        The fingers form a handshape while the arm brings the hand there: all of a hand's limbs
        that a posture keys take as long as the slowest of them.
        """
        ways, members = self._wrist_ways_m(postures), self.limbs.members
        out = {}
        for posture in postures:
            q = posture.coordinates
            own = {
                limb: calm_transition_s(
                    q[members[limb]], self.rest[members[limb]], ways[posture].get(limb, 0.0)
                )
                for limb in posture.limbs
            }
            slowest: dict[str, float] = {}
            for limb, seconds in own.items():
                if channel_of_limb(limb) == "hands":
                    slowest[limb[-2:]] = max(seconds, slowest.get(limb[-2:], 0.0))
            out[posture] = {
                limb: slowest[limb[-2:]] if channel_of_limb(limb) == "hands" else seconds
                for limb, seconds in own.items()
            }
        return out

    def _wrist_ways_m(
        self, postures: Sequence[KeyPosture]
    ) -> dict[KeyPosture, Mapping[str, float]]:
        """Return the ways of the wrists between each posture and rest, by arm, metres.

        A way is as long as if it went all at the speed of its fastest part, of `WAY_PARTS` between
        postures at even shares of the transition: so bounds of speeds hold on all of it.
        """
        arms = {
            f"arm_{side}": self.rig.bones[f"palm_{side}"].origin_node
            for side in "LR"
            if f"palm_{side}" in self.rig.bones and f"arm_{side}" in self.limbs.members
        }
        out: dict[KeyPosture, Mapping[str, float]] = {}
        shares = np.linspace(0.0, 1.0, WAY_PARTS + 1)[:, None]
        for start in range(0, len(postures), AT_ONCE):
            some = postures[start : start + AT_ONCE]
            q = np.stack([self.rest + shares * (p.coordinates - self.rest) for p in some])
            at = kinematics.frames(self.rig.chain, q).positions[..., [*arms.values()], :]
            parts = np.linalg.norm(np.diff(at, axis=1), axis=-1)
            for posture, longest in zip(some, WAY_PARTS * parts.max(axis=1), strict=True):
                out[posture] = dict(zip(arms, longest.tolist(), strict=True))
        return out


def _recorded_keys(block: RecordedBlock, members: NDArray[np.int64]) -> Iterator[LimbKey]:
    """Yield the keys between which a limb plays a recording."""
    attack_s = float(block.body.start - block.interval.start)
    decay_s = float(block.interval.end - block.body.end)
    first = _recorded_key(block, members, block.start_s, attack_s)
    if block.start_s == block.end_s:
        yield replace(first, way_s=max(attack_s, decay_s))
        return
    yield replace(first, plays=partial(_played, block, members))
    yield _recorded_key(block, members, block.end_s, decay_s)


def _recorded_key(
    block: RecordedBlock, members: NDArray[np.int64], time_s: float, way_s: float
) -> LimbKey:
    state = block.state(time_s).part(members)
    neutral_s = max(way_s, SHORTEST_S)
    return LimbKey(time_s, state.values, state=state, way_s=way_s, neutral_s=neutral_s)


def _played(block: RecordedBlock, members: NDArray[np.int64], times_s: Array) -> Array:
    return block.sample(times_s)[:, members]


def _manner(limb: str, posture: KeyPosture) -> Manner | None:
    """Return how a limb arrives at a posture: as a block says that begins there and moves it."""
    for task in posture.timed_tasks:
        begins = task.requirement.manner is not None and task.interval.start == posture.time
        if begins and limb in task.limbs:
            return task.requirement.manner
    return None
