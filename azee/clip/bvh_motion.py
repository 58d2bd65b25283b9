"""The second half of a BVH file: how fast its frames follow each other, and their values."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from azee.clip.bvh_hierarchy import LARGEST_NUMBER, BvhError, number_of

Floats = NDArray[np.float64]

USUAL_FRAME_S = 1 / 30
FASTEST_S, SLOWEST_S = 1e-4, 5.0
"""Frame times beyond these are no seconds."""
USUAL_RATES = (
    10, 12, 15, 20, 24, 25, 30, 48, 50, 60, 72, 75, 80, 90, 100, 120, 144, 150, 160, 180, 200, 240,
    250, 300, 360, 400, 480, 500, 600, 720, 960, 1000,
)  # fmt: skip
"""Frames a second that cameras and motion capture take."""
NEAR_RATE = 2e-3
"""As a share: 29.97 is 30."""
ROUNDED = 5e-2
"""As a share: what rounding to whole milliseconds makes of a rate."""
MOST_RATE = 1000.0
LINES = 0.5
"""Share of lines that must have one value for each channel for a line to be a frame."""

_FRAMES = re.compile(r"\s*Frames\s*:\s*(\S+)", re.IGNORECASE)
_FRAME_TIME = re.compile(r"\s*Frame\s+Time\s*:\s*(\S+)", re.IGNORECASE)


def read_motion(text: str, start: int, width: int, notes: list[str]) -> tuple[Floats, Floats]:
    """Read the times (T,) of frames, seconds, and the values (T, width) of all channels.

    Args: text: of the file; the motion starts at `start`, after MOTION. notes: grows by what was
        put right.
    Raises: BvhError: a value is no number, or there is no whole frame.
    """
    declared, step, start = _header(text, start)
    values = _values(text, start, width, notes)
    count = len(values)
    if declared != count:
        said = "no number of frames" if declared is None else f"{declared:g} frames"
        notes.append(f"the file says {said} and has {count}: {count} are kept")
    seconds = frame_time(step, notes)
    return np.arange(count, dtype=np.float64) * seconds, values


def _header(text: str, start: int) -> tuple[float | None, str | None, int]:
    """Return the number of frames and the frame time as written, and where both end."""
    frames = step = None
    while True:
        if frames is None and (found := _FRAMES.match(text, start)):
            frames, start = found[1], found.end()
        elif step is None and (found := _FRAME_TIME.match(text, start)):
            step, start = found[1], found.end()
        else:
            return _plain(frames), step, start


def _plain(word: str | None) -> float | None:
    if word is None:
        return None
    try:
        return float(word.replace(",", "."))
    except ValueError:
        return None


def frame_time(word: str | None, notes: list[str]) -> float:
    """Return the seconds between frames that a file means by what it says.

    Some write a rate in its place, some milliseconds, some lose the unit altogether.

    Args: notes: grows by how it was read, where it was not read as seconds.
    """
    said = _plain(word)
    if said is None or not (np.isfinite(said) and said > 0):
        notes.append("the file says no frame time: 30 frames a second are taken")
        return USUAL_FRAME_S
    if FASTEST_S <= said <= SLOWEST_S:
        return said
    if said > SLOWEST_S:
        if _usual(said, NEAR_RATE):
            rate = said
        elif _usual(1e3 / said, ROUNDED):
            rate = 1e3 / said
        elif _usual(1e6 / said, ROUNDED):
            rate = 1e6 / said
        else:
            rate = said if said <= MOST_RATE else 1.0 / USUAL_FRAME_S
    else:
        slips = [1.0 / (said * factor) for factor in (1e3, 1e6, 1e9)]
        rate = next((r for r in slips if _usual(r, NEAR_RATE)), 1.0 / USUAL_FRAME_S)
    notes.append(f"the frame time {said:g} is no seconds: {rate:.4g} frames a second are taken")
    return 1.0 / rate


def _usual(rate: float, share: float) -> bool:
    return any(abs(rate - usual) <= share * usual for usual in USUAL_RATES)


def _values(text: str, start: int, width: int, notes: list[str]) -> Floats:
    """Read all frames, (T, width), which start at a place in the text.

    Where most lines have a value for each channel a line is a frame: no line lends another its
    values. Elsewhere frames go on over lines.
    """
    rows = [
        (number, part)
        for number, row in _rows(text, start)
        for part in (np.split(row, len(row) // width) if len(row) % width == 0 else [row])
    ]
    whole = sum(len(row) == width for _, row in rows)
    if whole >= max(1.0, LINES * len(rows)):
        return _by_lines(rows, width, notes)
    numbers = np.concatenate([row for _, row in rows]) if rows else np.zeros(0)
    count, rest = divmod(len(numbers), width)
    if rest and count:
        notes.append(_cut_off(rest, width))
    if not count:
        raise BvhError("there is no whole frame")
    return numbers[: count * width].reshape(count, width)


def _by_lines(rows: list[tuple[int, Floats]], width: int, notes: list[str]) -> Floats:
    """Return frames that are a line each; what a line lacks comes from the nearest whole one.

    The rows are taken from the list, so that they and the array are never there both.
    """
    if (rest := len(rows[-1][1])) < width:
        notes.append(_cut_off(rest, width))
        rows.pop()
    odd = [(i, number, row) for i, (number, row) in enumerate(rows) if len(row) != width]
    good = np.array([i for i, (_, row) in enumerate(rows) if len(row) == width])
    values = np.empty((len(rows), width))
    while rows:
        _, row = rows.pop()
        values[len(rows), : min(len(row), width)] = row[:width]
    for i, _, row in odd:
        if len(row) < width:
            nearest = int(good[np.abs(good - i).argmin()])
            values[i, len(row) :] = values[nearest, len(row) :]
    if odd:
        _, number, row = odd[0]
        more = f", as {len(odd) - 1} further frames have another number" if len(odd) > 1 else ""
        what = (
            "those that lack are taken from the nearest whole frame"
            if len(row) < width
            else "what is too much is left out"
        )
        notes.append(f"line {number}: a frame has {len(row)} of {width} values{more}: {what}")
    return values


def _cut_off(rest: int, width: int) -> str:
    return f"the last frame has {rest} of {width} values and is left out"


def _rows(text: str, start: int) -> Iterator[tuple[int, Floats]]:
    """Yield the lines that hold something, from a place on, by number, as numbers.

    Raises: BvhError: a word is no number.
    """
    number = text.count("\n", 0, start)
    while start <= len(text):
        end = text.find("\n", start)
        end = len(text) if end < 0 else end
        words, start, number = text[start:end].split(), end + 1, number + 1
        if not words:
            continue
        try:
            found = np.array(words, dtype=np.float64)
        except ValueError:
            found = np.array([number_of(word, number) for word in words])
        if not (np.abs(found) <= LARGEST_NUMBER).all():
            for word in words:
                number_of(word, number)
        yield number, found
