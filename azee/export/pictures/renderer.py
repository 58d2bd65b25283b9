"""Who draws pictures and films: our rasteriser, or OpenGL where a machine has it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Literal, Protocol, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from azee.export.pictures.camera import Camera
    from azee_rig.mesh import BodyMesh

Renderer: TypeAlias = Literal["software", "opengl"]
CHOICES = ("software", "opengl", "auto")
"""What may be asked for; `auto` is resolved by `resolved`."""


class Canvas(Protocol):
    """Draws postures of one mesh in one size."""

    def draw(
        self, vertices: NDArray[np.float64], camera: Camera, transparent: bool = False
    ) -> NDArray[np.uint8]:
        """Return a picture (H, W, 3), or (H, W, 4) with an empty background, of vertices (N, 3)."""


@contextmanager
def canvases(
    renderer: Renderer,
    mesh: BodyMesh,
    sizes: Sequence[tuple[int, int]],
    samples: int,
    threads: int = 1,
) -> Iterator[list[list[Canvas]]]:
    """Give canvases of some sizes, in pixels, to each of so many threads; release them at the end.

    Each thread has its own of our rasteriser. All share those of OpenGL, which draws one picture at
    a time, in a thread of its own.
    Raises: NoOpenGLError.
    """
    if renderer == "software":
        from azee.export.pictures.canvas import SoftwareCanvas

        yield [[SoftwareCanvas(mesh, size, samples) for size in sizes] for _ in range(threads)]
        return
    from azee.export.pictures.opengl.canvas import OpenGLCanvas
    from azee.export.pictures.opengl.context import OpenGL

    with OpenGL() as opengl, ExitStack() as held:
        shared: list[Canvas] = [
            held.enter_context(OpenGLCanvas(opengl, mesh, size, samples)) for size in sizes
        ]
        yield [shared] * threads


def resolved(choice: str) -> tuple[Renderer, str]:
    """Return who draws for one of CHOICES, and its name; `auto` is OpenGL on a graphics processor.

    OpenGL by software, such as Mesa's llvmpipe, draws more slowly than our rasteriser.
    Raises: NoOpenGLError: OpenGL is asked for and not there.
    """
    software: tuple[Renderer, str] = ("software", "our rasteriser")
    if choice == "software":
        return software
    from azee.export.pictures.opengl.context import NoOpenGLError, OpenGL

    try:
        with OpenGL() as opengl:
            if choice == "auto" and opengl.by_software:
                return software
            return "opengl", f"OpenGL: {opengl.name}"
    except NoOpenGLError:
        if choice == "auto":
            return software
        raise
