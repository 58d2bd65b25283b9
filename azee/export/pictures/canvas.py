"""The software renderer draws many postures of one mesh; what does not change is kept between."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee.export.pictures.camera import Camera
from azee.export.pictures.light import (
    LIGHTS,
    SHADOW_SAMPLES,
    SHADOW_TILES,
    SUN,
    background,
    encoding,
)
from azee.export.pictures.posed import materials, posed
from azee.export.pictures.raster import coarsen, fill, shade
from azee_rig.mesh import BodyMesh

Floats = NDArray[np.float64]
Pixels = NDArray[np.uint8]

_FAR = 1e30


class SoftwareCanvas:
    """Buffers for pictures of one mesh in one size; a thread needs one of its own."""

    def __init__(self, mesh: BodyMesh, size: tuple[int, int], samples: int) -> None:
        width, height = size[0] * samples, size[1] * samples
        self.mesh, self.size, self.samples = mesh, size, samples
        self.triangles = np.array(mesh.triangles)
        self.colours, self.roughness = materials(mesh)
        self.depth = np.empty((height, width))
        self.seen = np.empty((height, width), dtype=np.int32)
        self.shadow = np.empty((SHADOW_SAMPLES, SHADOW_SAMPLES))
        counts = SHADOW_SAMPLES // SHADOW_TILES
        self.tile_rows = np.cumsum(counts) - counts
        self.tiles = np.empty((counts.sum(), counts[0], 4), dtype=np.float32)
        self.shadow_seen = np.empty(self.shadow.shape, dtype=np.int32)
        self.background = background(size[1])
        self.curve = encoding()

    def draw(self, vertices: Floats, camera: Camera, transparent: bool = False) -> Pixels:
        """Return a picture (H, W, 3), or (H, W, 4) with an empty background, of vertices (N, 3)."""
        height, width = self.seen.shape
        shown = posed(vertices, self.mesh, camera, width, height)
        self.depth.fill(_FAR)
        self.seen.fill(-1)
        fill(shown.screen, self.triangles, self.depth, self.seen)
        self.shadow.fill(_FAR)
        self.shadow_seen.fill(-1)
        fill(shown.shadow, self.triangles, self.shadow, self.shadow_seen)
        coarsen(self.shadow, self.tiles, self.tile_rows)
        out = np.empty((self.size[1], self.size[0], 4 if transparent else 3), dtype=np.uint8)
        shade(
            shown.screen,
            shown.inverse_w,
            self.triangles,
            shown.places,
            shown.normals,
            self.colours,
            self.roughness,
            self.depth,
            self.seen,
            shown.eye,
            shown.reach,
            SUN,
            LIGHTS,
            shown.shadow_from,
            self.tiles,
            self.tile_rows,
            shown.texel_m,
            self.samples,
            self.background,
            self.curve,
            out,
        )
        return out
