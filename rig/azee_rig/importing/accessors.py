"""Arrays of a glTF file: accessors, plain, interleaved, normalised or sparse."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.fields import shown
from azee_rig.importing.container import GltfFile, whole
from azee_rig.importing.fault import unreadable

TYPES: Mapping[int, np.dtype[Any]] = {
    5120: np.dtype("<i1"),
    5121: np.dtype("<u1"),
    5122: np.dtype("<i2"),
    5123: np.dtype("<u2"),
    5125: np.dtype("<u4"),
    5126: np.dtype("<f4"),
}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def read_array(file: GltfFile, index: object, *kinds: str) -> NDArray[Any]:
    """Rows (N, k) of an accessor: floats as they are, normalised integers as numbers in −1 … 1.

    Args: kinds: types that it may have, such as "VEC3".
    Raises: BodyError: it is of another type, or does not lie in its buffer.
    """
    accessor = file.one("accessors", index)
    kind, count = accessor.get("type"), whole(accessor, "count")
    if kind not in kinds:
        raise unreadable(f"accessor {index} is {shown(kind)}, not {' or '.join(kinds)}")
    dtype = _dtype(accessor)
    width = WIDTHS[str(kind)]
    if "bufferView" in accessor:
        rows = _rows(file, accessor, whole(accessor, "byteOffset", 0), count, dtype, width)
    elif count > sum(map(len, file.buffers)):
        raise unreadable(
            f"accessor {index} claims {shown(count)} elements and has no data: the whole file has "
            "fewer bytes"
        )
    else:
        rows = np.zeros((count, width), dtype)
    sparse = accessor.get("sparse")
    if isinstance(sparse, dict):
        rows = _with_sparse(file, rows, sparse, count)
    if dtype.kind == "f":
        if not np.isfinite(rows).all():
            raise unreadable(f"accessor {index} has numbers that are infinite or none")
        return rows.astype(np.float64)
    if accessor.get("normalized"):
        return np.maximum(rows.astype(np.float64) / np.iinfo(dtype).max, -1.0)
    return rows


def _dtype(item: Mapping[str, Any]) -> np.dtype[Any]:
    found = TYPES.get(whole(item, "componentType"))
    if found is None:
        raise unreadable(f"there is no component type {shown(item['componentType'])}")
    return found


def _rows(
    file: GltfFile,
    item: Mapping[str, Any],
    start: int,
    count: int,
    dtype: np.dtype[Any],
    width: int,
) -> NDArray[Any]:
    data = file.view(item.get("bufferView"))
    size = dtype.itemsize * width
    stride = whole(file.one("bufferViews", item["bufferView"]), "byteStride", size) or size
    if stride < size or (count and start + stride * (count - 1) + size > len(data)):
        raise unreadable(
            f"{shown(count)} elements of {size} bytes do not fit a buffer view of {len(data)}"
        )
    if not count:
        return np.zeros((0, width), dtype)
    rows = np.ndarray((count, width), dtype, data, start, (stride, dtype.itemsize))
    return np.array(rows)


def _with_sparse(
    file: GltfFile, rows: NDArray[Any], sparse: Mapping[str, Any], count: int
) -> NDArray[Any]:
    few = whole(sparse, "count")
    at, values = sparse.get("indices"), sparse.get("values")
    if not isinstance(at, dict) or not isinstance(values, dict):
        raise unreadable("a sparse accessor has no indices or no values")
    where = _rows(file, at, whole(at, "byteOffset", 0), few, _dtype(at), 1)[:, 0].astype(np.int64)
    if few and not 0 <= where.min() <= where.max() < count:
        raise unreadable("a sparse accessor names an element that is not there")
    new = np.array(rows)
    new[where] = _rows(file, values, whole(values, "byteOffset", 0), few, rows.dtype, rows.shape[1])
    return new
