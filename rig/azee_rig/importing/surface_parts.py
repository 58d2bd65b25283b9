"""Triangles, influences, colours and morph targets of the meshes of a glTF file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.fields import number, numbers
from azee_rig.importing.accessors import read_array
from azee_rig.importing.container import COMPRESSED, GltfFile, label, whole
from azee_rig.importing.fault import BodyError, unreadable

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

POINTS, LINES = 0, (1, 2, 3)
TRIANGLES, STRIP, FAN = 4, 5, 6
FARTHEST = 1e15
"""No coordinate of a vertex is larger."""
TRANSFORM, GLOSSY = "KHR_texture_transform", "KHR_materials_pbrSpecularGlossiness"
SETS = 4
"""Sets of four influences that are read."""


@dataclass(frozen=True, eq=False)
class Primitive:
    """Triangles of one material, in the mesh's own space.

    vertices (n, 3); triangles (f, 3); joints (n, k) numbers in the skin and weights (n, k), k = 0
    without a skin; colours (n, 3) linear; targets: per morph target displacements (n, 3).
    texture: number of the base colour's texture with its coordinates (n, 2), or None.
    """

    material: int | None
    vertices: Floats
    triangles: Ints
    joints: Ints
    weights: Floats
    colours: Floats
    targets: tuple[Floats, ...]
    texture: tuple[int, Floats] | None


def read_primitives(file: GltfFile, mesh: Mapping[str, Any]) -> Iterator[Primitive]:
    """Yield a mesh's triangles, a material at a time; points and lines are left out.

    Raises: BodyError: they are damaged or compressed.
    """
    rows = mesh.get("primitives")
    for row in rows if isinstance(rows, list) else []:
        if not isinstance(row, dict) or not isinstance(row.get("attributes"), dict):
            raise unreadable("a mesh has a primitive without attributes")
        if row.get("mode", TRIANGLES) in (TRIANGLES, STRIP, FAN):
            yield _primitive(file, row)


def target_names(mesh: Mapping[str, Any]) -> list[str]:
    """Names of a mesh's morph targets, where it tells them."""
    rows = mesh.get("primitives")
    for owner in (mesh, *(rows if isinstance(rows, list) else [])):
        extras = owner.get("extras") if isinstance(owner, dict) else None
        names = extras.get("targetNames") if isinstance(extras, dict) else None
        if isinstance(names, list):
            return [label(name) or f"target {i + 1}" for i, name in enumerate(names)]
    return []


def _primitive(file: GltfFile, row: Mapping[str, Any]) -> Primitive:
    attributes = row["attributes"]
    extensions = row.get("extensions")
    for extension in extensions if isinstance(extensions, dict) else {}:
        if extension in COMPRESSED and "POSITION" not in attributes:
            raise BodyError(
                "body-unsupported",
                f"its mesh is compressed with {COMPRESSED[extension]}, which is not read",
                help_="save it without compression",
            )
    if "POSITION" not in attributes:
        raise unreadable("a mesh has no positions")
    vertices = read_array(file, attributes["POSITION"], "VEC3").astype(np.float64)
    count = len(vertices)
    if np.abs(vertices).max(initial=0.0) > FARTHEST:
        raise unreadable("a mesh has a vertex farther away than numbers reach")
    if row.get("indices") is None:
        corners = np.arange(count)
    else:
        corners = _whole(read_array(file, row["indices"], "SCALAR")[:, 0], "corners")
    if len(corners) and not 0 <= corners.min() <= corners.max() < count:
        raise unreadable(f"a triangle has a corner {corners.max()} of {count} vertices")
    joints, weights = _influences(file, attributes, count)
    material = row.get("material")
    return Primitive(
        material if isinstance(material, int) else None,
        vertices,
        _triangles(corners, row.get("mode", TRIANGLES)),
        joints,
        weights,
        _colours(file, attributes, count),
        tuple(_targets(file, row.get("targets"), count)),
        _texture(file, material, attributes, count),
    )


def _triangles(corners: Ints, mode: int) -> Ints:
    if mode == TRIANGLES:
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)
    if len(corners) < 3:
        return np.zeros((0, 3), np.int64)
    if mode == FAN:
        first = np.full(len(corners) - 2, corners[0])
        return np.stack([first, corners[1:-1], corners[2:]], axis=1)
    strip = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
    strip[1::2, :2] = strip[1::2, 1::-1]
    return strip


def _same_count(rows: NDArray[Any], count: int, what: str) -> NDArray[Any]:
    if len(rows) != count:
        raise unreadable(f"a mesh has {count} positions and {len(rows)} {what}")
    return rows


def _whole(rows: NDArray[Any], what: str) -> Ints:
    """Return whole numbers, which some files write as reals."""
    if rows.dtype.kind == "f" and (np.abs(rows).max(initial=0.0) > 2.0**31 or (rows % 1.0).any()):
        raise unreadable(f"a mesh has {what} that are no whole numbers")
    return rows.astype(np.int64)


def _influences(file: GltfFile, attributes: Mapping[str, Any], count: int) -> tuple[Ints, Floats]:
    joints, weights = [], []
    for i in range(SETS):
        if f"JOINTS_{i}" in attributes and f"WEIGHTS_{i}" in attributes:
            of = read_array(file, attributes[f"JOINTS_{i}"], "VEC4")
            by = read_array(file, attributes[f"WEIGHTS_{i}"], "VEC4")
            joints.append(_whole(_same_count(of, count, "joints"), "joints"))
            weights.append(np.maximum(_same_count(by, count, "weights").astype(np.float64), 0.0))
    if not joints:
        return np.zeros((count, 0), np.int64), np.zeros((count, 0))
    return np.hstack(joints), np.hstack(weights)


def _colours(file: GltfFile, attributes: Mapping[str, Any], count: int) -> Floats:
    if "COLOR_0" not in attributes:
        return np.ones((count, 3))
    rows = read_array(file, attributes["COLOR_0"], "VEC3", "VEC4")
    return np.clip(_same_count(rows, count, "colours")[:, :3].astype(np.float64), 0.0, 1.0)


def _targets(file: GltfFile, targets: object, count: int) -> Iterator[Floats]:
    for target in targets if isinstance(targets, list) else []:
        if isinstance(target, dict) and "POSITION" in target:
            rows = read_array(file, target["POSITION"], "VEC3").astype(np.float64)
            yield _same_count(rows, count, "displacements")
        else:
            yield np.zeros((count, 3))


def _texture(
    file: GltfFile, material: object, attributes: Mapping[str, Any], count: int
) -> tuple[int, Floats] | None:
    if material is None:
        return None
    info = base_look(file.one("materials", material)).get("baseColorTexture")
    if not isinstance(info, dict) or not isinstance(info.get("index"), int):
        return None
    extensions = info.get("extensions")
    transform = extensions.get(TRANSFORM) if isinstance(extensions, dict) else None
    transform = transform if isinstance(transform, dict) else {}
    name = f"TEXCOORD_{whole(transform, 'texCoord', whole(info, 'texCoord', 0))}"
    if name not in attributes:
        return None
    at = read_array(file, attributes[name], "VEC2").astype(np.float64)
    if np.abs(at).max(initial=0.0) > FARTHEST:
        raise unreadable("a mesh has a texture coordinate farther away than numbers reach")
    return info["index"], _same_count(_shifted(at, transform), count, "texture coordinates")


def _shifted(at: Floats, transform: Mapping[str, Any]) -> Floats:
    """Texture coordinates (n, 2) moved as KHR_texture_transform says: scaled, turned, shifted."""
    try:
        shift, scale = (
            numbers(transform.get(key, usual), (2,), key)
            for key, usual in (("offset", [0.0, 0.0]), ("scale", [1.0, 1.0]))
        )
        angle = number(transform.get("rotation", 0.0), "rotation")
    except ValueError as error:
        raise unreadable(f"a texture is moved by what is no number: {error}") from error
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, s], [-s, c]])
    return np.asarray((at * scale) @ turn.T + shift)


def base_look(material: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the base colour of a material, which an older extension calls diffuse."""
    look = material.get("pbrMetallicRoughness")
    extensions = material.get("extensions")
    older = extensions.get(GLOSSY) if isinstance(extensions, dict) else None
    if isinstance(older, dict) and not isinstance(look, dict):
        pairs = (("baseColorFactor", "diffuseFactor"), ("baseColorTexture", "diffuseTexture"))
        return {new: older[old] for new, old in pairs if old in older}
    return look if isinstance(look, dict) else {}


def stacked(arrays: Sequence[NDArray[Any]], width: int) -> NDArray[Any]:
    """Rows below rows, the narrower ones filled up with zeros."""
    return np.vstack([np.pad(a, ((0, 0), (0, width - a.shape[1]))) for a in arrays])
