"""The whole body's movement: every limb's track through the key postures that key it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.limb_curves import LimbKey, LimbTrack, track, unhurried_s
from azee.motion.curves.via_points import Swerve
from azee.motion.tasks.limbs import Limbs, channel_of_limb
from azee.motion.tasks.posture import KeyPosture
from azee.motion.tasks.spans import Spans
from azee.score.interval import Interval
from azee_rig.coordinates import Coordinates

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Movement:
    """Tracks of all limbs, by name, on the score's time line, and detours laid on them."""

    coordinates: Coordinates
    limbs: Limbs
    tracks: Mapping[str, LimbTrack]
    swerves: tuple[Swerve, ...] = ()

    def sample(self, times_s: Array) -> Array:
        """Return coordinates at increasing times, (T, V) radians, inside the limits."""
        out = np.empty((len(times_s), len(self.coordinates)))
        for limb, members in self.limbs.members.items():
            out[:, members] = self.tracks[limb].sample(times_s)
        for swerve in self.swerves:
            swerve.add_to(out, times_s)
        return np.clip(out, self.coordinates.lower, self.coordinates.upper, out=out)

    @property
    def start_s(self) -> float:
        """When the first limb leaves its rest."""
        return min((t.start_s for t in self.tracks.values() if t.keys), default=0.0)

    @property
    def end_s(self) -> float:
        """When the last limb has come to rest."""
        return max((t.end_s for t in self.tracks.values() if t.keys), default=0.0)


def movement(
    postures: Sequence[KeyPosture],
    holders: Spans[frozenset[str]],
    coordinates: Coordinates,
    limbs: Limbs,
    *,
    together: bool = True,
) -> Movement:
    """Join key postures, in order of time, limb by limb.

    Args: holders: limbs that something needs, by when. together: an arm and its fingers come from
        rest and go back in the same time; else each limb takes its own.
    """
    tracks = {}
    for limb, members in limbs.members.items():
        own = [p for p in postures if limb in p.limbs]
        held = [
            any(
                a.holds(limb, needed) or b.holds(limb, needed)
                for needed in holders.all_through(Interval(a.time, b.time))
            )
            for a, b in pairwise(own)
        ]
        ways = [_way_s(p, limb, coordinates, limbs) if together else None for p in own]
        keys = [
            LimbKey(float(p.time), p.coordinates[members], limb in p.passing, h, way)
            for p, h, way in zip(own, [*held, False], ways, strict=False)
        ]
        tracks[limb] = track(keys, coordinates.idle[members])
    return Movement(coordinates, limbs, tracks)


def _way_s(posture: KeyPosture, limb: str, coordinates: Coordinates, limbs: Limbs) -> float:
    """Time from or to rest that a limb takes together with what moves with it.

    Fingers form a handshape while the arm brings the hand there.
    """
    side = channel_of_limb(limb) == "hands" and limb[-2:]
    q, idle = posture.coordinates, coordinates.idle
    found = [
        unhurried_s(q[members], idle[members])
        for other, members in limbs.members.items()
        if other == limb
        or (
            side
            and channel_of_limb(other) == "hands"
            and other[-2:] == side
            and other in posture.limbs
        )
    ]
    return max(found)
