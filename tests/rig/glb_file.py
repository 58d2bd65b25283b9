"""A GLB file as JSON and buffer, to be changed and written again."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass
class GlbFile:
    """document: its JSON. binary: its one buffer."""

    document: dict[str, Any]
    binary: bytes

    @staticmethod
    def read(path: Path) -> GlbFile:
        return GlbFile.of(path.read_bytes())

    @staticmethod
    def of(data: bytes) -> GlbFile:
        size = struct.unpack_from("<I", data, 12)[0]
        return GlbFile(json.loads(data[20 : 20 + size]), data[28 + size :])

    def copy(self) -> GlbFile:
        return GlbFile(json.loads(json.dumps(self.document)), self.binary)

    def data(self) -> bytes:
        text = json.dumps(self.document).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def write(self, path: Path) -> Path:
        path.write_bytes(self.data())
        return path

    @property
    def nodes(self) -> list[dict[str, Any]]:
        nodes: list[dict[str, Any]] = self.document["nodes"]
        return nodes
