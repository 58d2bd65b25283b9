"""Where the trunk leans, and what the head does while the eyes look at something."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.quality.kinematics import SIDES, Extreme, Kinematics, angle_deg
from azee.quality.signing_dynamics import longest_run
from azee.quality.task_spans import TaskSpan, asked
from azee_solver.constraint import Look, LookAt, Rotate, Trill
from azee_solver.geometry import Vec

Array = NDArray[np.float64]

FAR_GAZE_DEG = 20.0
"""Eyes that look farther to a side are soon followed by the head."""
BACK_DEG = 5.0
"""A head that is turned less against the trunk has come back."""


def trunk_displacement(k: Kinematics) -> Extreme:
    """Return the largest angle between the upper trunk and its neutral orientation, degrees."""
    angle = angle_deg(k.rotation("back_2"))
    top = int(angle.argmax())
    return Extreme(float(angle[top]), "back_2", float(k.times_s[top]))


def head_roll_deg(k: Kinematics) -> Array:
    """Return how far the line through the ears is from level, (T,) degrees, to the right positive.

    arcsin of its rise: the roll that is left when the head is turned and pitched first, which
    Donders' law keeps small while somebody looks around.
    """
    return np.asarray(np.degrees(np.arcsin(np.clip(k.rotation("head")[:, 1, 0], -1.0, 1.0))))


@dataclass(frozen=True, slots=True)
class HeadUnderGaze:
    """What the head does while the score directs the gaze, and after.

    roll_deg: the largest roll beyond what rotations of the head ask for. return_s: the longest time
    from the end of such a block until the head is turned less than `BACK_DEG` against the trunk.
    """

    roll_deg: Extreme | None
    return_s: float | None


def head_under_gaze(k: Kinematics, spans: Sequence[TaskSpan]) -> HeadUnderGaze:
    """Measure the head while blocks direct the gaze, and its return after them.

    What rotations of head and neck ask for meanwhile (a shake, a tilt) is allowed on top: their
    angles for the turn of the head, the parts of their angles about the axis that points forward
    for its roll. Where the score fixes the head by other means there is nothing to measure. The
    return is measured until the next block that directs the gaze or fixes the head, or the end.
    """
    gazes = [s for s in spans if isinstance(s.constraint, Look | LookAt)]
    rotations = [s for s in spans if s.limb == "head" and isinstance(s.constraint, Rotate)]
    fixed = [s for s in spans if s.limb == "head" and not isinstance(s.constraint, Rotate | Trill)]
    turn, roll = (_asked_deg(k, rotations, only_roll) for only_roll in (False, True))
    directed = asked(gazes, "eyes", k.times_s) & ~asked(fixed, "head", k.times_s)
    rows = np.flatnonzero(directed)
    largest = None
    if len(rows):
        beyond = np.maximum(np.abs(head_roll_deg(k)) - roll, 0.0)
        top = int(rows[int(beyond[rows].argmax())])
        largest = Extreme(float(beyond[top]), "head", float(k.times_s[top]))
    trunk = k.rotation("back_2")
    away = angle_deg(np.swapaxes(trunk, -1, -2) @ k.rotation("head")) > BACK_DEG + turn
    waits = [w for g in gazes if (w := _return_s(k, g, [*gazes, *fixed], away)) is not None]
    return HeadUnderGaze(largest, max(waits, default=None))


def _asked_deg(k: Kinematics, rotations: Sequence[TaskSpan], only_roll: bool) -> Array:
    """Angle that rotations of the head ask for, (T,) degrees, or its part about the third axis."""
    out = np.zeros(len(k.times_s))
    for s in rotations:
        assert isinstance(s.constraint, Rotate)
        share, axis = 1.0, s.constraint.axis
        if only_roll and isinstance(axis, Vec):
            share = abs(axis.z) / max(math.hypot(axis.x, axis.y, axis.z), 1e-12)
        out += share * math.degrees(abs(s.constraint.angle_rad)) * s.during(k.times_s)
    return out


def _return_s(
    k: Kinematics, gaze: TaskSpan, others: Sequence[TaskSpan], away: NDArray[np.bool_]
) -> float | None:
    """Time from the end of a gaze until the head is back; none where another takes over."""
    if any(o is not gaze and o.start_s <= gaze.end_s < o.end_s for o in others):
        return None
    until = min((o.start_s for o in others if o.start_s >= gaze.end_s), default=math.inf)
    after = np.flatnonzero((k.times_s >= gaze.end_s) & (k.times_s <= until))
    if not len(after):
        return None
    back = after[~away[after]]
    row = back[0] if len(back) else after[-1]
    return max(0.0, float(k.times_s[row]) - gaze.end_s) if away[after[0]] else 0.0


def longest_far_gaze_s(k: Kinematics) -> float:
    """Return the longest time that an eye looks more than `FAR_GAZE_DEG` away from straight ahead.

    The angle is arccos(cos yaw · cos pitch), in the head.
    """
    names = k.rig.coordinates.index
    far = np.zeros(len(k.times_s), dtype=bool)
    for side in SIDES:
        columns = [names[n] for n in (f"eye_{side}.yaw", f"eye_{side}.pitch") if n in names]
        far |= np.degrees(np.arccos(np.cos(k.q[:, columns]).prod(axis=1))) > FAR_GAZE_DEG
    return longest_run(far) / k.fps
