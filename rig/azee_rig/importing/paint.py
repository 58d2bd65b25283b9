"""Materials of a glTF file as colours per vertex: a rig carries no textures."""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from azee_rig.importing.container import GltfFile, label
from azee_rig.importing.fault import BodyError
from azee_rig.importing.surface_parts import Primitive
from azee_rig.mesh import Part

Floats = NDArray[np.float64]

WHITE = (1.0, 1.0, 1.0, 1.0)
MATT = 0.7
LARGEST = 64_000_000
"""Pixels of a texture that is still read."""


def painted(file: GltfFile, primitives: Sequence[Primitive]) -> tuple[tuple[Part, ...], Floats]:
    """Parts of the joined mesh, and linear colours (N, 3) of all vertices.

    A texture of the base colour is read off at the vertices; one that cannot be read is left out.
    """
    parts, colours, names = [], [], set()
    start = 0
    for i, primitive in enumerate(primitives):
        material = {} if primitive.material is None else file.one("materials", primitive.material)
        name = label(material.get("name")) or f"part {i + 1}"
        while name in names:
            name = f"{name} {i + 1}"
        names.add(name)
        look = material.get("pbrMetallicRoughness")
        colour, rough = _look(look if isinstance(look, dict) else {})
        stop = start + len(primitive.triangles)
        parts.append(Part(name, start, stop, colour, rough))
        start = stop
        paint = primitive.colours
        if primitive.texture is not None:
            pixels = _texture(file, primitive.texture[0])
            if pixels is not None:
                paint = paint * _at(pixels, primitive.texture[1])
        colours.append(paint)
    return tuple(parts), np.vstack(colours)


def _look(look: Mapping[str, Any]) -> tuple[tuple[float, float, float, float], float]:
    factor, rough = look.get("baseColorFactor", WHITE), look.get("roughnessFactor", MATT)
    try:
        r, g, b, a = (min(max(float(x), 0.0), 1.0) for x in factor)
        return (r, g, b, a), min(max(float(rough), 0.0), 1.0)
    except (TypeError, ValueError, OverflowError):
        return WHITE, MATT


def _texture(file: GltfFile, index: int) -> Floats | None:
    """Linear pixels (h, w, 3) of a texture."""
    try:
        source = file.one("textures", index).get("source")
        image = file.one("images", source)
        uri = image.get("uri")
        if isinstance(uri, str) and uri.startswith("data:"):
            data = base64.b64decode(uri.partition(",")[2])
        elif "bufferView" in image:
            data = bytes(file.view(image["bufferView"]))
        else:
            return None
        with Image.open(io.BytesIO(data)) as opened:
            if opened.width * opened.height > LARGEST:
                return None
            srgb = np.asarray(opened.convert("RGB"), dtype=np.float64) / 255.0
    except (BodyError, OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None
    # IEC 61966-2-1
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return np.asarray(linear)


def _at(pixels: Floats, at: Floats) -> Floats:
    height, width = pixels.shape[:2]
    column = np.floor(at[:, 0] % 1.0 * width).astype(np.int64) % width
    row = np.floor(at[:, 1] % 1.0 * height).astype(np.int64) % height
    return np.asarray(pixels[row, column])
