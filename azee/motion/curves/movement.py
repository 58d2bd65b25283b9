"""The whole body's movement: a curve for every limb, and via points added to them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.limb_curves import LimbCurve, LimbKey, calm_transition_s, limb_curve
from azee.motion.curves.via_points import ViaPoint
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.key_posture import KeyPosture
from azee.motion.tasks.limbs import Limbs, channel_of_limb
from azee.score.interval import Interval
from azee_rig.coordinates import Coordinates
from azee_rig.rig import Rig

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
    time; otherwise each limb takes its own.
    """

    rig: Rig
    limbs: Limbs
    limbs_in_use: IntervalIndex[frozenset[str]]
    rest: Array
    hands_together: bool = True

    def through(self, postures: Iterable[KeyPosture]) -> Movement:
        """Return the movement through key postures: each limb goes through those that key it."""
        ordered = sorted(postures, key=lambda p: p.time)
        ways = self._wrist_ways_m(ordered) if self.hands_together else {}
        curves = {}
        for limb, members in self.limbs.members.items():
            own = [p for p in ordered if limb in p.limbs]
            held = [self._is_held(limb, a, b) for a, b in pairwise(own)]
            keys = [
                LimbKey(
                    float(p.time), p.coordinates[members], limb in p.passing, h,
                    self._rest_s(p, limb, ways[p]) if self.hands_together else None,
                )
                for p, h in zip(own, [*held, False], strict=False)
            ]  # fmt: skip
            curves[limb] = limb_curve(keys, self.rest[members])
        return Movement(self.rig.coordinates, self.limbs, curves)

    def _is_held(self, limb: str, a: KeyPosture, b: KeyPosture) -> bool:
        """Whether something needs a limb all the time from one of its keys to the next."""
        return any(
            a.holds(limb, needed) or b.holds(limb, needed)
            for needed in self.limbs_in_use.covering(Interval(a.time, b.time))
        )

    def _rest_s(self, posture: KeyPosture, limb: str, ways_m: Mapping[str, float]) -> float:
        """Time from or to rest that a limb takes together with what moves with it.

        The fingers form a handshape while the arm brings the hand there: all of a hand's limbs
        that the posture keys take as long as the slowest of them.

        Args: ways_m: of the wrist from or to rest, by arm.
        """
        q, rest = posture.coordinates, self.rest
        hand = channel_of_limb(limb) == "hands" and limb[-2:]
        return max(
            calm_transition_s(q[members], rest[members], ways_m.get(other, 0.0))
            for other, members in self.limbs.members.items()
            if other == limb
            or (
                hand
                and channel_of_limb(other) == "hands"
                and other[-2:] == hand
                and other in posture.limbs
            )
        )

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
            at = self.rig.chain.frames(q).positions[..., [*arms.values()], :]
            parts = np.linalg.norm(np.diff(at, axis=1), axis=-1)
            for posture, longest in zip(some, WAY_PARTS * parts.max(axis=1), strict=True):
                out[posture] = dict(zip(arms, longest.tolist(), strict=True))
        return out
