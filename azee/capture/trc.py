"""TRC: markers as a table of text, as Motion Analysis defined it and OpenSim reads it.

    PathFileType  4  (X/Y/Z)  name.trc
    DataRate  CameraRate  NumFrames  NumMarkers  Units  …        a heading
    120       120         2          2           mm     …        its values
    Frame#  Time  index_tip  ⇥  ⇥  thumb_tip                     a name over three columns
    ⇥  ⇥  X1  Y1  Z1  X2  Y2  Z2
    1  0.00000  …                                                a row a frame; missing: empty

Columns are separated by tabs.
"""

from __future__ import annotations

import math

import numpy as np

from azee.capture.markers import Floats, MarkersError

HEADER_LINES = 5
RATE_TOLERANCE = 0.02
"""By how much the rate may differ from that of the column of times."""


def read_trc(text: str) -> tuple[tuple[str, ...], Floats, float, str]:
    """Return names, positions (T, M, 3) in the file's unit, frames a second, and that unit.

    Raises: MarkersError: it is no TRC, or damaged; it says in which line.
    """
    lines = text.splitlines()
    if len(lines) < HEADER_LINES + 1 or not lines[0].startswith("PathFileType"):
        raise MarkersError("it is no TRC: the first line of one begins with `PathFileType`")
    heading = dict(zip(_cells(lines[1]), _cells(lines[2]), strict=False))
    names = tuple(cell for cell in _cells(lines[3])[2:] if cell)
    rate = _number(heading.get("DataRate", ""), 3, "DataRate")
    count = _number(heading.get("NumMarkers", ""), 3, "NumMarkers")
    if count != len(names):
        raise MarkersError(f"line 4 names {len(names)} markers, line 3 says {count:g}")
    rows, times = [], []
    for n, line in enumerate(lines[HEADER_LINES:], HEADER_LINES + 1):
        if not line.strip():
            continue
        cells = _cells(line)
        if len([cell for cell in cells[2 + 3 * len(names) :] if cell]):
            raise MarkersError(f"line {n} has more columns than three for each marker")
        cells += [""] * (2 + 3 * len(names) - len(cells))
        times.append(_number(cells[1], n, "the time"))
        rows.append(
            [
                _number(cell, n, names[i // 3]) if cell else math.nan
                for i, cell in enumerate(cells[2 : 2 + 3 * len(names)])
            ]
        )
    if not rows:
        raise MarkersError("it has no frames")
    if len(times) > 1:
        step = (times[-1] - times[0]) / (len(times) - 1)
        if not abs(step * rate - 1.0) <= RATE_TOLERANCE:
            told = f"{1.0 / step:.4g}" if step > 0.0 else "no"
            raise MarkersError(
                f"it says {rate:g} frames a second, its times go at {told} a second",
                "correct DataRate or the column of times",
            )
    return names, np.array(rows).reshape(len(rows), len(names), 3), rate, heading.get("Units", "")


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.rstrip("\r\n").split("\t")]


def _number(text: str, line: int, what: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise MarkersError(f"line {line}: `{text}` is no number for {what}") from None
