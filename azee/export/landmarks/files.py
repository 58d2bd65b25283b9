"""Landmarks as files: `.pose` of pose-format 0.2, tables for NumPy and for spreadsheets.

A `.pose` file is little-endian. Its header is the version, the picture's width, height and depth,
and the components: names, lines, colours. Its body is the frames a second, the number of frames
and of people, then all values and all confidences as 32-bit floats.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.export.files import replace_file
from azee.export.landmarks.layout import COMPONENTS, Component
from azee.export.landmarks.view import Landmarks
from azee.export.npz import write_npz

VERSION = 0.2
FORMAT = "XYZC"
"""Every point has x, y, z and a confidence."""
PEOPLE = 1


def write_pose(marks: Landmarks, path: str | Path) -> None:
    """Write a `.pose` file of MediaPipe Holistic. Raises: OSError: it cannot be written."""
    width, height = marks.view.size
    head = struct.pack("<fHHHH", VERSION, width, height, width, len(COMPONENTS))
    head += b"".join(_component(component) for component in COMPONENTS)
    frames = len(marks.values)
    body = struct.pack("<fIH", marks.view.fps, frames, PEOPLE)
    with replace_file(path) as file:
        file.write(head + body)
        file.write(marks.values.astype("<f4").tobytes())
        file.write(marks.confidence.astype("<f4").tobytes())


def _component(component: Component) -> bytes:
    parts = [_text(component.name), _text(FORMAT)]
    parts.append(struct.pack("<HHH", len(component.points), len(component.lines), 1))
    parts += [_text(name) for name in component.points]
    parts += [struct.pack("<HH", *line) for line in component.lines]
    parts.append(struct.pack("<HHH", *component.colour))
    return b"".join(parts)


def _text(text: str) -> bytes:
    data = text.encode()
    return struct.pack("<H", len(data)) + data


def write_landmarks_npz(marks: Landmarks, path: str | Path) -> None:
    """Write arrays by component: (T, P, 4) x, y, z and confidence, single precision.

    With `fps`, `size` (width, height) and, for each component, its points' `…_names`.
    Raises: OSError: it cannot be written.
    """
    arrays: dict[str, NDArray[np.generic]] = {
        "fps": np.array(marks.view.fps),
        "size": np.array(marks.view.size),
    }
    for component in COMPONENTS:
        values, confidence = marks.component(component.name)
        arrays[component.name] = np.dstack([values, confidence]).astype(np.float32)
        arrays[f"{component.name}_names"] = np.array(component.points)
    write_npz(arrays, path)


def write_landmarks_csv(marks: Landmarks, path: str | Path) -> None:
    """Write a row per frame and point: frame, time_s, component, point, x, y, z, confidence.

    Numbers are those of single precision. Raises: OSError: it cannot be written.
    """
    names = [(c.name, point) for c in COMPONENTS for point in c.points]
    rows = np.dstack([marks.values, marks.confidence]).astype(np.float32)
    with replace_file(path) as file:
        file.write(b"frame,time_s,component,point,x,y,z,confidence\n")
        for n, frame in enumerate(rows):
            time = f"{n / marks.view.fps:.6f}"
            lines = (
                f"{n},{time},{component},{point},{x},{y},{z},{c:g}\n"
                for (component, point), (x, y, z, c) in zip(names, frame, strict=True)
            )
            file.write("".join(lines).encode())


LandmarkWriter: TypeAlias = "Callable[[Landmarks, Path], None]"

LANDMARK_WRITERS: dict[str, LandmarkWriter] = {
    ".pose": write_pose,
    ".csv": write_landmarks_csv,
    ".npz": write_landmarks_npz,
}
"""Formats of landmarks, by suffix."""
