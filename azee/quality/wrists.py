"""How fast wrists go, on the paths of signs and between them, and how far they are bent."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from azee.quality.kinematics import SIDES, Extreme, Kinematics
from azee.quality.signing_dynamics import accelerations, speeds
from azee.quality.task_spans import TaskSpan, asked_to_move

Array = NDArray[np.float64]
Manner = Literal["transitional", "lexical"]

BENT_DEG = 35.0
"""Wrists of people are bent farther only where they must be."""
SPEED_AT, ACCELERATION_AT = 1.5, 2.0
"""Frames from the first frame to the first speed and acceleration of averaged positions."""


def largest_wrist_speed(k: Kinematics, spans: Sequence[TaskSpan], manner: Manner) -> Extreme | None:
    """Return the largest speed of a wrist, m/s: |Δp̄| · fps, p̄ averaged over three frames.

    Lexical while the score asks for movement of the arm, transitional at all other times.
    """
    return _largest(k, spans, manner, speeds, SPEED_AT)


def largest_wrist_acceleration(
    k: Kinematics, spans: Sequence[TaskSpan], manner: Manner
) -> Extreme | None:
    """Return the largest acceleration of a wrist, m/s²: |Δ²p̄| · fps², else as the speed."""
    return _largest(k, spans, manner, accelerations, ACCELERATION_AT)


def _largest(
    k: Kinematics,
    spans: Sequence[TaskSpan],
    manner: Manner,
    measure: Callable[[Array, float], Array],
    first: float,
) -> Extreme | None:
    best: Extreme | None = None
    for side in SIDES:
        values = measure(k.wrist(side), k.fps)
        times = k.times_s[0] + (first + np.arange(len(values))) / k.fps
        lexical = asked_to_move(spans, f"arm_{side}", times)
        rows = np.flatnonzero(lexical if manner == "lexical" else ~lexical)
        if len(rows):
            top = rows[int(values[rows].argmax())]
            if best is None or values[top] > best.value:
                best = Extreme(float(values[top]), f"palm_{side}", float(times[top]))
    return best


@dataclass(frozen=True, slots=True)
class WristBend:
    """How far wrists are bent: the largest angle, and the share of frames beyond `BENT_DEG`."""

    largest_deg: Extreme
    beyond_share: float


def wrist_bend(k: Kinematics) -> WristBend:
    """Measure the angle of hand and forearm, arccos(cos flexion · cos deviation), on either side.

    Flexion and deviation turn the hand about two axes across it, one after the other.
    """
    best: Extreme | None = None
    beyond = np.zeros(len(k.times_s), dtype=bool)
    for side in SIDES:
        columns = [k.rig.coordinates.index[f"palm_{side}.{n}"] for n in ("flexion", "deviation")]
        angle = np.degrees(np.arccos(np.cos(k.q[:, columns]).prod(axis=1)))
        beyond |= angle > BENT_DEG
        top = int(angle.argmax())
        if best is None or angle[top] > best.value:
            best = Extreme(float(angle[top]), f"palm_{side}", float(k.times_s[top]))
    assert best is not None
    return WristBend(best, float(beyond.mean()))
