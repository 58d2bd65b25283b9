"""Finds MediaPipe's 468 landmarks of the face on the signer's skin.

`python -m benchmarks.tracker.face_map` draws the face from nine angles. A ray through each landmark
that the tracker finds meets the skin; the hits from all angles are averaged, those that meet the
skin frontally counting most. Both sides are made alike, and the nearest places of the skin are
written as three vertices and their weights, which is what `azee.export.landmarks.face` reads.
Closed lips lie on each other: the upper one is what an opening jaw leaves where it is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from azee.export.landmarks.face import TABLE, skin_of_head
from azee.export.pictures.camera import VIEWS, Camera, camera, from_direction
from azee.export.pictures.picture import render
from azee_rig.load import load_rig
from azee_rig.mesh import vertex_normals
from azee_rig.nearest import barycentric, nearest
from azee_rig.rig import Rig
from benchmarks.tracker.environment import OUT, interpreter, look_for_faces

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ANGLES_DEG = (
    *((0.0, 0.0), (-20.0, 0.0), (20.0, 0.0), (-40.0, 0.0), (40.0, 0.0)),
    *((0.0, 15.0), (0.0, -15.0), (-20.0, -15.0), (20.0, -15.0)),
)
"""From where the face is seen: to its left and from above, degrees."""
SIZE = (512, 512)
"""Pixels."""
UPPER_LIP = (
    *(185, 40, 39, 37, 0, 267, 269, 270, 409, 184, 74, 73, 72, 11, 302, 303, 304, 408),
    *(183, 42, 41, 38, 12, 268, 271, 272, 407, 191, 80, 81, 82, 13, 312, 311, 310, 415),
)
LOWER_LIP = (
    *(146, 91, 181, 84, 17, 314, 405, 321, 375, 77, 90, 180, 85, 16, 315, 404, 320, 307),
    *(96, 89, 179, 86, 15, 316, 403, 319, 325, 95, 88, 178, 87, 14, 317, 402, 318, 324),
)
"""Landmarks of the lips."""
JAW, WITH_JAW = "jawOpen", 0.35
"""The unit that opens the jaw, and the share of its longest way from which skin goes with it."""
INSIDE = -0.6
"""Component of the skin's normal to the front below which it is the inside of the mouth."""
FRONTAL = 4.0
"""Power of the cosine between ray and skin with which a hit counts."""


def main() -> None:
    """Write the table."""
    rig = load_rig()
    places = landmarks_on(rig)
    places = (places + places[mirrored(places)] * (-1.0, 1.0, 1.0)) / 2.0
    triangles = front_of_head(rig)
    goes = with_jaw(rig)[triangles]
    vertices, weights = on_skin(rig, triangles, places)
    for lip, its_own in ((UPPER_LIP, ~goes.any(axis=1)), (LOWER_LIP, goes.all(axis=1))):
        rows = np.array(lip)
        vertices[rows], weights[rows] = on_skin(rig, triangles[its_own], places[rows])
    ranks = np.searchsorted(skin_of_head(rig), vertices)
    lines = ["landmark,vertex_1,vertex_2,vertex_3,weight_1,weight_2,weight_3"]
    for n, (corners, shares) in enumerate(zip(ranks.tolist(), weights.tolist(), strict=True)):
        lines.append(",".join([str(n), *map(str, corners), *(f"{share:.4f}" for share in shares)]))
    TABLE.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    print(f"wrote {TABLE}")


def landmarks_on(rig: Rig) -> Floats:
    """Return where the landmarks are on a face at rest, (468, 3) metres."""
    skin = rig.skin(rig.pose(rig.coordinates.idle))
    eyes = cameras(rig)
    pictures = [np.asarray(render(skin, rig.mesh, eye, SIZE, samples=2)) for eye in eyes]
    folder = OUT / "tracker"
    folder.mkdir(parents=True, exist_ok=True)
    seen, out = folder / "face_map.npz", folder / "face_map.npy"
    np.savez(seen, pictures=np.stack(pictures))
    look_for_faces(interpreter(), seen, out)
    triangles = skin_triangles(rig)
    total, weight = np.zeros((468, 3)), np.zeros(468)
    for marks, eye in zip(np.load(out), eyes, strict=True):
        if np.isnan(marks).any():
            continue
        ways = rays(marks[:, :2], eye)
        hits, cosines = first_hits(eye.eye, ways, skin, triangles)
        shares = np.where(np.isfinite(hits[:, 0]), np.maximum(cosines, 0.02) ** FRONTAL, 0.0)
        total += shares[:, None] * np.nan_to_num(hits)
        weight += shares
    return total / weight[:, None]


def cameras(rig: Rig) -> list[Camera]:
    """Return a camera for every angle."""
    target = camera(rig, rig.coordinates.idle, "face").target
    made = []
    for left, above in np.radians(ANGLES_DEG):
        towards = [np.sin(left) * np.cos(above), np.sin(above), np.cos(left) * np.cos(above)]
        made.append(from_direction(target, np.array(towards), VIEWS["face"][2]))
    return made


def rays(pixels: Floats, eye: Camera) -> Floats:
    """Return unit directions (N, 3) in the world through pixels (N, 2)."""
    width, height = SIZE
    scale = height / 2.0 / np.tan(eye.height_rad / 2.0)
    local = np.stack(
        [
            (pixels[:, 0] - width / 2.0) / scale,
            (height / 2.0 - pixels[:, 1]) / scale,
            np.full(len(pixels), -1.0),
        ],
        axis=1,
    )
    world = local @ eye.axes
    return np.asarray(world / np.linalg.norm(world, axis=1, keepdims=True))


def first_hits(eye: Floats, ways: Floats, skin: Floats, triangles: Ints) -> tuple[Floats, Floats]:
    """Return where rays first meet the skin, (N, 3), NaN where they miss, and how frontally.

    Möller and Trumbore 1997.
    """
    a, b, c = (skin[triangles[:, k]] for k in range(3))
    u, v, s = b - a, c - a, eye - a
    normals = np.cross(u, v)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    q = np.cross(s, u)
    hits, cosines = np.full((len(ways), 3), np.nan), np.zeros(len(ways))
    for n, way in enumerate(ways):
        p = np.cross(way, v)
        det = (u * p).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            x, y, t = (s * p).sum(axis=1) / det, (q @ way) / det, (v * q).sum(axis=1) / det
        met = (x >= 0) & (y >= 0) & (x + y <= 1) & (t > 0)
        if met.any():
            first = int(np.where(met, t, np.inf).argmin())
            hits[n], cosines[n] = eye + t[first] * way, abs(float(normals[first] @ way))
    return hits, cosines


def mirrored(places: Floats) -> Ints:
    """Return for each landmark the one of the other side: the best one-to-one assignment."""
    apart = np.linalg.norm(places[:, None] * (-1.0, 1.0, 1.0) - places[None], axis=2)
    return np.asarray(linear_sum_assignment(apart**2)[1])


def on_skin(rig: Rig, triangles: Ints, places: Floats) -> tuple[Ints, Floats]:
    """Return vertices (N, 3) and weights (N, 3) of the places of the skin next to some."""
    skin = rig.skin(rig.pose(rig.coordinates.idle))
    found = nearest(skin, triangles, places)
    chosen = triangles[found.triangles]
    return chosen, np.clip(barycentric(skin[chosen], found.points), 0.0, 1.0)


def front_of_head(rig: Rig) -> Ints:
    """Return the triangles (F, 3) of the skin of the head that are not inside of the mouth."""
    triangles, skin = skin_triangles(rig), rig.skin(rig.pose(rig.coordinates.idle))
    normals = vertex_normals(skin, rig.mesh.triangles)
    return np.asarray(triangles[normals[triangles].mean(axis=1)[:, 2] > INSIDE])


def with_jaw(rig: Rig) -> NDArray[np.bool_]:
    """Return which vertices go with an opening jaw, (N,)."""
    rows, deltas = rig.mesh.unit(JAW)
    way = np.zeros(len(rig.mesh.vertices))
    way[rows] = np.linalg.norm(deltas, axis=1)
    head = skin_of_head(rig)
    return np.asarray(way > WITH_JAW * way[head].max())


def skin_triangles(rig: Rig) -> Ints:
    """Return the triangles (F, 3) of the skin of the head."""
    skin = rig.mesh.triangles[: rig.mesh.parts[0].stop]
    return np.asarray(skin[np.isin(skin, skin_of_head(rig)).all(axis=1)])


if __name__ == "__main__":
    main()
