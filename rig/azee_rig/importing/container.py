"""The container of a glTF 2.0 file: its JSON and its buffers, from .glb, .vrm or .gltf.

Nothing in a file is trusted: every length and index is checked before it is used.
"""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeGuard
from urllib.parse import unquote, unquote_to_bytes

from azee_rig.fields import shown
from azee_rig.importing.fault import BodyError, unreadable

READ = frozenset(
    {
        "KHR_lights_punctual",
        "KHR_materials_variants",
        "KHR_mesh_quantization",
        "KHR_node_hoverability",
        "KHR_node_selectability",
        "KHR_node_visibility",
        "MSFT_lod",
        "VRM",
        "VRMC_node_constraint",
        "VRMC_vrm",
    }
)
"""Extensions on nodes, meshes and accessors that are read, or that change no shape."""
GEOMETRY = ("nodes", "meshes", "skins", "accessors", "bufferViews", "buffers")
COMPRESSED = {
    "KHR_draco_mesh_compression": "Draco",
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
}


@dataclass(frozen=True, eq=False)
class GltfFile:
    """A file's JSON and buffers, unparsed.

    document: the JSON object. buffers: bytes of each of its buffers. folder: where it lies.
    """

    name: str
    document: Mapping[str, Any]
    buffers: tuple[bytes, ...]
    folder: Path
    _lists: dict[str, Sequence[Mapping[str, Any]]] = field(default_factory=dict)

    def all(self, kind: str) -> Sequence[Mapping[str, Any]]:
        """Objects of an array of the top level, such as "nodes".

        Raises: BodyError: it is no array of objects.
        """
        if kind not in self._lists:
            found = self.document.get(kind, [])
            if not isinstance(found, list) or not all(isinstance(x, dict) for x in found):
                raise unreadable(f"`{kind}` is not a list of objects")
            self._lists[kind] = found
        return self._lists[kind]

    def one(self, kind: str, index: object) -> Mapping[str, Any]:
        """Object of an array of the top level. Raises: BodyError: there is none."""
        found = self.all(kind)
        if not _is_whole(index):
            raise unreadable(f"`{kind}` have numbers, and {shown(index)} is none")
        if not 0 <= index < len(found):
            raise unreadable(f"there is no {shown(index)} in `{kind}`, which has {len(found)}")
        return found[index]

    def view(self, index: object) -> memoryview:
        """Bytes of a buffer view. Raises: BodyError: it does not lie in its buffer."""
        view = self.one("bufferViews", index)
        number = view.get("buffer")
        if not _is_whole(number) or not 0 <= number < len(self.buffers):
            raise unreadable(f"buffer view {index} has no buffer")
        buffer = self.buffers[number]
        start, length = whole(view, "byteOffset", 0), whole(view, "byteLength")
        if start + length > len(buffer):
            raise unreadable(
                f"buffer view {index} ends at byte {shown(start + length)} of {len(buffer)}",
                "the file was probably cut off",
            )
        return memoryview(buffer)[start : start + length]


def whole(item: Mapping[str, Any], key: str, default: int | None = None) -> int:
    """Return a property that is a whole number, not negative. Raises: BodyError."""
    value = item.get(key, default)
    if not _is_whole(value) or value < 0:
        raise unreadable(f"`{key}` is {shown(value)}, not a whole number")
    return value


def _is_whole(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool)


def label(value: object) -> str:
    """Return a name out of the file: "" for what is none, and no half of a surrogate pair."""
    if not isinstance(value, str | int | float) or isinstance(value, bool):
        return ""
    return (value if isinstance(value, str) else shown(value)).encode("utf-8", "replace").decode()


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
    elif data.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] == b"{":
        text, binary = data, None
    else:
        raise unreadable(
            f"`{path.name}` is not a glTF file: it begins with neither `glTF` nor `{{`",
            "FBX, OBJ and Blender's own files can be saved as .glb in Blender",
        )
    document = _json(text)
    file = GltfFile(path.name, document, (), path.parent)
    _check_version(file)
    buffers = tuple(
        _buffer(buffer, binary if i == 0 else None, path.parent, i)
        for i, buffer in enumerate(file.all("buffers"))
    )
    return GltfFile(path.name, document, buffers, path.parent)


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
    except RecursionError as error:
        raise unreadable("its JSON is nested too deeply") from error
    except ValueError as error:
        raise unreadable(f"its JSON cannot be read: {error}") from error
    if not isinstance(document, dict):
        raise unreadable("its JSON is not an object")
    return document


def _check_version(file: GltfFile) -> None:
    asset = file.document.get("asset")
    version = label(asset.get("version")) if isinstance(asset, dict) else ""
    if not version:
        raise unreadable("it has no `asset.version`: it is not glTF")
    if version.split(".")[0] != "2":
        raise BodyError("body-unsupported", f"it is glTF {version}; glTF 2.0 is read")
    required = file.document.get("extensionsRequired", [])
    if not isinstance(required, list) or not all(isinstance(name, str) for name in required):
        raise unreadable("`extensionsRequired` is not a list of names")
    for extension in required:
        # What is needed for looks, light or motion only is no reason to refuse a body.
        if extension in COMPRESSED:
            raise BodyError(
                "body-unsupported",
                f"its mesh is compressed with {COMPRESSED[extension]}, which is not read",
                help_="save it without compression, for example from Blender: in the glTF export, "
                "leave Compression off",
            )
        if extension not in READ and extension in _on_geometry(file):
            raise BodyError(
                "body-unsupported",
                f"it needs the glTF extension `{label(extension)}`, which is not read",
            )


def _buffer(buffer: Mapping[str, Any], binary: bytes | None, folder: Path, index: int) -> bytes:
    length, uri = whole(buffer, "byteLength"), buffer.get("uri")
    if uri is None:
        data = binary or b""
    elif not isinstance(uri, str):
        raise unreadable(f"the address of buffer {index} is not a text")
    else:
        data = bytes_at(uri, folder, f"buffer {index}")
    if len(data) < length:
        raise unreadable(
            f"buffer {index} should have {shown(length)} bytes and has {len(data)}",
            "the file was probably cut off",
        )
    return data[:length]


def _on_geometry(file: GltfFile) -> set[str]:
    """Names of the extensions that stand on what a body's shape is made of."""
    rows: list[object] = [row for kind in GEOMETRY for row in file.all(kind)]
    for mesh in file.all("meshes"):
        primitives = mesh.get("primitives")
        rows += primitives if isinstance(primitives, list) else []
    found = [row.get("extensions") for row in rows if isinstance(row, dict)]
    return {name for extensions in found if isinstance(extensions, dict) for name in extensions}


def bytes_at(uri: str, folder: Path, what: str) -> bytes:
    """Bytes that an address holds itself (`data:`), or of a file beside the .gltf.

    Args: what: what they are, for messages. Raises: BodyError: they are not there.
    """
    if not uri.startswith("data:"):
        return _beside(folder, uri, what)
    head, _, body = uri.partition(",")
    try:
        if not head.endswith("base64"):
            return unquote_to_bytes(body)
        return base64.b64decode(unquote(body), validate=True)
    except ValueError as error:
        raise unreadable(f"{what} is not sound base64") from error


def _beside(folder: Path, uri: str, what: str) -> bytes:
    """Read a file that lies beside the .gltf, and nowhere else."""
    place = Path(unquote(uri))
    named = f"{what}, `{label(uri[:80])!a}`,".replace("`'", "`").replace("'`", "`")
    if "://" in uri or place.is_absolute() or ".." in place.parts:
        raise unreadable(f"{named} does not lie beside it")
    try:
        return (folder / place).read_bytes()
    except (OSError, ValueError) as error:
        raise unreadable(f"{named} is not there") from error
