"""Draws many postures of one mesh by OpenGL, as our rasteriser does; resources stay between."""

from __future__ import annotations

from contextlib import ExitStack
from importlib.resources import files
from typing import Any

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
from azee.export.pictures.opengl.context import NoOpenGLError, OpenGL
from azee.export.pictures.posed import Posed, materials, posed
from azee.export.pictures.raster import DISC_TILES, LIGHT_RADIUS, SAME_M, STEEPEST, encoded
from azee_rig.mesh import BodyMesh

Floats = NDArray[np.float64]
Pixels = NDArray[np.uint8]

COLUMNS = 1024
"""Texels in a row of the textures of vertices and triangles."""
SHADERS = {
    "nearest": ("points.vert", "nearest.frag"),
    "tiles": ("screen.vert", "tiles.frag"),
    "around": ("screen.vert", "around.frag"),
    "shade": ("screen.vert", "shade.frag"),
}
_FAR = 1e30
"""The depth of what is not in front of the eye."""


class OpenGLCanvas:
    """Programs, buffers and textures for pictures of one mesh in one size; any thread may draw."""

    def __init__(self, opengl: OpenGL, mesh: BodyMesh, size: tuple[int, int], samples: int) -> None:
        """Make all of it. Raises: NoOpenGLError: the picture is too large for the driver."""
        if max(size) * samples > opengl.most:
            raise NoOpenGLError(
                f"{opengl.name} draws at most {opengl.most // samples} pixels each way",
                "make the picture smaller, or leave out --renderer",
            )
        self.opengl, self.mesh, self.size, self.samples = opengl, mesh, size, samples
        self.background, curve = background(size[1]), encoding()
        encoded_rows = [[encoded(x, curve) for x in row] for row in self.background]
        self.bare = (np.array(encoded_rows) * 255.0 + 0.5).astype(np.uint8)
        self._held = ExitStack()
        try:
            opengl.run(self._prepare)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> OpenGLCanvas:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Release all that it holds of the driver's."""
        self.opengl.run(self._held.close)

    def draw(self, vertices: Floats, camera: Camera, transparent: bool = False) -> Pixels:
        """Return a picture (H, W, 3), or (H, W, 4) with an empty background, of vertices (N, 3)."""
        width, height = self.size[0] * self.samples, self.size[1] * self.samples
        shown = posed(vertices, self.mesh, camera, width, height)
        return self.opengl.run(self._draw, shown, camera.axes[2], transparent)

    def _prepare(self) -> None:
        """Make everything that stays between pictures, in the context's thread."""
        width, height = self.size[0] * self.samples, self.size[1] * self.samples
        context = self.opengl.context
        self.programs = {name: self._program(name) for name in SHADERS}
        self.points, self.shadow_points = (
            self._keep(context.buffer(reserve=12 * len(self.mesh.vertices))) for _ in range(2)
        )
        triangles = np.array(self.mesh.triangles, dtype=np.int32)
        indices = self._keep(context.buffer(triangles.tobytes()))
        nearest = self.programs["nearest"]
        self.surface, self.shadow_surface = (
            self._keep(context.vertex_array(nearest, [(points, "3f", "point")], indices))
            for points in (self.points, self.shadow_points)
        )
        self.screens = {
            name: self._keep(context.vertex_array(self.programs[name], []))
            for name in ("tiles", "around", "shade")
        }
        self.seen, self.seen_buffer = self._target((width, height), 2, depth=True)
        self.shadow, self.shadow_buffer = self._target((SHADOW_SAMPLES,) * 2, 2, depth=True)
        counts = SHADOW_SAMPLES // SHADOW_TILES
        self.tiles = [self._target((int(counts[0]), int(counts.sum())), 4) for _ in range(2)]
        self.picture = self._keep(context.texture(self.size, 4))
        self.picture_buffer = self._keep(context.framebuffer([self.picture]))
        colours, roughness = materials(self.mesh)
        self.places, self.normals = (self._table(len(colours)) for _ in range(2))
        self.colours = self._table(len(colours))
        self._write(self.colours, colours.astype(np.float32))
        self.corners = self._table(len(roughness), "i4")
        bits = roughness.astype(np.float32).view(np.int32)
        self._write(self.corners, np.column_stack([triangles, bits]))

    def _keep(self, made: Any) -> Any:
        self._held.callback(made.release)
        return made

    def _program(self, name: str) -> Any:
        given: dict[str, float] = {
            "SAMPLES": self.samples,
            "COLUMNS": COLUMNS,
            "SHADOW": SHADOW_SAMPLES,
            "LEVELS": len(SHADOW_TILES),
            "LIGHT_RADIUS": LIGHT_RADIUS,
            "DISC_TILES": DISC_TILES,
            "STEEPEST": STEEPEST,
            "SAME_M": SAME_M,
        }
        head = "#version 330 core\n" + "".join(f"#define {k} {v}\n" for k, v in given.items())
        vertex, fragment = (
            head + files("azee.export.pictures.opengl").joinpath(file).read_text(encoding="utf-8")
            for file in SHADERS[name]
        )
        program = self.opengl.context.program(vertex_shader=vertex, fragment_shader=fragment)
        return self._keep(program)

    def _target(self, size: tuple[int, int], components: int, *, depth: bool = False) -> Any:
        """Return a texture of floats and the framebuffer that draws into it."""
        context = self.opengl.context
        texture = self._keep(context.texture(size, components, dtype="f4"))
        nearest = self._keep(context.depth_renderbuffer(size)) if depth else None
        return texture, self._keep(context.framebuffer([texture], nearest))

    def _table(self, count: int, dtype: str = "f4") -> Any:
        """Return a texture with four numbers for each of so many rows."""
        rows = -(-count // COLUMNS)
        return self._keep(self.opengl.context.texture((COLUMNS, rows), 4, dtype=dtype))

    def _write(self, table: Any, rows: NDArray[Any]) -> None:
        filled = np.zeros((table.width * table.height, 4), rows.dtype)
        filled[: len(rows), : rows.shape[1]] = rows
        table.write(filled.tobytes())

    def _draw(self, shown: Posed, back: Floats, transparent: bool) -> Pixels:
        """Draw in the context's thread; `back` is the direction of the view, towards the eye."""
        self._find(self.surface, self.points, shown.screen, self.seen_buffer)
        self._find(self.shadow_surface, self.shadow_points, shown.shadow, self.shadow_buffer)
        self._sum_up(float(shown.shadow[:, 2].max()) + 1.0)
        for table, rows, k in ((self.places, shown.places, 0), (self.normals, shown.normals, 1)):
            self._write(table, np.column_stack([rows, shown.screen[:, k]]).astype(np.float32))
        count = 4 if transparent else 3
        out = np.zeros((self.size[1], self.size[0], count), dtype=np.uint8)
        if not transparent:
            out[:] = self.bare[:, None]
        x0, y0, x1, y1 = self._box(shown.screen)
        if x0 < x1 and y0 < y1:
            box = x0, y0, x1 - x0, y1 - y0
            self._shade(shown, back, transparent, box)
            data = self.picture_buffer.read(viewport=box, components=4, alignment=1)
            pixels = np.frombuffer(data, np.uint8).reshape(y1 - y0, x1 - x0, 4)
            out[y0:y1, x0:x1] = pixels[..., :count]
        return out

    def _box(self, screen: Floats) -> tuple[int, int, int, int]:
        """Return the pixels x0, y0, x1, y1 that hold all points: nothing is drawn elsewhere."""
        at = screen[screen[:, 2] < _FAR, :2] / self.samples
        if not len(at):
            return 0, 0, 0, 0
        low = np.clip(at.min(axis=0), 0, self.size).astype(int)
        high = np.clip(np.ceil(at.max(axis=0)), 0, self.size).astype(int)
        return int(low[0]), int(low[1]), int(high[0]), int(high[1])

    def _find(self, surface: Any, buffer: Any, points: Floats, into: Any) -> None:
        """Find the nearest triangle of every sample: points (N, 3) in samples, with a depth."""
        context, program = self.opengl.context, self.programs["nearest"]
        buffer.write(points.astype(np.float32).tobytes())
        depths = points[points[:, 2] < _FAR, 2]
        program["size"].value = into.size
        program["depths"].value = (
            (float(depths.min()), float(depths.max()) + 1e-6) if len(depths) else (0.0, 1.0)
        )
        into.use()
        into.clear()
        context.enable_only(context.DEPTH_TEST)
        surface.render()

    def _sum_up(self, empty: float) -> None:
        """Sum the depths of the key light's view up in tiles of all sizes."""
        context, program = self.opengl.context, self.programs["tiles"]
        around = self.programs["around"]
        context.enable_only(context.NOTHING)
        program["empty"].value = empty
        below, row_below, row = self.shadow, 0, 0
        for level, count in enumerate(SHADOW_SAMPLES // SHADOW_TILES):
            texture, buffer = self.tiles[level % 2]
            program["is_first"].value = level == 0
            program["row"].value, program["row_below"].value = row, row_below
            buffer.use()
            context.viewport = 0, row, int(count), int(count)
            below.use(0)
            program["below"].value = 0
            self.screens["tiles"].render(context.TRIANGLES, vertices=3)
            if level > 0:
                around["row"].value, around["count"].value = row, int(count)
                around["tiles"].value = 0
                texture.use(0)
                self.tiles[(level + 1) % 2][1].use()
                context.viewport = 0, row, int(count), int(count)
                self.screens["around"].render(context.TRIANGLES, vertices=3)
            below, row_below, row = texture, row, row + int(count)

    def _shade(
        self, shown: Posed, back: Floats, transparent: bool, box: tuple[int, int, int, int]
    ) -> None:
        context, program = self.opengl.context, self.programs["shade"]
        textures = {
            "seen": self.seen,
            "triangles": self.corners,
            "places": self.places,
            "normals": self.normals,
            "colours": self.colours,
            "even_tiles": self.tiles[0][0],
            "odd_tiles": self.tiles[1][0],
        }
        for unit, (name, texture) in enumerate(textures.items()):
            texture.use(unit)
            program[name].value = unit
        vectors = {
            "eye": shown.eye,
            "back": back,
            "sun": SUN,
            **dict(zip(("key", "sky", "ground", "rim"), LIGHTS, strict=True)),
            **dict(zip(("shadow_x", "shadow_y", "shadow_depth"), shown.shadow_from, strict=False)),
            "shadow_constant": shown.shadow_from[3],
            "top": self.background[0],
            "bottom": self.background[-1],
        }
        for name, vector in vectors.items():
            program[name].value = tuple(float(x) for x in vector)
        program["reach"].value, program["texel_m"].value = shown.reach, shown.texel_m
        program["rows"].value, program["transparent"].value = self.size[1], transparent
        self.picture_buffer.use()
        context.scissor = box
        self.screens["shade"].render(context.TRIANGLES, vertices=3)
        context.scissor = None
