"""Clips on disk: a NumPy archive with numbers and names, which cannot contain code.

`coordinates` are stored with their names, so that a clip stays readable if their order changes.
docs/formats.md describes the file.
"""

from __future__ import annotations

import io
import json
import math
import struct
import zipfile
import zlib
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip, Label
from azee_rig.rig import Rig

FORMAT, VERSION = "azee-clip-npz", 1
_ZIP_EPOCH = (1980, 1, 1, 0, 0, 0)

UNREADABLE = (
    ValueError,
    KeyError,
    TypeError,
    EOFError,
    MemoryError,
    RuntimeError,
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
)
"""Exceptions of NumPy and zipfile for a file that is not an archive, or is damaged."""


class ClipFileError(ValueError):
    """A file is not a clip, is damaged, or belongs to a body with other coordinates."""


class OtherBodyError(ClipFileError):
    """A clip moves parts that the chosen body does not have."""


def write_clip(clip: Clip, rig: Rig, file: IO[bytes]) -> None:
    """Write a clip; the same clip gives the same bytes, on any day."""
    header = {
        "format": FORMAT,
        "version": VERSION,
        "rig": rig.name,
        "coordinates": list(rig.coordinates.names),
        "units": list(clip.units),
        "labels": [[list(x.path), x.start_s, x.end_s] for x in clip.labels],
    }
    text = json.dumps(header, ensure_ascii=False, allow_nan=False).encode()
    arrays: dict[str, NDArray[Any]] = {
        "header": np.frombuffer(text, dtype=np.uint8),
        "times": clip.times,
        "coordinates": clip.coordinates,
        "unit_weights": clip.unit_weights,
    }
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            data = io.BytesIO()
            np.lib.format.write_array(data, array, allow_pickle=False)
            entry = zipfile.ZipInfo(f"{name}.npy", _ZIP_EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data.getvalue())


def read_clip(path: str | Path, rig: Rig) -> Clip:
    """Read a clip for a body; coordinates that the file does not have stay at idle.

    Raises: ClipFileError: the file is not a clip, or not one of this body. OSError.
    """
    return _clip(*_read(path), path, rig)


def unpack_clip(data: bytes, rig: Rig, name: str) -> Clip:
    """Read a clip from the bytes of its file, as `read_clip` does.

    Args: name: of the clip, for messages.
    Raises: ClipFileError: they are not a clip, or not one of this body.
    """
    return _clip(*_unpacked(io.BytesIO(data), name), name, rig)


def frames_of(data: bytes, name: str) -> int:
    """Return the number of frames of a clip in the bytes of its file. Raises: ClipFileError."""
    return len(_unpacked(io.BytesIO(data), name)[1]["times"])


def _clip(header: dict[str, Any], arrays: dict[str, Any], path: str | Path, rig: Rig) -> Clip:
    """Return what a file holds. Raises: ClipFileError."""
    try:
        names, stored = header["coordinates"], arrays["coordinates"]
        foreign = [name for name in names if name not in rig.coordinates.index]
        if foreign:
            raise OtherBodyError(
                f"`{path}` moves `{foreign[0]}`, which the rig `{rig.name}` does not have"
            )
        q = np.tile(rig.coordinates.idle, (len(stored), 1))
        q[:, [rig.coordinates.index[name] for name in names]] = stored
        missing = [unit for unit in header["units"] if unit not in rig.units]
        if missing:
            raise OtherBodyError(
                f"`{path}` moves the face unit `{missing[0]}`, which the rig `{rig.name}` "
                "does not have"
            )
        if not np.isfinite(q).all():
            raise ClipFileError(f"`{path}` holds numbers that are none")
        q = np.clip(q, rig.coordinates.lower, rig.coordinates.upper)
        labels = tuple(_label(*stored) for stored in header["labels"])
        units = tuple(header["units"])
        try:
            return Clip(arrays["times"], q, units, arrays["unit_weights"], labels)
        except ValueError as error:
            raise ClipFileError(f"`{path}` is a damaged clip: {error}") from error
    except ClipFileError:
        raise
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise ClipFileError(f"`{path}` is a damaged clip") from error


def _label(path: list[str], start_s: float, end_s: float) -> Label:
    """Return a stored label. Raises: ValueError: it is not one."""
    named = path and all(isinstance(name, str) for name in path)
    if not (named and math.isfinite(start_s) and start_s <= end_s < math.inf):
        raise ValueError("a label without a name or a time")
    return Label(tuple(path), float(start_s), float(end_s))


def rig_of(path: str | Path) -> str:
    """Return the name of the rig that a clip was made for. Raises: ClipFileError, OSError."""
    return str(_read(path)[0].get("rig", ""))


def _read(path: str | Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return header and arrays of a file whose header says that it is a clip."""
    with Path(path).open("rb") as file:
        return _unpacked(file, path)


def _unpacked(file: IO[bytes], path: str | Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return header and arrays of a clip.

    A plain .npy is not a context manager and not a clip: its TypeError is one of `UNREADABLE`.
    """
    try:
        with np.load(file, allow_pickle=False) as packed:
            if "header" not in packed:
                raise ClipFileError(f"`{path}` is not a clip that azee wrote")
            header = json.loads(packed["header"].tobytes())
            if not isinstance(header, dict) or header.get("format") != FORMAT:
                raise ClipFileError(f"`{path}` is not a clip that azee wrote")
            if header.get("version") != VERSION:
                raise ClipFileError(
                    f"`{path}` is a clip of version {header.get('version')}; "
                    f"this azee reads version {VERSION}"
                )
            names = ("times", "coordinates", "unit_weights")
            arrays = {name: packed[name] for name in names}
            if any(array.dtype.kind not in "fiu" for array in arrays.values()):
                raise ClipFileError(f"`{path}` holds numbers that are none")
            return header, {name: np.asarray(arrays[name], dtype=np.float64) for name in names}
    except ClipFileError:
        raise
    except OSError:
        raise
    except UNREADABLE as error:
        raise ClipFileError(f"`{path}` is not a clip that azee wrote, or is damaged") from error
