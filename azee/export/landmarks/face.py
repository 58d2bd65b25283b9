"""Where MediaPipe's 468 landmarks of the face are on a body's skin.

data/face.csv names three vertices of the head and their weights for each. All bodies that ship
have the same head but for its shape; `benchmarks/tracker/face_map.py` found the landmarks. On
another body they are carried over: the sites of the head move the signer's landmarks by thin-plate
splines (Bookstein 1989, in space with the kernel r), and the nearest places of the skin are taken.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.formats.moving_body import postures
from azee_rig.load import load_rig
from azee_rig.nearest import barycentric, nearest
from azee_rig.rig import SHIPPED, Rig
from azee_rig.skin import joint_frames

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TABLE = Path(__file__).with_name("data") / "face.csv"
REFERENCE = "signer"
HEAD_SHARE = 0.5
"""Weight of the head's joint from which skin counts as that of the head."""


@dataclass(frozen=True, eq=False)
class FaceMarks:
    """Landmarks on the skin of a body: vertices (468, 3) and their weights (468, 3), sums 1."""

    vertices: Ints
    weights: Floats


_KNOWN: WeakKeyDictionary[Rig, FaceMarks] = WeakKeyDictionary()


def face_marks(rig: Rig) -> FaceMarks:
    """Return the landmarks of a body's face; they are found once."""
    found = _KNOWN.get(rig)
    if found is None:
        found = _shipped(rig) if rig.folder.parent == SHIPPED else _carried_over(rig)
        _KNOWN[rig] = found
    return found


def head_triangles(rig: Rig) -> Ints:
    """Return the triangles (F, 3) of a mesh that its head's joints carry."""
    mesh = rig.mesh
    joints = np.flatnonzero(rig.drive.node == rig.bones["head"].node)
    share = mesh.dense_weights[:, joints].sum(axis=1)
    return np.asarray(mesh.triangles[(share[mesh.triangles] > HEAD_SHARE).all(axis=1)])


def skin_of_head(rig: Rig) -> Ints:
    """Return the vertices of the head's skin on a body that ships, in the mesh's order."""
    triangles = head_triangles(rig)
    skin = np.unique(rig.mesh.triangles[: rig.mesh.parts[0].stop])
    return np.intersect1d(triangles, skin)


def _shipped(rig: Rig) -> FaceMarks:
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = [[float(cell) for cell in row[1:]] for row in [*csv.reader(file)][1:]]
    table = np.array(rows)
    weights = table[:, 3:]
    vertices = skin_of_head(rig)[table[:, :3].astype(np.int64)]
    return FaceMarks(vertices, weights / weights.sum(axis=1, keepdims=True))


def _carried_over(rig: Rig) -> FaceMarks:
    """Return the landmarks of a body whose head is not the one that ships."""
    signer = load_rig(REFERENCE)
    names = [
        name
        for name, site in signer.sites.items()
        if site.bone == "head" and name in rig.sites and rig.sites[name].bone == "head"
    ]
    here, there = (
        np.stack([one.sites[name].point(one.chain.frames(one.coordinates.bind)) for name in names])
        for one in (signer, rig)
    )
    own = face_marks(signer)
    marks = np.einsum("lk,lkc->lc", own.weights, signer.mesh.vertices[own.vertices])
    places = _warped(marks, here, there)
    mesh, triangles = rig.mesh, head_triangles(rig)
    found = nearest(mesh.vertices, triangles, places)
    chosen = triangles[found.triangles]
    weights = barycentric(mesh.vertices[chosen], found.points)
    return FaceMarks(chosen, np.clip(weights, 0.0, 1.0))


def _warped(points: Floats, here: Floats, there: Floats) -> Floats:
    """Move points (N, 3) as the thin-plate spline does that takes `here` (S, 3) to `there`."""
    count = len(here)

    def kernel(at: Floats) -> Floats:
        return np.asarray(np.linalg.norm(at[:, None] - here[None], axis=2))

    def affine(at: Floats) -> Floats:
        return np.hstack([np.ones((len(at), 1)), at])

    system = np.zeros((count + 4, count + 4))
    system[:count, :count] = kernel(here)
    system[:count, count:] = affine(here)
    system[count:, :count] = affine(here).T
    solved = np.linalg.lstsq(system, np.vstack([there, np.zeros((4, 3))]), rcond=None)[0]
    return np.asarray(kernel(points) @ solved[:count] + affine(points) @ solved[count:])


def face_points(clip: Clip, rig: Rig) -> Iterator[tuple[slice, Floats]]:
    """Yield the landmarks in the world, a chunk of frames at a time: (T, 468, 3) metres.

    Linear blend skinning of the vertices that carry landmarks, with the clip's face units.
    """
    marks, mesh = face_marks(rig), rig.mesh
    used, corner = np.unique(marks.vertices, return_inverse=True)
    corner = corner.reshape(marks.vertices.shape)
    shapes = np.zeros((len(clip.units), len(used), 3))
    for u, unit in enumerate(clip.units):
        rows, deltas = mesh.unit(unit)
        among = np.searchsorted(used, rows).clip(max=len(used) - 1)
        there = used[among] == rows
        np.add.at(shapes[u], among[there], deltas[there])
    joints = np.flatnonzero(mesh.dense_weights[used].any(axis=0))
    weights = mesh.dense_weights[used][:, joints]
    rest = rig.skeleton.rest_positions[joints]
    for frames, pose in postures(clip, rig):
        positions, rotations = joint_frames(rig.skeleton, pose)
        R, p = rotations[:, joints], positions[:, joints]
        shift = p - (R @ rest[:, :, None])[..., 0]
        shaped = mesh.vertices[used] + np.tensordot(clip.unit_weights[frames], shapes, axes=1)
        turn = np.tensordot(R, weights, axes=([1], [1]))
        moved = np.einsum("tabn,tnb->tna", turn, shaped)
        moved += np.tensordot(weights, shift, axes=([1], [1])).swapaxes(0, 1)
        yield frames, np.einsum("lk,tlkc->tlc", marks.weights, moved[:, corner])
