"""Arrays as an .npz of which the same arrays give the same bytes."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.export.files import replace_file

_DATE = (1980, 1, 1, 0, 0, 0)


def write_npz(arrays: Mapping[str, NDArray[np.generic]], path: str | Path) -> None:
    """Write an .npz that bears no date. Raises: OSError: it cannot be written."""
    with replace_file(path) as file, zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.asarray(array, order="C"), allow_pickle=False)
            archive.writestr(
                zipfile.ZipInfo(f"{name}.npy", _DATE), buffer.getvalue(), zipfile.ZIP_DEFLATED
            )
