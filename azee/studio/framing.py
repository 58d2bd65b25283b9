"""Messages between the server and its worker: a header in JSON, and bytes.

On a pipe, a message is two lengths (unsigned, 4 bytes each, little-endian), the header, the bytes.
"""

from __future__ import annotations

import json
import struct
from typing import Any, BinaryIO

Header = dict[str, Any]
LENGTHS = struct.Struct("<II")


def packed(header: Header, payload: bytes = b"") -> bytes:
    """Return a message as it goes over a pipe."""
    head = json.dumps(header, separators=(",", ":"), ensure_ascii=False).encode(
        "utf-8", "surrogatepass"
    )
    return LENGTHS.pack(len(head), len(payload)) + head + payload


def unpacked(head: bytes) -> Header:
    """Return a header."""
    found: Header = json.loads(head.decode("utf-8", "surrogatepass"))
    return found


def read_message(stream: BinaryIO) -> tuple[Header, bytes] | None:
    """Return the next message; None at the end."""
    lengths = stream.read(LENGTHS.size)
    if len(lengths) < LENGTHS.size:
        return None
    head, payload = LENGTHS.unpack(lengths)
    data = stream.read(head + payload)
    if len(data) < head + payload:
        return None
    return unpacked(data[:head]), data[head:]
