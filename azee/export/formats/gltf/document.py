"""Builds a glTF 2.0 document: its JSON objects, its one buffer, and the GLB container."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Mapping
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

COMPONENT_TYPES = {"int8": 5120, "uint8": 5121, "int16": 5122, "uint16": 5123} | {
    "uint32": 5125,
    "float32": 5126,
}
ELEMENT_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class Target(IntEnum):
    """The use of a buffer view; only vertices and indices have one."""

    VERTICES = 34962
    INDICES = 34963


class Document:
    """Collects glTF objects and the bytes they point to. Indices are glTF's own.

    Arrays are written as they are: the caller chooses the component type by the array's dtype.
    """

    def __init__(self, generator: str) -> None:
        self.asset: dict[str, Any] = {"version": "2.0", "generator": generator}
        self.objects: dict[str, list[dict[str, Any]]] = {}
        self.buffer = bytearray()
        self._zero_rows, self._zero_view = 0, -1

    def add(self, kind: str, **properties: Any) -> int:
        """Append an object to the array `kind`, such as "nodes"; returns its index.

        Properties that are None are left out: glTF has no null.
        """
        array = self.objects.setdefault(kind, [])
        array.append({k: v for k, v in properties.items() if v is not None})
        return len(array) - 1

    def accessor(
        self,
        array: NDArray[Any],
        *,
        target: Target | None = None,
        bounds: bool = False,
        normalized: bool = False,
    ) -> int:
        """Store one element per row, (N,) or (N, k); returns the accessor's index.

        bounds: state the smallest and largest value, as positions and key times must.
        normalized: integers stand for [0, 1] or [−1, 1].
        """
        rows = array.reshape(len(array), -1)
        return self.add(
            "accessors",
            bufferView=self._view(array, target),
            componentType=COMPONENT_TYPES[array.dtype.name],
            normalized=normalized or None,
            count=len(array),
            type=ELEMENT_TYPES[rows.shape[1]],
            min=rows.min(axis=0).tolist() if bounds else None,
            max=rows.max(axis=0).tolist() if bounds else None,
        )

    def sparse_accessor(
        self,
        count: int,
        rows: NDArray[np.intp],
        values: NDArray[np.float32],
        *,
        bounds: bool = False,
    ) -> int:
        """Store `count` vectors that are zero but for `values` (S, 3) at `rows` (S,), increasing.

        With no rows at all the zeros are written out, once for all accessors: glTF allows an
        accessor without any data, but readers are known that crash on one.
        """
        if not len(rows):
            return self._zeros(count, bounds=bounds)
        shown = values if len(rows) == count else np.vstack([values, np.zeros((1, 3), np.float32)])
        indices = rows.astype(np.uint16 if count <= 0xFFFF else np.uint32)
        sparse = {
            "count": len(rows),
            "indices": {
                "bufferView": self._view(indices, None),
                "componentType": COMPONENT_TYPES[indices.dtype.name],
            },
            "values": {"bufferView": self._view(values, None)},
        }
        return self.add(
            "accessors",
            componentType=COMPONENT_TYPES["float32"],
            count=count,
            type="VEC3",
            min=shown.min(axis=0).tolist() if bounds else None,
            max=shown.max(axis=0).tolist() if bounds else None,
            sparse=sparse,
        )

    def _zeros(self, count: int, *, bounds: bool) -> int:
        """Add an accessor of `count` vectors that are zero, over a view that others share."""
        if count > self._zero_rows:
            self._zero_rows = count
            zeros = np.zeros((count, 3), np.float32)
            self._zero_view = self._view(zeros, Target.VERTICES, stride=zeros.itemsize * 3)
        return self.add(
            "accessors",
            bufferView=self._zero_view,
            componentType=COMPONENT_TYPES["float32"],
            count=count,
            type="VEC3",
            min=[0.0] * 3 if bounds else None,
            max=[0.0] * 3 if bounds else None,
        )

    def _view(
        self, array: NDArray[Any], target: Target | None, *, stride: int | None = None
    ) -> int:
        if array.dtype.kind == "f" and not np.isfinite(array).all():
            raise ValueError("glTF holds no infinite numbers and none that are not numbers")
        data = np.ascontiguousarray(array).tobytes()
        offset = len(self.buffer)
        self.buffer += data + bytes(-len(data) % 4)
        return self.add(
            "bufferViews",
            buffer=0,
            byteOffset=offset,
            byteLength=len(data),
            byteStride=stride,
            target=None if target is None else int(target),
        )

    def to_glb(self, **properties: Any) -> bytes:
        """Return the file. `properties` join the top level."""
        return b"".join(self.glb_parts(**properties))

    def glb_parts(self, **properties: Any) -> Iterator[bytes | bytearray]:
        """Yield the file in parts: header, JSON chunk, binary chunk, which is the buffer itself."""
        top: Mapping[str, Any] = {
            "asset": self.asset,
            **properties,
            **self.objects,
            "buffers": [{"byteLength": len(self.buffer)}],
        }
        text = json.dumps(top, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        chunks = ((b"JSON", text), (b"BIN\0", self.buffer))
        size = sum(8 + len(data) for _, data in chunks)
        yield struct.pack("<4sII", b"glTF", 2, 12 + size)
        for kind, data in chunks:
            yield struct.pack("<I4s", len(data), kind)
            yield data
