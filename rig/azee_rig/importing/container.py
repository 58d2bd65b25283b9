"""The container of a glTF 2.0 file: its JSON and its buffers, from .glb, .vrm or .gltf.

Nothing in a file is trusted: every length and index is checked before it is used.
"""

from __future__ import annotations

import base64
import binascii
import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from azee_rig.importing.fault import BodyError, unreadable

READ = frozenset(
    {
        "VRM",
        "VRMC_vrm",
        "VRMC_springBone",
        "VRMC_node_constraint",
        "VRMC_materials_mtoon",
        "VRMC_materials_hdr_emissiveMultiplier",
        "KHR_materials_unlit",
        "KHR_mesh_quantization",
        "KHR_texture_transform",
    }
)
"""Extensions without which a file may not be read, and which are read or change nothing here."""
COMPRESSED = {
    "KHR_draco_mesh_compression": "Draco",
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
}


@dataclass(frozen=True, eq=False)
class GltfFile:
    """A file's JSON and buffers, unparsed.

    document: the JSON object. buffers: bytes of each of its buffers.
    """

    name: str
    document: Mapping[str, Any]
    buffers: tuple[bytes, ...]

    def all(self, kind: str) -> Sequence[Mapping[str, Any]]:
        """Objects of an array of the top level, such as "nodes".

        Raises: BodyError: it is no array of objects.
        """
        found = self.document.get(kind, [])
        if not isinstance(found, list) or not all(isinstance(x, dict) for x in found):
            raise unreadable(f"`{kind}` is not a list of objects")
        return found

    def one(self, kind: str, index: object) -> Mapping[str, Any]:
        """Object of an array of the top level. Raises: BodyError: there is none."""
        found = self.all(kind)
        if not isinstance(index, int) or isinstance(index, bool) or not 0 <= index < len(found):
            raise unreadable(f"there is no {index} in `{kind}`, which has {len(found)}")
        return found[index]

    def view(self, index: object) -> memoryview:
        """Bytes of a buffer view. Raises: BodyError: it does not lie in its buffer."""
        view = self.one("bufferViews", index)
        number = view.get("buffer")
        if not isinstance(number, int) or not 0 <= number < len(self.buffers):
            raise unreadable(f"buffer view {index} has no buffer")
        buffer = self.buffers[number]
        start, length = whole(view, "byteOffset", 0), whole(view, "byteLength")
        if start + length > len(buffer):
            raise unreadable(
                f"buffer view {index} ends at byte {start + length} of {len(buffer)}",
                "the file was probably cut off",
            )
        return memoryview(buffer)[start : start + length]


def whole(item: Mapping[str, Any], key: str, default: int | None = None) -> int:
    """Return a property that is a whole number, not negative. Raises: BodyError."""
    value = item.get(key, default)
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise unreadable(f"`{key}` is {value!r}, not a whole number")
    return value


def read_gltf(path: Path) -> GltfFile:
    """Read a .glb, .vrm or .gltf file.

    Raises: BodyError: it is none, is damaged, or needs an extension that is not read here.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        reason = (error.strerror or type(error).__name__).lower()
        raise unreadable(f"cannot read `{path}`: {reason}") from error
    if data.startswith(b"glTF"):
        text, binary = _chunks(data)
    elif data.lstrip()[:1] == b"{":
        text, binary = data, None
    else:
        raise unreadable(
            f"`{path.name}` is not a glTF file: it begins with neither `glTF` nor `{{`",
            "FBX, OBJ and Blender's own files can be saved as .glb in Blender",
        )
    document = _json(text)
    file = GltfFile(path.name, document, ())
    _check_version(file)
    buffers = tuple(
        _buffer(buffer, binary if i == 0 else None, path.parent, i)
        for i, buffer in enumerate(file.all("buffers"))
    )
    return GltfFile(path.name, document, buffers)


def _chunks(data: bytes) -> tuple[bytes, bytes | None]:
    """JSON and binary chunk of a GLB."""
    if len(data) < 12:
        raise unreadable("the file ends within its header")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise BodyError(
            "body-unsupported",
            f"it is glTF {version}; glTF 2.0 is read",
            help_="save it anew, for example from Blender",
        )
    if length > len(data):
        raise unreadable(
            f"the file is cut off: it says {length} bytes and has {len(data)}",
        )
    found: dict[bytes, bytes] = {}
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<I4s", data, at)
        if at + 8 + size > length:
            raise unreadable(f"the chunk at byte {at} runs beyond the end of the file")
        found.setdefault(kind, data[at + 8 : at + 8 + size])
        at += 8 + size
    if b"JSON" not in found:
        raise unreadable("the file has no JSON chunk")
    return found[b"JSON"], found.get(b"BIN\0")


def _json(text: bytes) -> Mapping[str, Any]:
    try:
        document = json.loads(text.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise unreadable(f"its JSON cannot be read: {error}") from error
    if not isinstance(document, dict):
        raise unreadable("its JSON is not an object")
    return document


def _check_version(file: GltfFile) -> None:
    asset = file.document.get("asset")
    version = str(asset.get("version", "")) if isinstance(asset, dict) else ""
    if not version:
        raise unreadable("it has no `asset.version`: it is not glTF")
    if version.split(".")[0] != "2":
        raise BodyError("body-unsupported", f"it is glTF {version}; glTF 2.0 is read")
    required = file.document.get("extensionsRequired", [])
    for extension in required if isinstance(required, list) else []:
        if extension in COMPRESSED:
            raise BodyError(
                "body-unsupported",
                f"its mesh is compressed with {COMPRESSED[extension]}, which is not read",
                help_="save it without compression, for example from Blender: in the glTF export, "
                "leave Compression off",
            )
        if extension not in READ:
            raise BodyError(
                "body-unsupported", f"it needs the glTF extension `{extension}`, which is not read"
            )


def _buffer(buffer: Mapping[str, Any], binary: bytes | None, folder: Path, index: int) -> bytes:
    length, uri = whole(buffer, "byteLength"), buffer.get("uri")
    if uri is None:
        data = binary or b""
    elif not isinstance(uri, str):
        raise unreadable(f"the address of buffer {index} is not a text")
    elif uri.startswith("data:"):
        head, _, body = uri.partition(",")
        try:
            data = base64.b64decode(body, validate=True) if head.endswith("base64") else b""
        except binascii.Error as error:
            raise unreadable(f"buffer {index} is not sound base64") from error
    else:
        data = _beside(folder, uri)
    if len(data) < length:
        raise unreadable(
            f"buffer {index} should have {length} bytes and has {len(data)}",
            "the file was probably cut off",
        )
    return data[:length]


def _beside(folder: Path, uri: str) -> bytes:
    """Read a file that lies beside the .gltf, and nowhere else."""
    place = Path(unquote(uri))
    if "://" in uri or place.is_absolute() or ".." in place.parts:
        raise unreadable(f"its buffer `{uri[:80]}` does not lie beside it")
    try:
        return (folder / place).read_bytes()
    except OSError as error:
        raise unreadable(f"its buffer `{uri[:80]}` is not there") from error
