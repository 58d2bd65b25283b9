"""Markers in files: C3D, TRC, and NumPy archives."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import numpy as np

from azee.capture.markers import Floats, Markers, MarkersError
from azee.capture.trc import read_trc
from azee.clip.archive import UNREADABLE

SUFFIXES = (".c3d", ".trc", ".npz")
METRES = {"mm": 0.001, "cm": 0.01, "m": 1.0, "inch": 0.0254}
"""Units of length that `--unit` and files may name."""
_ALSO = {"millimeters": "mm", "meters": "m", "in": "inch", "": "mm"}


def read_markers(
    path: str | Path, unit: str | None = None, rate_hz: float | None = None
) -> Markers:
    """Read the markers of a file; its suffix says what it is.

    An archive (.npz) has `markers` (T, M, 3), NaN where one is not seen, `names` (M,), and may have
    `rate_hz` and `unit`. A unit that nothing tells is the millimetre, as cameras have it.

    Args: unit: of its lengths, one of `METRES`, instead of the one that it says. rate_hz: its
        frames a second, instead of those that it says.
    Raises: MarkersError: the file cannot be used. OSError: it cannot be read.
    """
    path = Path(path)
    data = path.read_bytes()
    rate: float | None
    match path.suffix.lower():
        case ".trc":
            try:
                text = data.decode("utf-8-sig")
            except UnicodeDecodeError as error:
                raise MarkersError(f"`{path}`: it is no TRC: it is not text") from error
            names, positions, rate, said = _told(path, read_trc, text)
        case ".c3d":
            from azee.capture.c3d_file import read_c3d

            names, positions, rate, said = _told(path, read_c3d, path)
        case ".npz":
            names, positions, rate, said = _told(path, _archive, path)
        case _:
            raise MarkersError(f"`{path}` is none of {' '.join(SUFFIXES)}")
    rate = rate if rate_hz is None else rate_hz
    if rate is None:
        raise MarkersError(f"`{path}` does not say its frames a second", "name them with --rate")
    said = _ALSO.get(said.lower(), said.lower())
    if unit is None and said not in METRES:
        raise MarkersError(
            f"`{path}`: `{said}` is no unit of length", f"--unit may be {', '.join(METRES)}"
        )
    source = f"{path.name} sha256:{hashlib.sha256(data).hexdigest()[:16]}"
    made: Markers = _told(path, Markers, names, positions * METRES[unit or said], rate, source)
    return made


def _told(path: Path, make: Any, *arguments: Any) -> Any:
    """Call a reader; what it finds wrong is said of its file."""
    try:
        return make(*arguments)
    except MarkersError as error:
        raise MarkersError(f"`{path}`: {error}", error.remedy) from error


def _archive(path: Path) -> tuple[tuple[str, ...], Floats, float | None, str]:
    try:
        with np.load(path, allow_pickle=False) as packed:
            if not {"markers", "names"} <= set(packed.files):
                raise MarkersError("it holds no markers: an archive of them has `markers`, `names`")
            positions = np.asarray(packed["markers"], dtype=np.float64)
            names = tuple(str(name) for name in np.atleast_1d(packed["names"]))
            rate = float(packed["rate_hz"]) if "rate_hz" in packed else None
            unit = str(packed["unit"]) if "unit" in packed else ""
    except MarkersError:
        raise
    except UNREADABLE as error:
        raise MarkersError("it is no NumPy archive of markers, or it is damaged") from error
    return names, positions, rate, unit
