"""Materials of a glTF file as colours per vertex: a rig carries no textures."""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from azee_rig.importing.container import GltfFile, bytes_at, label
from azee_rig.importing.fault import BodyError
from azee_rig.importing.surface_parts import Primitive, base_look
from azee_rig.mesh import Part

Floats = NDArray[np.float64]

WHITE = (1.0, 1.0, 1.0, 1.0)
MATT = 0.7
LARGEST = 64_000_000
"""Pixels of a texture that is still read."""
UNREADABLE = (
    *(OSError, ValueError, SyntaxError, TypeError, LookupError, ArithmeticError, EOFError),
    *(MemoryError, NotImplementedError, struct.error, Image.DecompressionBombError),
)
"""What Pillow's readers of many formats raise on images that are damaged."""


def painted(
    file: GltfFile, primitives: Sequence[Primitive]
) -> tuple[tuple[Part, ...], Floats, tuple[str, ...]]:
    """Parts of the joined mesh, linear colours (N, 3) of all vertices, and notes.

    A texture of the base colour is read off at the vertices; one that cannot be read is left out,
    with a note.
    """
    parts, colours, names = [], [], set()
    textures: dict[int, Floats | None] = {}
    start = 0
    for i, primitive in enumerate(primitives):
        material = {} if primitive.material is None else file.one("materials", primitive.material)
        name = label(material.get("name")) or f"part {i + 1}"
        while name in names:
            name = f"{name} {i + 1}"
        names.add(name)
        colour, rough = _look(material)
        stop = start + len(primitive.triangles)
        parts.append(Part(name, start, stop, colour, rough))
        start = stop
        paint = primitive.colours
        if primitive.texture is not None:
            number, at = primitive.texture
            if number not in textures:
                textures[number] = _texture(file, number)
            pixels = textures[number]
            if pixels is not None:
                paint = paint * _at(pixels, at)
        colours.append(paint)
    lost = sum(pixels is None for pixels in textures.values())
    what = "its texture" if len(textures) == 1 else f"{lost} of its {len(textures)} textures"
    notes = (f"{what} could not be read: there its materials' plain colours are seen",)
    return tuple(parts), np.vstack(colours), notes if lost else ()


def _look(material: Mapping[str, Any]) -> tuple[tuple[float, float, float, float], float]:
    look = base_look(material)
    factor, rough = look.get("baseColorFactor", WHITE), look.get("roughnessFactor", MATT)
    try:
        r, g, b, a = (min(max(float(x), 0.0), 1.0) for x in factor)
        return (r, g, b, a), min(max(float(rough), 0.0), 1.0)
    except (TypeError, ValueError, OverflowError):
        return WHITE, MATT


def _texture(file: GltfFile, index: int) -> Floats | None:
    """Linear pixels (h, w, 3) of a texture; None where none of its images can be read."""
    for source in _sources(file.one("textures", index)):
        data = _image_data(file, source)
        srgb = None if data is None else _pixels(data)
        if srgb is not None:
            return _linear(srgb)
    return None


def _sources(texture: Mapping[str, Any]) -> Iterator[object]:
    """Numbers of the images that a texture names: its own, and those of other formats."""
    if "source" in texture:
        yield texture["source"]
    extensions = texture.get("extensions")
    for extension in extensions.values() if isinstance(extensions, dict) else ():
        if isinstance(extension, dict) and "source" in extension:
            yield extension["source"]


def _image_data(file: GltfFile, source: object) -> bytes | None:
    try:
        image = file.one("images", source)
        uri = image.get("uri")
        if isinstance(uri, str):
            return bytes_at(uri, file.folder, "an image")
        return bytes(file.view(image["bufferView"])) if "bufferView" in image else None
    except BodyError:
        return None


def _pixels(data: bytes) -> Floats | None:
    """Read an image as sRGB, (h, w, 3) in 0 … 1."""
    try:
        with Image.open(io.BytesIO(data)) as opened:
            if opened.width * opened.height > LARGEST:
                return None
            return np.asarray(opened.convert("RGB"), dtype=np.float64) / 255.0
    except UNREADABLE:
        return None


def _linear(srgb: Floats) -> Floats:
    """Linear light of sRGB values (IEC 61966-2-1)."""
    return np.asarray(np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4))


def _at(pixels: Floats, at: Floats) -> Floats:
    height, width = pixels.shape[:2]
    column = np.floor(at[:, 0] % 1.0 * width).astype(np.int64) % width
    row = np.floor(at[:, 1] % 1.0 * height).astype(np.int64) % height
    return np.asarray(pixels[row, column])
