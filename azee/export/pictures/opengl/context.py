"""A context of OpenGL without a window, and the thread that it lives in."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

VERSION = 330
"""OpenGL 3.3, core profile: the oldest that has all that the shaders need."""
SOFTWARE = ("llvmpipe", "softpipe", "swrast", "swiftshader", "software", "gdi generic")
"""What names of renderers contain that use no graphics processor."""
EGL = {"backend": "egl", "libegl": "libEGL.so.1", "libgl": "libGL.so.1"}
"""Where a context comes from on Linux: it needs no display there."""
INSTALL = "install it with: pip install 'azee[gl]'"
DRIVER = {
    "linux": "install libEGL and a driver; on Debian and Ubuntu: "
    "apt install libegl1 libgl1 libgl1-mesa-dri",
}
OTHER_DRIVER = "install a driver of the graphics processor, and work where it may be used"


class NoOpenGLError(Exception):
    """There is no OpenGL; `remedy` says what to install."""

    def __init__(self, message: str, remedy: str) -> None:
        super().__init__(message)
        self.remedy = remedy


class OpenGL:
    """A context and its thread. A context is bound to a thread: all that uses it goes by `run`.

    name: what the driver calls its renderer. by_software: it uses no graphics processor. most: the
    most texels of a texture, each way.
    """

    def __init__(self) -> None:
        """Make a context. Raises: NoOpenGLError."""
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="opengl")
        try:
            self.context = self.run(_context)
            told: Mapping[str, Any] = self.run(lambda: self.context.info)
        except BaseException:
            self._thread.shutdown()
            raise
        self.name, self.most = str(told["GL_RENDERER"]), int(told["GL_MAX_TEXTURE_SIZE"])
        self.by_software = any(word in self.name.lower() for word in SOFTWARE)

    def run(self, work: Callable[P, T], *given: P.args, **named: P.kwargs) -> T:
        """Return what a function returns that is called in the context's thread."""
        return self._thread.submit(work, *given, **named).result()

    def __enter__(self) -> OpenGL:
        return self

    def __exit__(self, *_: object) -> None:
        try:
            self.run(_release, self.context)
        finally:
            self._thread.shutdown()


def _context() -> Any:
    """Return a context that has no window. Raises: NoOpenGLError."""
    try:
        import moderngl
    except ImportError as error:
        raise NoOpenGLError(
            "pictures by OpenGL need moderngl, which is not installed", INSTALL
        ) from error
    where: dict[str, Any] = EGL if sys.platform.startswith("linux") else {}
    try:
        return moderngl.create_context(standalone=True, require=VERSION, **where)
    except Exception as error:  # moderngl and what it loads have no type of their own for this
        remedy = DRIVER.get(sys.platform, OTHER_DRIVER)
        raise NoOpenGLError(f"there is no OpenGL 3.3 here: {error}", remedy) from error


def _release(context: Any) -> None:
    """Destroy a context: a driver keeps it, with all it holds, as long as it is current."""
    with context:
        pass  # afterwards, none is
    context.release()
