"""Hair of the face moves with the skin it grows on; clothes have no open ends."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from azee_rig.load import load_rig
from azee_rig.mesh import BodyMesh, vertex_normals
from azee_rig.nearest import barycentric, nearest
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
BODIES = "signer", "child", "heavy", "game"
FACES = {
    "still": {},
    "blink": {"AU43": 1.0},
    "half a blink": {"AU43": 0.5},
    "brows up": {"AU1": 1.0, "AU2": 1.0},
    "brows down": {"AU4": 1.0},
    "eyes wide": {"AU5": 1.0},
}


def triangles(mesh: BodyMesh, *names: str) -> Ints:
    """Triangles of some parts, (f, 3)."""
    assert set(names) <= {part.name for part in mesh.parts}
    runs = [mesh.triangles[p.start : p.stop] for p in mesh.parts if p.name in names]
    return np.concatenate(runs)


def heights(vertices: Floats, surface: Ints, points: Floats) -> Floats:
    """How far points (n, 3) are outside of a surface, negative inside, metres: within 5 cm."""
    low, high = points.min(axis=0) - 0.05, points.max(axis=0) + 0.05
    inside = ((vertices > low) & (vertices < high)).all(axis=1)
    surface = surface[inside[surface].any(axis=1)]
    found = nearest(vertices, surface, points)
    corners = surface[found.triangles]
    shares = barycentric(vertices[corners], found.points)
    normals = np.einsum("nk,nkc->nc", shares, vertex_normals(vertices, surface)[corners])
    outside = np.einsum("nc,nc->n", points - found.points, normals) > 0.0
    return np.where(outside, found.distances, -found.distances)


def face(rig: Rig, name: str) -> Floats:
    """Vertices of a body at idle with a face."""
    units: dict[str, float] = {}
    for morph, weight in FACES[name].items():
        for unit, share in rig.face_morphs[morph].items():
            units[unit] = units.get(unit, 0.0) + weight * share
    return rig.skin(rig.pose(rig.coordinates.idle), units)


@pytest.mark.slow
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("name", FACES)
def test_brows_and_lashes_stay_on_the_skin(body: str, name: str) -> None:
    rig = load_rig(body)
    vertices, skin = face(rig, name), triangles(rig.mesh, "skin")
    for part, least, most in (
        ("brows", 0.0, 0.0016),
        ("brow_hairs", 0.0, 0.0025),
        ("lashes", -0.004, 0.008),
    ):
        hair = vertices[np.unique(triangles(rig.mesh, part))]
        off = heights(vertices, skin, hair)
        assert off.min() > least, part
        assert off.max() < most, part


@pytest.mark.parametrize("body", BODIES)
def test_lashes_turn_with_the_lids(body: str) -> None:
    rig = load_rig(body)
    hairs = triangles(rig.mesh, "lashes")
    frames = rig.chain.frames(rig.coordinates.idle)
    eyes = np.array([frames.positions[rig.bones[f"eye_{side}"].node] for side in "LR"])
    still, closed = (face(rig, name)[hairs] for name in ("still", "blink"))
    reach = np.linalg.norm(still[:, :, None] - eyes, axis=3).min(axis=2)
    upper = still[:, :, 1].mean(axis=1) > eyes[:, 1].mean() + 0.001
    rows = np.flatnonzero(upper & (np.ptp(reach, axis=1) > 0.0015))
    root, tip = reach[rows].argmin(axis=1), reach[rows].argmax(axis=1)
    assert len(rows) > 60, "two triangles a hair"

    def rise(corners: Floats) -> Floats:
        return np.asarray(corners[rows, tip, 1] - corners[rows, root, 1])

    assert np.median(rise(still)) > 0.0004, "they point up"
    assert np.median(rise(closed)) < -0.0004, "and down when the eyes are closed"


@pytest.mark.slow
@pytest.mark.parametrize("body", BODIES)
def test_no_sleeve_collar_or_hem_is_open(body: str) -> None:
    """Borders of the top end below skin or trousers; when bent far, 4 mm above at most."""
    rig = load_rig(body)
    c = rig.coordinates
    top = triangles(rig.mesh, "top", "bands")
    # Vertices at the same place are one, so that the seam between top and bands is no border.
    _, same = np.unique(np.round(rig.mesh.vertices, 6), axis=0, return_inverse=True)
    edges = np.concatenate([top[:, [i, (i + 1) % 3]] for i in range(3)])
    _, which, times = np.unique(
        np.sort(same.ravel()[edges], axis=1), axis=0, return_inverse=True, return_counts=True
    )
    border = np.unique(edges[times[which.ravel()] == 1])
    assert len(border) > 100
    below = triangles(rig.mesh, "skin", "trousers")
    anywhere = np.random.default_rng(7).uniform(c.lower, c.upper, (3, len(c.names)))
    bent = c.idle + 0.7 * (anywhere - c.idle)
    for q, most in [(c.idle, 0.0), (c.bind, 0.0), *((q, 0.004) for q in bent)]:
        vertices = rig.skin(rig.pose(q))
        assert heights(vertices, below, vertices[border]).max() < most
