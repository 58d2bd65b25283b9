"""The ways of arms from one thing that is asked of them to the next."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.quality.kinematics import FPS, SIDES, Kinematics
from azee.quality.signing_dynamics import STOPPED_M_S, runs, speeds
from azee.quality.task_spans import TaskSpan, asked_to_move
from azee.quality.wrists import SPEED_AT

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

ONSET = 0.1
"""A movement begins and ends where its speed is this share of its largest (usual in reaching)."""
LEAST_WAY_M = 0.02
"""A shorter way is no transition."""
LEAST_TURN_DEG = 5.0
"""A joint that turns less in a transition has no onset worth measuring."""
LEAST_PAIRS = 4
"""Transitions that a correlation needs."""
TELLABLE_S = 2.0 / FPS
"""Times that differ by no more are the same: two frames, to which either end is known."""
JOINTS = {
    "shoulder": ("arm_{side}.flexion", "arm_{side}.abduction", "arm_{side}.rotation"),
    "elbow": ("f_arm_{side}.flexion", "f_arm_{side}.pronation"),
    "wrist": ("palm_{side}.flexion", "palm_{side}.deviation"),
}
"""Joints of an arm from the trunk on, and their coordinates."""


@dataclass(frozen=True, slots=True)
class Transition:
    """An arm's way from one thing that is asked of it to the next, on the score's time line.

    distance_m: from where the wrist starts to where it ends, straight. onset_spread_ms: from the
    first joint that starts to turn to the last, none if fewer than two turn `LEAST_TURN_DEG`.
    """

    side: str
    start_s: float
    end_s: float
    distance_m: float
    onset_spread_ms: float | None

    @property
    def duration_s(self) -> float:
        """How long it takes."""
        return self.end_s - self.start_s


def transitions(k: Kinematics, spans: Sequence[TaskSpan]) -> tuple[Transition, ...]:
    """Find the transitional movements of both arms, but for those from and to rest.

    Where no movement is asked of the arm, between the first and the last time that anything is, a
    run of speeds above `STOPPED_M_S` is a transition; it begins and ends where the speed is `ONSET`
    of its largest. Of runs whose extents overlap, such as those of a slow movement that dips below
    `STOPPED_M_S`, the fastest counts. For a minimum-jerk movement of T seconds these are .0864 T
    and .9136 T, from 30 τ²(1 − τ)² = .1 · 1.875.
    """
    found = [t for side in SIDES for t in _transitions(k, spans, side)]
    return tuple(sorted(found, key=lambda t: (t.start_s, t.side)))


def _transitions(k: Kinematics, spans: Sequence[TaskSpan], side: str) -> Iterator[Transition]:
    limb = f"arm_{side}"
    own = [s for s in spans if s.concerns(limb)]
    wrist = k.wrist(side)
    speed = speeds(wrist, k.fps)
    if not own or not len(speed):
        return
    times = k.times_s[0] + (SPEED_AT + np.arange(len(speed))) / k.fps
    first, last = min(s.start_s for s in own), max(s.end_s for s in own)
    free = ~asked_to_move(spans, limb, times)
    tops = []
    for run in runs((speed > STOPPED_M_S) & free & (first <= times) & (times <= last)):
        if times[run[0]] - first < 1.0 / k.fps or last - times[run[-1]] < 1.0 / k.fps:
            continue  # from or to rest
        tops.append(int(run[int(speed[run].argmax())]))
    taken = np.zeros(len(speed), dtype=np.bool_)
    for top in sorted(tops, key=lambda i: -speed[i]):
        start, end = _extent(speed, top, ONSET * speed[top], free)
        if taken[start : end + 1].any():
            continue
        taken[start : end + 1] = True
        # A speed lies half-way between its frames.
        a, b = start + 1, min(end + 2, len(wrist) - 1)
        way = float(np.linalg.norm(wrist[b] - wrist[a]))
        if way >= LEAST_WAY_M:
            yield Transition(
                side,
                float(k.times_s[a]),
                float(k.times_s[b]),
                way,
                _onset_spread_ms(k, side, a, b),
            )


def _extent(speed: Array, top: int, least: float, inside: Mask) -> tuple[int, int]:
    """Return the indices of the first and the last speed around a peak above a least one."""
    start = end = top
    while start > 0 and inside[start - 1] and speed[start - 1] > least:
        start -= 1
    while end < len(speed) - 1 and inside[end + 1] and speed[end + 1] > least:
        end += 1
    return start, end


def _onset_spread_ms(k: Kinematics, side: str, start: int, end: int) -> float | None:
    """Time from the first joint's onset to the last one's, in a movement between two frames.

    A joint's speed is the root of the sum of the squared speeds of its coordinates; its onset is
    where the speed that leads to its largest one in the movement passes `ONSET` of that, between
    two frames by a straight line.
    """
    names = k.rig.coordinates.index
    onsets = []
    for coordinates in JOINTS.values():
        columns = [names[n] for c in coordinates if (n := c.format(side=side)) in names]
        turned = np.degrees(np.abs(k.q[end, columns] - k.q[start, columns]))
        if not len(turned) or turned.max() < LEAST_TURN_DEG:
            continue
        speed = np.linalg.norm(k.speed_deg_s[:, columns], axis=1)
        top = start + int(speed[start : end + 1].argmax())
        least = ONSET * speed[top]
        below = top
        while below > 0 and speed[below] > least:
            below -= 1
        rise = speed[below + 1] - speed[below]
        share = (least - speed[below]) / rise if rise > 0.0 and speed[below] <= least else 0.0
        onsets.append((below + share) / k.fps)
    return 1e3 * float(max(onsets) - min(onsets)) if len(onsets) > 1 else None


def correlation(found: Sequence[Transition]) -> float | None:
    """Return Pearson's correlation of duration and distance, none for few transitions.

    0 where all take equally long.
    """
    if len(found) < LEAST_PAIRS:
        return None
    duration = np.array([t.duration_s for t in found])
    if np.ptp(duration) <= TELLABLE_S + 1e-9:
        return 0.0
    distance = np.array([t.distance_m for t in found])
    duration, distance = duration - duration.mean(), distance - distance.mean()
    size = float(np.linalg.norm(duration) * np.linalg.norm(distance))
    return float(duration @ distance) / size if size > 0.0 else 0.0
