"""The formats that a compilation can be saved in, by suffix; each writer is loaded when used."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.compilation import Compilation


@contextmanager
def writing(path: str | Path) -> Iterator[None]:
    """Turn what goes wrong while a file is written into a diagnostic.

    Raises: AZeeError: cannot-write.
    """
    try:
        yield
    except OSError as error:
        raise AZeeError(cannot_write(path, error)) from error


def cannot_write(path: str | Path, error: OSError) -> Diagnostic:
    """Tell in the user's words why a file cannot be written."""
    folder = Path(path).parent
    if isinstance(error, FileNotFoundError):
        return Diagnostic("cannot-write", f"there is no folder `{folder}` for `{path}`", None)
    if isinstance(error, IsADirectoryError):
        return Diagnostic("cannot-write", f"`{path}` is a directory", None)
    if isinstance(error, NotADirectoryError):
        return Diagnostic(
            "cannot-write", f"cannot write `{path}`: `{folder}` is not a directory", None
        )
    if isinstance(error, PermissionError):
        return Diagnostic("cannot-write", f"no permission to write `{path}`", None)
    reason = error.strerror or type(error).__name__
    return Diagnostic("cannot-write", f"cannot write `{path}`: {reason.lower()}", None)


def _glb(made: Compilation, path: Path) -> None:
    from azee.export.glb import write_glb

    write_glb(made.clip, made.rig, path)


def _bvh(made: Compilation, path: Path) -> None:
    from azee.export.bvh import write_bvh

    write_bvh(made.clip, made.rig, path)


def _json(made: Compilation, path: Path) -> None:
    from azee.export.clip_json import write_json

    write_json(made.clip, made.rig, path)


def _svg(made: Compilation, path: Path) -> None:
    from azee.export.score_svg import write_svg

    write_svg(made.score, path)


def _png(made: Compilation, path: Path) -> None:
    from azee.export.storyboard import write_png

    write_png(made.clip, made.rig, path, made.animation.key_times)


WRITERS: dict[str, Callable[[Compilation, Path], None]] = {
    ".glb": _glb,
    ".bvh": _bvh,
    ".json": _json,
    ".svg": _svg,
    ".png": _png,
}
SUFFIXES = tuple(WRITERS)
"""Suffixes of the formats that a compilation can be saved in."""
