"""The surface of a body: triangles in parts, colours, skin weights and face shapes."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.fields import mapping, names, number, numbers, rows, text, whole
from azee_rig.machine_code import Kernel
from azee_rig.skeleton import frozen

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_SMOOTH_NORMALS, _UNIT_TURNS = (
    Kernel("azee_rig.skin_kernel", name, "azee_rig.pointers")
    for name in ("smooth_normals", "unit_turns")
)


@dataclass(frozen=True, slots=True)
class Part:
    """A run of triangles [start, stop) with one material.

    colour: linear RGBA, multiplied by the vertex colours. roughness: 0 mirror … 1 matt.
    """

    name: str
    start: int
    stop: int
    colour: tuple[float, float, float, float]
    roughness: float


@dataclass(frozen=True, eq=False)
class BodyMesh:
    """A closed set of arrays that a renderer or an exporter can take as they are.

    vertices: (N, 3) metres, in the mesh's own posture. triangles: (F, 3), counter-clockwise seen
    from outside. parts: materials, in order of their triangles. colours: (N, 3) linear.
    joints, weights: (N, K) influences, heaviest first, rows sum to 1; unused ones have weight 0.
    units: U names. unit_start: (U + 1,) unit u moves vertices unit_rows[s:t] by unit_deltas[s:t]
    with s, t = unit_start[u], unit_start[u + 1]; deltas (·, 3) in metres.
    """

    vertices: Floats
    triangles: Ints
    parts: tuple[Part, ...]
    colours: Floats
    joints: Ints
    weights: Floats
    units: tuple[str, ...]
    unit_start: Ints
    unit_rows: Ints
    unit_deltas: Floats
    joint_count: int

    def __post_init__(self) -> None:
        for name in ("triangles", "joints", "unit_start", "unit_rows"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.int64))
        for name in ("vertices", "colours", "weights", "unit_deltas"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64))
        self._check()

    def _check(self) -> None:
        """Hold every index to what it counts: compiled loops do not. Raises: ValueError."""
        count, moved = len(self.vertices), len(self.unit_rows)
        starts = self.unit_start
        for name, shape in (
            ("vertices", (count, 3)),
            ("triangles", (len(self.triangles), 3)),
            ("colours", (count, 3)),
            ("joints", (count, *self.joints.shape[1:2])),
            ("weights", self.joints.shape),
            ("unit_start", (len(self.units) + 1,)),
            ("unit_rows", (moved,)),
            ("unit_deltas", (moved, 3)),
        ):
            array = getattr(self, name)
            if array.shape != shape:
                raise ValueError(f"its mesh has {name} of shape {array.shape}, not {shape}")
            if array.dtype == np.float64 and not np.isfinite(array).all():
                raise ValueError(f"its mesh has {name} that are infinite or none")
        for name, limit in (
            ("triangles", count),
            ("joints", self.joint_count),
            ("unit_rows", count),
        ):
            array = getattr(self, name)
            if array.size and not 0 <= array.min() <= array.max() < limit:
                raise ValueError(f"its mesh has {name} outside of 0 … {limit - 1}")
        if starts[0] != 0 or starts[-1] != moved or (np.diff(starts) < 0).any():
            raise ValueError("its mesh has face units that do not follow each other")
        at = 0
        for part in self.parts:
            if not at <= part.start <= part.stop <= len(self.triangles):
                raise ValueError(f"part `{part.name}` of its mesh has triangles that are not there")
            at = part.stop

    @cached_property
    def normals(self) -> Floats:
        """Unit vertex normals (N, 3) in the mesh's own posture."""
        return frozen(vertex_normals(self.vertices, self.triangles), np.float64)

    @cached_property
    def dense_weights(self) -> Floats:
        """Skin weights as a matrix (N, J): one product poses the whole mesh."""
        matrix = np.zeros((len(self.vertices), self.joint_count))
        np.add.at(matrix, (np.arange(len(self.vertices))[:, None], self.joints), self.weights)
        matrix.setflags(write=False)
        return matrix

    def unit(self, name: str) -> tuple[Ints, Floats]:
        """Vertices that a face unit moves, and by how much at weight 1: (n,), (n, 3)."""
        u = self.units.index(name)
        run = slice(self.unit_start[u], self.unit_start[u + 1])
        return self.unit_rows[run], self.unit_deltas[run]

    def shaped(self, unit_weights: Floats) -> Floats:
        """Vertices with face units added: v' = v + Σ_u α_u Δv_u."""
        vertices = np.array(self.vertices)
        for u in np.flatnonzero(unit_weights):
            run = slice(self.unit_start[u], self.unit_start[u + 1])
            vertices[self.unit_rows[run]] += unit_weights[u] * self.unit_deltas[run]
        return vertices


def vertex_normals(vertices: Floats, triangles: Ints) -> Floats:
    """Return unit normals (N, 3), each the mean of its triangles' normals by area."""
    vertices = np.ascontiguousarray(vertices, dtype=np.float64)
    triangles = np.ascontiguousarray(triangles, dtype=np.int64)
    normals = np.empty_like(vertices)
    _SMOOTH_NORMALS(len(vertices), len(triangles), vertices, triangles, normals)
    return normals


def turned_normals(mesh: BodyMesh) -> Iterator[tuple[Ints, Floats]]:
    """Yield for every face unit whose normals it changes, (n,) increasing, and to what, (n, 3).

    At weight 1. A normal is the mean of the normals around it, weighted by area, as in
    `vertex_normals`.
    """
    T, count = np.ascontiguousarray(mesh.triangles, dtype=np.int64), len(mesh.vertices)
    corners = T.ravel()
    a, b, c = (mesh.vertices[T[:, k]] for k in range(3))
    faces = np.cross(b - a, c - a)
    sums = np.stack(
        [np.bincount(corners, np.repeat(faces[:, k], 3), count) for k in range(3)], axis=1
    )
    around = np.argsort(corners, kind="stable") // 3
    starts = np.concatenate([[0], np.cumsum(np.bincount(corners, minlength=count))])
    shifts, changes = np.zeros((count, 3)), np.empty((count, 3))
    seen, met = np.full(len(T), -1), np.full(count, -1)
    number, whose, turned = np.zeros(1, np.int64), np.empty(count, np.int64), np.empty((count, 3))
    for stamp, name in enumerate(mesh.units):
        rows, deltas = (np.ascontiguousarray(part) for part in mesh.unit(name))
        _UNIT_TURNS(
            *(count, len(T), len(rows), stamp, rows, deltas, mesh.vertices, T),
            *(around, starts, sums, shifts, changes, seen, met, number, whose, turned),
        )
        found = int(number[0])
        order = np.argsort(whose[:found])
        yield whose[:found][order], turned[:found][order]


def read_mesh(path: Path) -> BodyMesh:
    """Read a packed mesh. Weights are stored as parts of 65535, deltas in units of 1e-5 m.

    Raises: OSError, ValueError, and whatever numpy's reader of zip files raises on a damaged one.
    """
    if not zipfile.is_zipfile(path):
        raise ValueError(f"its {path.name} is no .npz file, or is cut off")
    with path.open("rb") as file, np.load(file, allow_pickle=False) as packed:
        described = mapping(json.loads(_packed(packed, "described").tobytes()), "described")
        weights = _packed(packed, "weights").astype(np.float64)
        sums = weights.sum(axis=-1, keepdims=True)
        if sums.min(initial=1.0) <= 0.0:
            raise ValueError("its mesh has a vertex that no joint carries")
        return BodyMesh(
            vertices=_packed(packed, "vertices", "f"),
            triangles=_packed(packed, "triangles"),
            parts=tuple(_part(row) for row in rows(described["parts"], "parts")),
            colours=_packed(packed, "colours") / 255.0,
            joints=_packed(packed, "joints"),
            weights=weights / sums,
            units=names(described["units"], "units"),
            unit_start=_packed(packed, "unit_start"),
            unit_rows=_packed(packed, "unit_rows"),
            unit_deltas=_packed(packed, "unit_deltas") * number(described["delta_m"], "delta_m"),
            joint_count=whole(described["joint_count"], "joint_count"),
        )


def _packed(packed: Mapping[str, NDArray[Any]], name: str, kinds: str = "iu") -> NDArray[Any]:
    if name not in packed:
        raise ValueError(f"its mesh has no {name}")
    array = packed[name]
    if array.dtype.kind not in kinds:
        raise ValueError(f"its mesh has {name} of type {array.dtype}")
    return array


def _part(row: Mapping[str, Any]) -> Part:
    red, green, blue, opacity = numbers(row["colour"], (4,), "parts.colour").tolist()
    return Part(
        text(row["name"], "parts.name"),
        whole(row["start"], "parts.start"),
        whole(row["stop"], "parts.stop"),
        (red, green, blue, opacity),
        number(row["roughness"], "parts.roughness"),
    )
