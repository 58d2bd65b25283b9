"""A reconstructed hand as a clip of a body: shown alone, or laid over a movement of the body.

Laying recorded hands over a movement of the whole body is called hand-over animation (Wheatland
2016, chapter 3).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from azee.capture.hand import Hand
from azee.capture.markers import Floats, MarkersError
from azee.capture.reconstruction import Reconstruction
from azee.clip.clip import Clip
from azee.clip.resample import at_rate
from azee.clip.spline import minimum_jerk
from azee_rig.rig import Rig
from azee_solver.constraint import BoneAxis, Constraint, Orient, Place, Relation
from azee_solver.geometry import Bone, JointPoint, Side, Site, Vec, VTranslate
from azee_solver.solve import solve
from azee_solver.task import Task

SHOWN_AT = (0.03, -0.02, 0.26)
"""Where the wrist of a hand that is shown is from its shoulder: outwards, up and forwards, metres
of the reference signer."""
BLEND_S = 0.2
"""In so long a hand comes out of the movement that it is laid over, and goes back into it."""


def hand_clip(made: Reconstruction, hand: Hand, body: Rig) -> Clip:
    """Return a clip in which a body shows the hand before its shoulder, the palm forwards.

    Args: hand: whose postures `made` has. body: that plays; its limits hold.
    """
    q = np.tile(_showing(body, hand.side), (len(made.postures), 1))
    whole = np.ones(len(q))
    return _clip(np.arange(len(q)) / made.rate_hz, _laid(q, made.postures, whole, hand, body))


def hand_over(
    made: Reconstruction, hand: Hand, body: Rig, over: Clip, start_s: float = 0.0
) -> Clip:
    """Return a movement with the digits of a reconstruction from a time on, at its rate.

    Face, labels and everything but the digits of that hand stay as they are.

    Raises: MarkersError: the hand is not recorded at any time of the movement.
    """
    moved = at_rate(over, made.rate_hz, body.coordinates)
    own = start_s + np.arange(len(made.postures)) / made.rate_hz
    times = moved.times
    if own[-1] < times[0] or own[0] > times[-1]:
        raise MarkersError(
            f"the movement lasts from {times[0]:g} s to {times[-1]:g} s, "
            f"the hand from {own[0]:g} s to {own[-1]:g} s"
        )
    place = np.interp(times, own, np.arange(len(own)))
    before, share = np.floor(place).astype(np.int64), (place % 1.0)[:, None]
    after = np.minimum(before + 1, len(own) - 1)
    postures = (1.0 - share) * made.postures[before] + share * made.postures[after]
    inside = np.minimum(times - own[0], own[-1] - times)
    at_ends = (own[0] <= times[0]) & (times - times[0] < BLEND_S)
    at_ends |= (own[-1] >= times[-1]) & (times[-1] - times < BLEND_S)
    weight = np.where(at_ends & (inside >= 0.0), 1.0, np.clip(inside / BLEND_S, 0.0, 1.0))
    q = _laid(np.array(moved.coordinates), postures, minimum_jerk(weight), hand, body)
    return Clip(times, q, moved.units, moved.unit_weights, moved.labels)


def _laid(q: Floats, postures: Floats, weight: Floats, hand: Hand, body: Rig) -> Floats:
    """Lay the digits of postures over those of q (T, V) with a weight (T,), inside the limits."""
    c = body.coordinates
    names = [hand.body.coordinates.names[v] for v in hand.columns]
    for name, v in zip(names, hand.columns, strict=True):
        if name in c.index:
            k = c.index[name]
            q[:, k] = (1.0 - weight) * q[:, k] + weight * postures[:, v]
    return np.clip(q, c.lower, c.upper)


def _clip(times: Floats, q: Floats) -> Clip:
    return Clip(times, q, (), np.zeros((len(times), 0)))


@lru_cache(maxsize=8)
def _showing(body: Rig, side: str) -> Floats:
    """Return the posture (V,) of a body that holds a hand up, the palm forwards."""
    own = Side.RIGHT if side == "R" else Side.LEFT
    sign = -1.0 if side == "R" else 1.0
    outwards, up, forwards = SHOWN_AT
    palm, arm = Bone("palm", own), Bone("arm", own)
    at = VTranslate(JointPoint(arm), Vec(sign * outwards, up, forwards))
    asked: tuple[Constraint, ...] = (
        Place(Site("WR", own), at),
        Orient(BoneAxis.DIR, palm, Relation.ALONG, Vec(0.0, 1.0, 0.0)),
        Orient(BoneAxis.NRM, palm, Relation.ALONG, Vec(0.0, 0.0, 1.0)),
    )
    idle = body.coordinates.idle
    tasks = [Task(constraint, rank=n) for n, constraint in enumerate(asked)]
    return solve(body, tasks, dominant=own, start=idle, reference=idle).coordinates
