"""A short reader of GLB files that shares nothing with the writer: what a file says, as arrays."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

NUMBERS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@dataclass(frozen=True)
class GlbArrays:
    """document: the JSON. binary: the buffer."""

    document: dict[str, Any]
    binary: bytes

    @staticmethod
    def read(path: Path) -> GlbArrays:
        data = path.read_bytes()
        size = struct.unpack_from("<I", data, 12)[0]
        return GlbArrays(json.loads(data[20 : 20 + size]), data[28 + size :])

    def array(self, index: int) -> NDArray[Any]:
        """Rows of an accessor, normalised integers as shares of 1."""
        accessor = self.document["accessors"][index]
        dtype, width = np.dtype(NUMBERS[accessor["componentType"]]), WIDTHS[accessor["type"]]
        count = accessor["count"]
        rows = np.zeros((count, width), dtype)
        if "bufferView" in accessor:
            rows = self._rows(accessor["bufferView"], dtype, count, width)
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            few = sparse["count"]
            kind = np.dtype(NUMBERS[sparse["indices"]["componentType"]])
            where = self._rows(sparse["indices"]["bufferView"], kind, few, 1)[:, 0]
            rows[where] = self._rows(sparse["values"]["bufferView"], dtype, few, width)
        return rows / np.iinfo(dtype).max if accessor.get("normalized") else rows

    def _rows(self, view: int, dtype: np.dtype[Any], count: int, width: int) -> NDArray[Any]:
        start = self.document["bufferViews"][view]["byteOffset"]
        rows = np.frombuffer(self.binary, dtype, count * width, start)
        return np.array(rows.reshape(count, width))

    def joints(self) -> dict[str, tuple[str, NDArray[np.float64], NDArray[np.float64]]]:
        """Name of each joint's parent, its own translation, and its inverse bind matrix."""
        nodes = self.document["nodes"]
        (skin,) = self.document["skins"]
        inverse = self.array(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
        above = {child: i for i, node in enumerate(nodes) for child in node.get("children", ())}
        return {
            nodes[j]["name"]: (
                nodes[above[j]]["name"] if j in above else "",
                np.array(nodes[j]["translation"]),
                matrix,
            )
            for j, matrix in zip(skin["joints"], inverse, strict=True)
        }
