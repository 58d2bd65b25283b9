"""Blinks: when eyes blink while somebody signs, and how lids move then.

Intervals between blinks are log-normal, as rates of spontaneous blinks are (Bentivoglio et al.
1997). Most blinks of signers mark the end of a phrase (Wilbur 1994; 70 % of them in Herrmann
2010), and large shifts of gaze come with a blink that starts with the head (Evinger et al. 1994):
a blink that falls near such a boundary goes there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.overlay.face import is_active
from azee.motion.tasks.limbs import NON_MANUAL
from azee.motion.tasks.signs import signs
from azee.motion.tasks.timed_task import TimedTask
from azee.score.score import Score
from azee_rig.coordinates import Coordinates
from azee_solver.constraint import Morph
from azee_solver.geometry import Side

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

BLINK = "AU43"
LIDS = ("AU5", "AU7", BLINK)
"""Facial morphs that move the lids: eyes do not blink while one of their units shows."""

MEDIAN_GAP_S, SPREAD = 2.6, 0.5
"""Median of the intervals, and deviation of their logarithm, on average 2.9 s: 20 blinks a minute,
between the 17 of people at rest and the 26 of people who talk (Bentivoglio et al. 1997). The
deviation is ours."""
SHORTEST_GAP_S = 1.0
"""Between the starts of two blinks."""
CLOSE_S, OPEN_S = 0.07, 0.13

TO_BOUNDARY = 0.8
"""Share of the blinks that go to a boundary if one is near."""
NEAR_S = 1.5
"""A boundary is near within this time."""
JITTER_S = 0.05
"""Blinks start as much as this before or after their boundary."""

SHIFT_RAD = math.radians(25.0)
"""A shift of gaze that is larger is a boundary. Of those beyond 33° 97 % come with a blink (Evinger
et al. 1994); the nods and shakes of negations are smaller."""
SHIFT_RAD_S = math.radians(30.0)
"""Gaze that is faster shifts."""
_SHIFTS: tuple[Mapping[str, float], ...] = (
    {
        **dict.fromkeys(("back_1.axial", "back_2.axial", "neck.axial", "head.axial"), 1.0),
        **dict.fromkeys(("eye_L.yaw", "eye_R.yaw"), 0.5),
    },
    {
        **dict.fromkeys(("back_1.flexion", "back_2.flexion", "neck.flexion", "head.flexion"), -1.0),
        **dict.fromkeys(("eye_L.pitch", "eye_R.pitch"), 0.5),
    },
)
"""What yaw and pitch of the gaze are the sum of, for as long as nobody is bent far."""


def blinks(
    units: Mapping[str, float],
    names: Sequence[str],
    busy: Mask,
    boundaries_s: Sequence[float],
    times_s: Array,
    rng: np.random.Generator,
) -> Array:
    """Return the weights that blinks add to face units at times, (T, len(names)).

    Args: units: weights of the units that close the eyes. busy: (T,) whether the face needs the
        lids; a blink that would coincide waits until it does not. boundaries_s: increasing.
    """
    out = np.zeros((len(times_s), len(names)))
    for start in blink_times(busy, boundaries_s, times_s, rng):
        rows = slice(*np.searchsorted(times_s, (start, start + CLOSE_S + OPEN_S)))
        since = times_s[rows] - start
        curve = minimum_jerk(since / CLOSE_S) - minimum_jerk((since - CLOSE_S) / OPEN_S)
        for unit, weight in units.items():
            out[rows, names.index(unit)] += weight * curve
    return out


def blink_times(
    busy: Mask, boundaries_s: Sequence[float], times_s: Array, rng: np.random.Generator
) -> list[float]:
    """Return when blinks start, increasing; the last one ends before the last time."""
    found: list[float] = []
    last = float(times_s[0]) - rng.uniform() * _gap_s(rng)
    boundaries = np.asarray(boundaries_s, dtype=np.float64)
    while True:
        # Each blink draws three numbers, so that one blink more does not move all that follow.
        drawn = last + _gap_s(rng)
        marks, jitter = rng.uniform() < TO_BOUNDARY, rng.uniform(-JITTER_S, JITTER_S)
        start = drawn
        if marks and len(boundaries):
            near = float(boundaries[np.abs(boundaries - drawn).argmin()])
            if abs(near - drawn) <= NEAR_S and near + jitter - last >= SHORTEST_GAP_S:
                start = near + jitter
        start = _when_free(max(start, float(times_s[0])), busy, times_s)
        if start + CLOSE_S + OPEN_S >= times_s[-1]:
            return found
        found.append(start)
        last = start


def _gap_s(rng: np.random.Generator) -> float:
    return max(SHORTEST_GAP_S, float(MEDIAN_GAP_S * rng.lognormal(0.0, SPREAD)))


def _when_free(start: float, busy: Mask, times_s: Array) -> float:
    """Return the first time from a start on at which the lids are free for a whole blink."""
    taken = times_s[busy & (times_s >= start)]
    ends = start + CLOSE_S + OPEN_S
    for time in taken:
        if time > ends:
            break
        start = math.nextafter(float(time), math.inf)
        ends = start + CLOSE_S + OPEN_S
    return start


def lids_busy(
    facial_morphs: Iterable[TimedTask],
    morphs: Mapping[str, Mapping[str, float]],
    dominant: Side,
    times_s: Array,
) -> Mask:
    """Whether a facial block moves the lids at times, (T,).

    Args: morphs: weight that a morph of weight 1 gives each unit, as a rig has it.
    """
    lids = {unit for name in LIDS for unit in morphs.get(name, {})}

    def moves_lids(task: TimedTask) -> bool:
        assert isinstance(task.constraint, Morph)
        return not lids.isdisjoint(morphs[task.constraint.key(dominant)])

    return is_active(filter(moves_lids, facial_morphs), times_s)


def boundaries(
    score: Score, tasks: Iterable[TimedTask], q: Array, times_s: Array, coordinates: Coordinates
) -> list[float]:
    """Return the instants at which eyes tend to blink: ends of signs, and starts of gaze shifts.

    Args: tasks: all tasks of the score. q: (T, V) the movement at times on the score's time line.
    """
    manual = (t.path for t in tasks if t.limb not in NON_MANUAL)
    ends = {sign.end_s for sign in signs(score, manual)}
    return sorted(ends.union(gaze_shifts(q, times_s, coordinates)))


def gaze_shifts(q: Array, times_s: Array, coordinates: Coordinates) -> list[float]:
    """Return when large shifts of gaze start, by the sum of what turns trunk, head and eyes."""
    found = []
    for shares in _SHIFTS:
        angle = np.zeros(len(q))
        for name, share in shares.items():
            if name in coordinates.index:
                angle += share * q[:, coordinates.index[name]]
        speed = np.diff(angle) / np.diff(times_s)
        way = np.where(np.abs(speed) > SHIFT_RAD_S, np.sign(speed), 0.0)
        edges = np.flatnonzero(np.diff(way, prepend=0.0, append=0.0))
        for a, b in pairwise(edges.tolist()):
            if way[a] and abs(angle[b] - angle[a]) > SHIFT_RAD:
                found.append(float(times_s[a]))
    return found
