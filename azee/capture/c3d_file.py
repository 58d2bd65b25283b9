"""C3D: binary files of motion capture. Needs the library c3d (extra `capture`)."""

from __future__ import annotations

import struct
import warnings
from pathlib import Path

import c3d
import numpy as np

from azee.capture.markers import Floats, MarkersError

UNREADABLE = (
    AssertionError, AttributeError, EOFError, IndexError, KeyError, MemoryError, NameError,
    OverflowError, RuntimeError, TypeError, ValueError, struct.error,
)  # fmt: skip
"""Exceptions of the library for a file that is not C3D, or is damaged."""


def read_c3d(path: Path) -> tuple[tuple[str, ...], Floats, float, str]:
    """Return names, positions (T, M, 3) in the file's unit, frames a second, and that unit.

    A point with a negative residual is one that the cameras did not see.

    Raises: MarkersError: it is no C3D, or damaged. OSError: it cannot be read.
    """
    with path.open("rb") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            reader = c3d.Reader(file)
            names = tuple(str(label).strip() for label in reader.point_labels)
            rate = float(reader.point_rate)
            unit = reader.get("POINT:UNITS")
            frames = [points[:, :4] for _, points, _ in reader.read_frames(copy=True)]
        except UNREADABLE as error:
            raise MarkersError("it is no C3D, or it is damaged") from error
    if not frames:
        raise MarkersError("it has no frames")
    points = np.array(frames, dtype=np.float64)
    positions = np.where(points[:, :, 3:] < 0.0, np.nan, points[:, :, :3])
    return names[: positions.shape[1]], positions, rate, unit.string_value.strip() if unit else ""
