"""How fast joints turn, how long they are still, and how near to their limits they come."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from azee.motion.tasks.limbs import limb_of_coordinate
from azee.quality.kinematics import Extreme, Kinematics
from azee.quality.signing_dynamics import longest_run, runs
from azee.quality.task_spans import TaskSpan, asked, asked_to_move

Part = Literal["arm", "trunk", "head", "fingers"]

FAST_DEG_S = 600.0
"""Arm joints of people who sign turn no faster; a posture that is held not nearly so fast."""
STILL_DEG_S = 0.2
"""A coordinate that moves slower is still: nobody sees it move."""
NEAR_LIMIT_DEG = 1.0


def largest_joint_speed(k: Kinematics, part: Part) -> Extreme | None:
    """Return the fastest coordinate of a part of the body, °/s: |Δq| · fps between two frames."""
    columns = k.columns(part)
    if not len(columns) or not len(k.speed_deg_s):
        return None
    speed = k.speed_deg_s[:, columns]
    row, column = np.unravel_index(int(speed.argmax()), speed.shape)
    name = k.rig.coordinates.names[columns[column]]
    return Extreme(float(speed[row, column]), name, float(k.between_s[row]))


@dataclass(frozen=True, slots=True)
class UnaskedTurn:
    """A joint that turns fast while a block asks it to stay, on the score's time line.

    at_s: when it is fastest. path: of the block, the last to start if there are several.
    """

    coordinate: str
    speed_deg_s: float
    at_s: float
    path: tuple[str, ...]


def unasked_turns(k: Kinematics, spans: Sequence[TaskSpan]) -> tuple[UnaskedTurn, ...]:
    """Find arms and fingers that are faster than `FAST_DEG_S` where nothing asks for a change.

    That is: something is asked of the limb, the same in both frames, and nothing of it is a
    movement. Of a run of such frames the fastest coordinate is told.
    """
    found = []
    before, after = k.times_s[:-1], k.times_s[1:]
    limbs = dict.fromkeys(limb_of_coordinate(n) for n in k.rig.coordinates.names)
    for limb in limbs:
        own = [s for s in spans if s.concerns(limb)]
        if not own or limb in ("trunk", "head", "eyes"):
            continue
        columns = k.columns(limb)
        fastest = k.speed_deg_s[:, columns].max(axis=1)
        steady = asked(own, limb, before) & asked(own, limb, after)
        steady &= ~asked_to_move(spans, limb, before) & ~asked_to_move(spans, limb, after)
        for s in own:
            steady &= s.during(before) == s.during(after)
        for run in runs(steady & (fastest > FAST_DEG_S)):
            top = int(run[int(fastest[run].argmax())])
            v = columns[int(k.speed_deg_s[top, columns].argmax())]
            at = float(k.between_s[top])
            span = max((s for s in own if s.start_s <= at <= s.end_s), key=lambda s: s.start_s)
            name = k.rig.coordinates.names[v]
            found.append(UnaskedTurn(name, float(fastest[top]), at, span.path))
    return tuple(sorted(found, key=lambda t: (t.at_s, t.coordinate)))


def longest_stillness_s(k: Kinematics, *limbs: str) -> float:
    """Return the longest time that no coordinate of some limbs exceeds `STILL_DEG_S`, seconds.

    `body` stands for all limbs but the fingers.
    """
    wanted = ("trunk", "head", "eyes", "arm") if limbs == ("body",) else limbs
    still = np.all(k.speed_deg_s[:, k.columns(*wanted)] < STILL_DEG_S, axis=1)
    return longest_run(still) / k.fps


@dataclass(frozen=True, slots=True)
class AtLimits:
    """How often a coordinate of trunk, head, arms or wrists is within 1° of its limit.

    share: of frames in which any is. coordinates: those that are, by their own shares.
    """

    share: float
    coordinates: Mapping[str, float]


def at_limits(k: Kinematics) -> AtLimits:
    """Measure how often limits are reached; fingers are left out, which rest at theirs."""
    columns, limits = k.columns("trunk", "head", "arm"), k.rig.coordinates
    room = np.minimum(k.q - limits.lower, limits.upper - k.q)[:, columns]
    near = np.degrees(room) <= NEAR_LIMIT_DEG
    shares = near.mean(axis=0)
    names = {limits.names[v]: float(s) for v, s in zip(columns, shares, strict=True) if s > 0.0}
    return AtLimits(float(near.any(axis=1).mean()), names)
