"""A recorded word in other times: its movement is warped piece by piece."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from azee.clip.clip import Clip, Label
from azee.spelling.timing.schedule import LetterTime
from azee.spelling.timing.timed_word import TimedWord

Array = NDArray[np.float64]


def warped(
    clip: Clip,
    recorded: TimedWord,
    times: Sequence[LetterTime],
    start_s: float = 0.0,
    *,
    smooth: bool = False,
) -> Clip:
    """Return a clip in which each hold and transition of a word takes another time.

    Its frames keep their postures and get other times (Wheatland 2016, section 4.3); what comes
    before and after the word keeps its length. With `smooth`, speeds do not jump where a hold
    meets a transition: time is a monotone cubic of time, not a polygon.

    Args: recorded: the word as the clip has it. times: what it is to have. start_s: the clip's
        time at which the first hold starts.
    Raises: ValueError: the times are of other letters, or the word does not lie in the clip.
    """
    if "".join(time.letter for time in times) != recorded.word:
        raise ValueError(f"these are no times of `{recorded.word}`")
    before: Array = start_s + _bounds(recorded.holds_s, recorded.transitions_s)
    after: Array = start_s + _bounds(
        [t.hold_s for t in times], [t.transition_s for t in times[:-1]]
    )
    first, last = float(clip.times[0]), float(clip.times[-1])
    step = 1.5 * clip.duration_s / max(1, len(clip.times) - 1)
    if before[0] < first - step or before[-1] > last + step:
        raise ValueError(
            f"`{recorded.word}` is held from {before[0]:.3f} to {before[-1]:.3f} s, and the clip "
            f"lasts from {first:.3f} to {last:.3f} s"
        )
    moved = _map(before, after, smooth)
    return replace(
        clip,
        times=moved(clip.times),
        labels=tuple(
            Label(x.path, *map(float, moved(np.array([x.start_s, x.end_s])))) for x in clip.labels
        ),
    )


def _bounds(holds_s: Sequence[float], ways_s: Sequence[float]) -> Array:
    """Return start and end of each hold, from 0, (2 · letters,)."""
    pieces = [piece for pair in zip(holds_s, [*ways_s, 0.0], strict=True) for piece in pair][:-1]
    return np.concatenate([[0.0], np.cumsum(pieces)])


def _map(before: Array, after: Array, smooth: bool) -> Callable[[Array], Array]:
    """Return the change of time; outside the word it shifts."""
    first, last = float(before[0]), float(before[-1])

    def moved(times: Array) -> Array:
        inside = np.clip(times, first, last)
        within = _smooth(before, after)(inside) if smooth else np.interp(inside, before, after)
        return np.asarray(within + times - inside)

    return moved


def _smooth(before: Array, after: Array) -> CubicHermiteSpline:
    """Return the monotone cubic of Fritsch and Carlson (1980) that leaves with the slope 1.

    Where the first or last hold gets less than a third of its time, its slope there is less.
    """
    slopes = PchipInterpolator(before, after).derivative()(before)
    secants = np.diff(after) / np.diff(before)
    slopes[[0, -1]] = np.minimum(1.0, 3 * secants[[0, -1]])
    return CubicHermiteSpline(before, after, slopes)
