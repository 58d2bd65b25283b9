"""Draws many postures of one mesh; everything that does not change is kept between pictures."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee.export.pictures.camera import Camera, projected
from azee.export.pictures.raster import coarsen, fill, shade
from azee_rig.mesh import BodyMesh, vertex_normals

Floats = NDArray[np.float64]
Pixels = NDArray[np.uint8]

SUN = np.array([0.28, 0.72, 0.95]) / np.linalg.norm([0.28, 0.72, 0.95])
LIGHTS = np.array(
    [
        [1.75, 1.68, 1.58],  # key
        [0.62, 0.66, 0.74],  # sky
        [0.30, 0.27, 0.25],  # ground
        [0.35, 0.38, 0.42],  # rim
    ]
)
BACKGROUND = (0.72, 0.76, 0.80), (0.90, 0.92, 0.94)
"""Colours at the top and at the bottom of a picture, sRGB."""
SAMPLES = 2
"""Samples per pixel, each way."""
SHADOW_SAMPLES = 1024
SHADOW_TILES = np.array([2, 4, 8, 16, 32])
"""Sides, in samples, of tiles in which depths of the shadow buffer are summed up."""
SHADOW_MARGIN_M = 0.25
"""How far outside of the picture something may be and still throw a shadow into it."""
_FAR = 1e30


class Canvas:
    """Buffers for pictures of one mesh in one size; a thread needs one of its own."""

    def __init__(self, mesh: BodyMesh, size: tuple[int, int], samples: int) -> None:
        width, height = size[0] * samples, size[1] * samples
        self.mesh, self.size, self.samples = mesh, size, samples
        self.triangles = np.array(mesh.triangles)
        self.colours = np.ones((len(mesh.vertices), 3))
        self.roughness = np.ones(len(mesh.triangles))
        for part in mesh.parts:
            run = slice(part.start, part.stop)
            self.roughness[run] = part.roughness
            used = mesh.triangles[run].ravel()
            self.colours[used] = mesh.colours[used] * part.colour[:3]
        self.depth = np.empty((height, width))
        self.seen = np.empty((height, width), dtype=np.int32)
        self.shadow = np.empty((SHADOW_SAMPLES, SHADOW_SAMPLES))
        counts = SHADOW_SAMPLES // SHADOW_TILES
        self.tile_rows = np.cumsum(counts) - counts
        self.tiles = np.empty((counts.sum(), counts[0], 4), dtype=np.float32)
        self.shadow_seen = np.empty(self.shadow.shape, dtype=np.int32)
        top, bottom = (np.array(c) ** 2.2 for c in BACKGROUND)
        self.background = top + np.linspace(0.0, 1.0, size[1])[:, None] * (bottom - top)
        steps = np.linspace(0.0, 1.0, 4097)
        self.curve = np.where(
            steps <= 0.0031308, 12.92 * steps, 1.055 * steps ** (1.0 / 2.4) - 0.055
        )
        """The encoding of sRGB (IEC 61966-2-1)."""

    def draw(self, vertices: Floats, camera: Camera, transparent: bool = False) -> Pixels:
        """Return a picture (H, W, 3), or (H, W, 4) with an empty background, of vertices (N, 3)."""
        width, height = self.seen.shape[::-1]
        places = np.array(vertices, dtype=np.float64)
        screen, inverse_w = projected(places, camera, width, height)
        self.depth.fill(_FAR)
        self.seen.fill(-1)
        fill(screen, self.triangles, self.depth, self.seen)

        half_height = float(np.tan(camera.height_rad / 2.0))
        reach_m = half_height * float(np.linalg.norm(camera.eye - camera.target)) + SHADOW_MARGIN_M
        shadow_from = _shadow_map(camera.target, reach_m)
        self.shadow.fill(_FAR)
        self.shadow_seen.fill(-1)
        lit = np.ascontiguousarray(places @ shadow_from[:3].T + shadow_from[3])
        fill(lit, self.triangles, self.shadow, self.shadow_seen)
        texel_m = 2.0 * reach_m / SHADOW_SAMPLES
        coarsen(self.shadow, self.tiles, self.tile_rows)

        out = np.empty((self.size[1], self.size[0], 4 if transparent else 3), dtype=np.uint8)
        shade(
            screen,
            inverse_w,
            self.triangles,
            places,
            np.ascontiguousarray(vertex_normals(places, self.mesh.triangles)),
            self.colours,
            self.roughness,
            self.depth,
            self.seen,
            np.array(camera.eye, dtype=np.float64),
            height / 2.0 / half_height,
            SUN,
            LIGHTS,
            shadow_from,
            self.tiles,
            self.tile_rows,
            texel_m,
            self.samples,
            self.background,
            self.curve,
            out,
        )
        return out


def _shadow_map(target: Floats, reach_m: float) -> Floats:
    """Return rows that map a place to samples x, y and depth in metres of the key light's view."""
    right = np.cross([0.0, 1.0, 0.0], SUN)
    right = right / np.linalg.norm(right)
    up = np.cross(SUN, right)
    per_metre = SHADOW_SAMPLES / 2.0 / reach_m
    rows = np.stack([right * per_metre, -up * per_metre, -SUN])
    constant = np.array([SHADOW_SAMPLES / 2.0, SHADOW_SAMPLES / 2.0, 0.0]) - rows @ target
    return np.ascontiguousarray(np.concatenate([rows, constant[None]]))
