"""When signs follow each other, and when the eyes blink."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.motion.overlay.blinks import BLINK
from azee.motion.tasks.limbs import NON_MANUAL
from azee.motion.tasks.signs import Sign, signs
from azee.quality.kinematics import Kinematics
from azee.quality.signing_dynamics import runs
from azee.quality.task_spans import TaskSpan
from azee.score.score import Score

Array = NDArray[np.float64]

CLOSED = 0.5
"""Lids that are down by more than this share of a blink are closed."""
LONGEST_BLINK_S = 0.4
"""Eyes that stay closed for longer do not blink."""
BOUNDARY_S = 0.15
"""As near as this to the start or the end of a sign a blink is at its boundary."""


def signs_of(score: Score, spans: Sequence[TaskSpan]) -> tuple[Sign, ...]:
    """Return the signs of a score in order; the whole is one if no rule makes one.

    Args: spans: what the score asks, to tell signs from what heads and faces do.
    """
    manual = [s for s in spans if s.limb not in NON_MANUAL]
    found = signs(score, (s.path for s in manual))
    if found or not manual:
        return found
    return (Sign("", min(s.start_s for s in manual), max(s.end_s for s in manual)),)


def signs_per_s(found: Sequence[Sign]) -> float | None:
    """Return the number of signs by the time from the first one's start to the last one's end."""
    if not found:
        return None
    length = max(s.end_s for s in found) - found[0].start_s
    return len(found) / length if length > 0.0 else None


@dataclass(frozen=True, slots=True)
class Blinks:
    """How often eyes blink, and when.

    at_boundaries_share: of the blinks while signs last, from the first to the last, those within
    `BOUNDARY_S` of a sign's start or end, or between two signs; none where there are no blinks.
    boundaries_share: share of that time that these boundaries take, which is what blinks at any
    time would have.
    """

    times_s: tuple[float, ...]
    per_minute: float
    at_boundaries_share: float | None
    boundaries_share: float | None


def blinks(k: Kinematics, found: Sequence[Sign]) -> Blinks:
    """Find runs of closed lids that are no longer than `LONGEST_BLINK_S`.

    Lids are closed as far as all units of the face that a blink is made of are, without what they
    do to follow the eyes.
    """
    times = tuple(float(k.times_s[row]) for row in _blinks(k))
    minutes = len(k.times_s) / k.fps / 60.0
    at, taken = None, None
    if found:
        near = _near_boundaries(k.times_s, found)
        first, last = found[0].start_s - BOUNDARY_S, max(s.end_s for s in found) + BOUNDARY_S
        signing = (first <= k.times_s) & (k.times_s <= last)
        taken = float(near[signing].mean())
        rows = np.searchsorted(k.times_s, [t for t in times if first <= t <= last])
        at = float(near[rows].mean()) if len(rows) else None
    return Blinks(times, len(times) / minutes, at, taken)


def _blinks(k: Kinematics) -> Iterator[int]:
    closing = k.rig.face_morphs.get(BLINK, {})
    if not closing or not set(closing) <= set(k.units):
        return
    following = k.rig.lid_weights(k.q)
    lids = [
        (k.unit_weights[:, k.units.index(unit)] - following.get(unit, 0.0)) / weight
        for unit, weight in closing.items()
    ]
    closed = np.min(lids, axis=0)
    for run in runs(closed > CLOSED):
        if len(run) <= LONGEST_BLINK_S * k.fps:
            yield int(run[int(closed[run].argmax())])


def _near_boundaries(times_s: Array, found: Sequence[Sign]) -> NDArray[np.bool_]:
    near = np.zeros(len(times_s), dtype=bool)
    inside = np.zeros(len(times_s), dtype=bool)
    for sign in found:
        for edge in (sign.start_s, sign.end_s):
            near |= np.abs(times_s - edge) <= BOUNDARY_S
        inside |= (sign.start_s <= times_s) & (times_s <= sign.end_s)
    first, last = found[0].start_s, max(s.end_s for s in found)
    return np.asarray(near | (~inside & (first <= times_s) & (times_s <= last)))
