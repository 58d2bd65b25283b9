"""What every renderer draws: a posed mesh as a camera and the key light see it, and its materials.

All of it is computed here, in double precision: renderers differ in nothing but the drawing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.export.pictures.camera import Camera, projected
from azee.export.pictures.light import SHADOW_MARGIN_M, SHADOW_SAMPLES, shadow_map
from azee_rig.mesh import BodyMesh, vertex_normals

Floats = NDArray[np.float64]

SAMPLES = 2
"""Samples per pixel, each way."""


@dataclass(frozen=True, eq=False, slots=True)
class Posed:
    """A posture of a mesh with N vertices, ready to be drawn.

    places, normals: (N, 3) in the world. screen: (N, 3) x and y in samples from the upper left, and
    a depth −1 / distance; 1e30 where a vertex is not in front of the eye. inverse_w: (N, 1)
    reciprocal distance along the view. eye: (3,) in the world. reach: samples a metre at distance
    1. shadow_from: (4, 3) as of `shadow_map`. shadow: (N, 3) x, y in samples and depth in metres,
    as the key light sees them. texel_m: metres between samples of that view.
    """

    places: Floats
    normals: Floats
    screen: Floats
    inverse_w: Floats
    eye: Floats
    reach: float
    shadow_from: Floats
    shadow: Floats
    texel_m: float


def posed(vertices: Floats, mesh: BodyMesh, camera: Camera, width: int, height: int) -> Posed:
    """Return a posture as a camera sees it: vertices (N, 3), the picture's size in samples."""
    places = np.array(vertices, dtype=np.float64)
    screen, inverse_w = projected(places, camera, width, height)
    half_height = float(np.tan(camera.height_rad / 2.0))
    reach_m = half_height * float(np.linalg.norm(camera.eye - camera.target)) + SHADOW_MARGIN_M
    shadow_from = shadow_map(camera.target, reach_m)
    return Posed(
        places,
        np.ascontiguousarray(vertex_normals(places, mesh.triangles)),
        screen,
        inverse_w,
        np.array(camera.eye, dtype=np.float64),
        height / 2.0 / half_height,
        shadow_from,
        np.ascontiguousarray(places @ shadow_from[:3].T + shadow_from[3]),
        2.0 * reach_m / SHADOW_SAMPLES,
    )


def materials(mesh: BodyMesh) -> tuple[Floats, Floats]:
    """Return the linear colours of vertices, (N, 3), and the roughness of triangles, (F,)."""
    colours = np.ones((len(mesh.vertices), 3))
    roughness = np.ones(len(mesh.triangles))
    for part in mesh.parts:
        run = slice(part.start, part.stop)
        roughness[run] = part.roughness
        used = mesh.triangles[run].ravel()
        colours[used] = mesh.colours[used] * part.colour[:3]
    return colours, roughness
