"""Finds the holds of a spelled word in a movement of the hand whose text is known.

Where a letter is held, its weight (equation 4.1) is large and the hand is slow. Wheatland (2016,
section 4.1) found holds by eye in plots of both. Here the cheapest way through the word finds which
frames belong to which letter; then each way between two letters is taken for a minimum-jerk
movement, whose ends follow from where its speed passes a quarter of its peak.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from azee.spelling.timing.decomposition import convex_weights, distinct
from azee.spelling.timing.letter_poses import LetterPoses
from azee.spelling.timing.published import TRANSITION_RANGE_S
from azee.spelling.timing.timed_word import TimedWord, TimesError

Array = NDArray[np.float64]

WEIGHT_COST = 4.0
"""Of a held frame, times the square of what its letter's weight lacks to 1."""
FOREIGN_RAD = 0.3
"""Where the word's letters leave so much of a frame unexplained, holding it costs 1 more."""
PASSING_COST = 0.6
"""Of a frame in a transition; a held frame costs its speed by the word's median speed."""
LEAST_HOLD_S, LEAST_WAY_S = 0.025, 0.05
"""Three and six frames at 120 Hz."""
SMOOTHING_S = 0.015
"""Deviation of the Gaussian that smooths angles before speeds are taken."""
AT_SPEED = 0.25
"""Share of a movement's peak speed at which its ends are read."""
AT_TIME = (1 - np.sqrt(1 - 4 * np.sqrt(AT_SPEED / 16))) / 2
"""Share of a minimum-jerk movement's time at which it has that speed.

Its speed by the peak is 16 τ² (1 − τ)² (Flash and Hogan 1985); it is 1/4 at τ = .146.
"""
REACH_S = 0.6
"""Before and after a word, movement to its first and from its last letter is looked for so far."""
MOVING = 4.0
"""Times the speed of a hold: what is faster there is such a movement."""
DOUBLE_S = TRANSITION_RANGE_S[0]
"""The way of a letter to itself: not to be seen in the angles of the hand, so the published one."""


def aligned(
    word: str, frames: Array, rate_hz: float, poses: LetterPoses, spelling: int = 1
) -> tuple[TimedWord, float]:
    """Find when each letter of a word is held.

    Args: word: in capitals. frames: (T, joints) radians, in the order of the poses; the hand may
        come from and go to anywhere before and after the word.
    Returns: the word with its times, and the second at which its first hold starts.
    Raises: TimesError: a letter has no pose, or the movement is too short for the word.
    """
    unknown = sorted(set(word) - set(poses.letters))
    if unknown:
        raise TimesError(f"`{word}`: there is no pose of the letter `{unknown[0]}`")
    least_hold = max(1, round(LEAST_HOLD_S * rate_hz))
    least_way = max(1, round(LEAST_WAY_S * rate_hz))
    count = len(word)
    if len(frames) < count * least_hold + (count - 1) * least_way:
        raise TimesError(f"`{word}` cannot be spelled in {len(frames)} frames at {rate_hz:g} Hz")
    weights = convex_weights(frames, poses, word)
    speed = mean_speed(frames, rate_hz)
    relative = speed / max(float(np.median(speed)), 1e-9)
    order = distinct(word)
    rest = frames - weights @ poses.of(order)
    foreign = (rest**2).mean(axis=1) / FOREIGN_RAD**2
    held = np.array(
        [
            WEIGHT_COST * (1 - weights[:, order.index(letter)]) ** 2 + relative + foreign
            for letter in word
        ]
    )
    bounds = _cheapest(held, least_hold, least_way)
    times = np.array(_ends(word, bounds, speed, rate_hz)) / rate_hz
    holds = times[:, 1] - times[:, 0]
    ways = times[1:, 0] - times[:-1, 1]
    found = TimedWord(word, tuple(map(float, holds)), tuple(map(float, ways)), spelling)
    return found, float(times[0, 0])


def mean_speed(frames: Array, rate_hz: float) -> Array:
    """Return the root mean square of the joints' angular speeds in every frame, (T,) rad/s."""
    smooth = gaussian_filter1d(frames, SMOOTHING_S * rate_hz, axis=0, mode="nearest")
    return np.asarray(np.sqrt((np.gradient(smooth, axis=0) ** 2).mean(axis=1)) * rate_hz)


def _ends(
    word: str, bounds: Sequence[tuple[int, int]], speed: Array, rate_hz: float
) -> list[tuple[float, float]]:
    """Return where holds start and end, in frames, from where ways pass a quarter of their peak."""
    ends = [[float(begin), float(end)] for begin, end in bounds]
    middles = [(begin + end) // 2 for begin, end in bounds]
    for index, (a, b) in enumerate(pairwise(word)):
        way_begin, way_end = _way(speed, middles[index], middles[index + 1])
        way_begin, way_end = (
            max(way_begin, middles[index] + 0.5),
            min(way_end, middles[index + 1] - 0.5),
        )
        if a != b and way_end - way_begin >= 1.0:
            ends[index][1], ends[index + 1][0] = way_begin, way_end
    reach = round(REACH_S * rate_hz)
    first, last = middles[0], middles[-1]
    before, after = max(0, first - reach), min(len(speed) - 1, last + reach)
    if speed[before : first + 1].max() > MOVING * speed[first]:
        ends[0][0] = min(_way(speed, before, first)[1], first - 0.5)
    if speed[last : after + 1].max() > MOVING * speed[last]:
        ends[-1][1] = max(_way(speed, last, after)[0], last + 0.5)
    _part_doubles(word, ends, DOUBLE_S * rate_hz)
    return [(begin, end) for begin, end in ends]


def _part_doubles(word: str, ends: list[list[float]], way: float) -> None:
    """Part the time of a letter that follows itself into equal holds and ways that are known."""
    index = 0
    for _, group in groupby(word):
        count = len(list(group))
        if count > 1:
            begin, end = ends[index][0], ends[index + count - 1][1]
            passed = min(way, (end - begin) / (2 * count - 1))
            held = (end - begin - passed * (count - 1)) / count
            for i in range(count):
                start = begin + i * (held + passed)
                ends[index + i][:] = start, start + held
        index += count


def _way(speed: Array, first: int, last: int) -> tuple[float, float]:
    """Return start and end, in frames, of the minimum-jerk movement between two frames."""
    peak = first + int(speed[first : last + 1].argmax())
    level = AT_SPEED * speed[peak]
    before = _crossing(speed[first : peak + 1][::-1], level)
    after = _crossing(speed[peak : last + 1], level)
    beyond = AT_TIME * (before + after) / (1 - 2 * AT_TIME)
    return peak - before - beyond, peak + after + beyond


def _crossing(speeds: Array, level: float) -> float:
    """Return after how many frames speeds that begin above a level first pass it."""
    below = np.flatnonzero(speeds < level)
    if not below.size:
        return float(len(speeds) - 1)
    i = int(below[0])
    return float(i - (level - speeds[i]) / (speeds[i - 1] - speeds[i]))


def _cheapest(held: Array, least_hold: int, least_way: int) -> list[tuple[int, int]]:
    """Return first frame and end of each hold, so that the sum of costs is least (Viterbi).

    Before the first hold, between holds and after the last a frame costs `PASSING_COST`.

    Args: held: (letters, T), cost of holding each letter in each frame.
    """
    letters, count = held.shape
    sums = np.hstack([np.zeros((letters, 1)), np.cumsum(held - PASSING_COST, axis=1)])
    # best[t]: least cost of all holds so far, the last of which ends at or before frame t.
    best = np.zeros(count + 1)
    choices = []
    for index in range(letters):
        gap = least_way if index else 0
        before = np.full(count + 1, np.inf)  # by the frame at which this hold starts
        before[gap:] = best[: count + 1 - gap] if gap else best
        start, starts = _running_least(before - sums[index])
        ends = np.full(count + 1, np.inf)
        ends[least_hold:] = sums[index, least_hold:] + start[: count + 1 - least_hold]
        begun = np.zeros(count + 1, dtype=int)
        begun[least_hold:] = starts[: count + 1 - least_hold]
        best, at = _running_least(ends)
        choices.append((at, begun, gap))
    found: list[tuple[int, int]] = []
    limit = count
    for at, begun, gap in reversed(choices):
        end = int(at[limit])
        begin = int(begun[end])
        found.append((begin, end))
        limit = begin - gap
    return found[::-1]


def _running_least(values: Array) -> tuple[Array, NDArray[np.intp]]:
    """Return the least value up to each place, and where it stands."""
    least = np.minimum.accumulate(values)
    changed = np.r_[True, least[1:] < least[:-1]]
    return least, np.maximum.accumulate(np.where(changed, np.arange(len(values)), 0))
