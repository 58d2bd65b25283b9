"""The formats of clips, scores and animations, by suffix; writers are loaded when used.

These tables are the only lists of formats: help texts are made from them, and a test holds the
pages of the manual to them.
"""

from __future__ import annotations

import errno
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.animation import Animation
    from azee.clip.clip import Clip
    from azee.export.landmarks.view import View
    from azee.export.pictures.renderer import Renderer
    from azee.export.track_rows import Row
    from azee.motion.tasks.tracks import Track
    from azee.score.provenance import Provenance
    from azee.score.score import Score
    from azee_rig.rig import Rig


@dataclass(frozen=True, slots=True)
class ElanHeader:
    """What an ELAN file says of itself: the film beside it, and whose testimony its rules are."""

    media: Path | None = None
    provenance: Provenance | None = None


@dataclass(frozen=True, slots=True)
class Seen:
    """From where a clip is seen, how many frames a second, and who draws them."""

    camera: str
    fps: float
    renderer: Renderer = "software"


@contextmanager
def writing(path: str | Path) -> Iterator[None]:
    """Turn errors in writing a file into a diagnostic.

    Raises: AZeeError: cannot-write.
    """
    try:
        yield
    except OSError as error:
        raise AZeeError(cannot_write(path, error)) from error


def cannot_write(path: str | Path, error: OSError) -> Diagnostic:
    """Say in the user's words why a file cannot be written."""
    folder = Path(path).parent
    if isinstance(error, FileNotFoundError):
        return Diagnostic("cannot-write", f"there is no folder `{folder}` for `{path}`", None)
    if isinstance(error, IsADirectoryError):
        return Diagnostic("cannot-write", f"`{path}` is a directory", None)
    if error.errno == errno.ENAMETOOLONG:
        return Diagnostic("cannot-write", f"cannot write `{path}`: its name is too long", None)
    if isinstance(error, NotADirectoryError) and Path(path).is_file():
        return Diagnostic("cannot-write", f"`{path}` is a file, not a directory", None)
    if isinstance(error, NotADirectoryError):
        return Diagnostic(
            "cannot-write", f"cannot write `{path}`: `{folder}` is not a directory", None
        )
    if isinstance(error, PermissionError):
        return Diagnostic("cannot-write", f"no permission to write `{path}`", None)
    reason = error.strerror or type(error).__name__
    return Diagnostic("cannot-write", f"cannot write `{path}`: {reason.lower()}", None)


def _glb(clip: Clip, rig: Rig, path: Path) -> None:
    from azee.export.formats.glb import write_glb

    write_glb(clip, rig, path)


def _stamped_glb(score: Score, rig: Rig, animation: Animation, path: Path) -> None:
    from azee.export.formats.glb import write_glb

    write_glb(animation.clip, rig, path, animation.provenance)


def _bvh(clip: Clip, rig: Rig, path: Path) -> None:
    from azee.export.formats.bvh import write_bvh

    write_bvh(clip, rig, path)


def _json(clip: Clip, rig: Rig, path: Path) -> None:
    from azee.export.formats.clip_json import write_json

    write_json(clip, rig, path)


def _npz(clip: Clip, rig: Rig, path: Path) -> None:
    from azee.clip.archive import write_clip
    from azee.export.files import replace_file

    with replace_file(path) as file:
        write_clip(clip, rig, file)


def _pose(clip: Clip, rig: Rig, path: Path) -> None:
    from azee.export.landmarks.view import View

    _pose_seen(clip, rig, path, View())


def _pose_from(clip: Clip, rig: Rig, path: Path, seen: Seen) -> None:
    from azee.export.landmarks.view import View

    _pose_seen(clip, rig, path, View(seen.camera, fps=seen.fps))


def _pose_seen(clip: Clip, rig: Rig, path: Path, view: View) -> None:
    from azee.export.landmarks.files import write_pose
    from azee.export.landmarks.view import landmarks

    with frames_counted():
        write_pose(landmarks(clip, rig, view), path)


def _vrma(clip: Clip, rig: Rig, path: Path) -> None:
    from azee.export.formats.vrm.vrma import write_vrma

    write_vrma(clip, rig, path)


@contextmanager
def frames_counted() -> Iterator[None]:
    """Turn a clip that would have too many frames into a diagnostic.

    Raises: AZeeError: clip-times.
    """
    from azee.clip.resample import TooManyFramesError

    try:
        yield
    except TooManyFramesError as error:
        raise AZeeError(Diagnostic("clip-times", str(error), None)) from error


def _film(score: Score, rig: Rig, animation: Animation, path: Path) -> None:
    from azee.export.pictures.film import write_film

    with filming():
        write_film(animation.clip, rig, path, fps=animation.report.fps)


def _film_from(clip: Clip, rig: Rig, path: Path, seen: Seen) -> None:
    from azee.export.pictures.film import write_film
    from azee.export.pictures.scene import Look

    with filming():
        write_film(
            clip, rig, path, Look(shots=(seen.camera,), renderer=seen.renderer), fps=seen.fps
        )


@contextmanager
def filming() -> Iterator[None]:
    """Turn errors in filming into a diagnostic.

    Raises: AZeeError: not-installed, clip-times.
    """
    from azee.export.pictures.film import NoEncoderError

    try:
        with frames_counted(), drawing():
            yield
    except NoEncoderError as error:
        raise AZeeError(
            Diagnostic(
                "not-installed", str(error), None, help="install it with: pip install 'azee[film]'"
            )
        ) from error


@contextmanager
def drawing() -> Iterator[None]:
    """Turn a lack of OpenGL into a diagnostic. Raises: AZeeError: not-installed."""
    from azee.export.pictures.opengl.context import NoOpenGLError

    try:
        yield
    except NoOpenGLError as error:
        raise AZeeError(Diagnostic("not-installed", str(error), None, help=error.remedy)) from error


def films_drawn_by(suffixes: Iterable[str], renderer: str) -> Renderer | None:
    """Return who draws films on this machine, for one of `renderer.CHOICES`.

    None where no suffix is that of a film. Raises: AZeeError: not-installed.
    """
    if not set(FILM_SUFFIXES).intersection(suffixes):
        return None
    from azee.export.pictures.renderer import resolved

    with drawing():
        return resolved(renderer)[0]


def _score_svg(score: Score, rows: Sequence[Row], header: ElanHeader, path: Path) -> None:
    from azee.export.pictures.score_svg import write_svg

    write_svg(score, path, rows)


def _score_png(score: Score, rows: Sequence[Row], header: ElanHeader, path: Path) -> None:
    from azee.export.pictures.score_png import write_score_png

    write_score_png(score, path, rows)


def _score_eaf(score: Score, rows: Sequence[Row], header: ElanHeader, path: Path) -> None:
    from azee.export.formats.eaf import write_eaf

    write_eaf(score, path, rows, media=header.media, provenance=header.provenance)


def _svg(score: Score, rig: Rig, animation: Animation, path: Path) -> None:
    from azee.export.pictures.score_svg import write_svg
    from azee.export.track_rows import track_rows

    write_svg(score, path, track_rows(animation.tracks))


def _eaf(score: Score, rig: Rig, animation: Animation, path: Path) -> None:
    write_elan(score, animation, path)


def write_elan(score: Score, animation: Animation, path: Path, media: Path | None = None) -> None:
    """Write a score as an ELAN file, on the time line of its films; `media` may be one of them."""
    from azee.export.formats.eaf import write_eaf
    from azee.export.track_rows import track_rows

    rows = track_rows(animation.tracks)
    known = animation.provenance
    write_eaf(score, path, rows, lead_s=animation.lead_s, media=media, provenance=known)


def _png(score: Score, rig: Rig, animation: Animation, path: Path) -> None:
    from azee.export.pictures.storyboard import write_png

    write_png(animation.clip, rig, path, animation.key_times)


def _of_clip(write: ClipWriter) -> Writer:
    return lambda score, rig, animation, path: write(animation.clip, rig, path)


def save_score(
    score: Score,
    path: str | Path,
    tracks: Sequence[Track] = (),
    media: Path | None = None,
    provenance: Provenance | None = None,
) -> None:
    """Draw a score or write it for ELAN; the suffix names the format: one of `SCORE_WRITERS`.

    Args: tracks: which blocks key which part of the body, where it was solved. media: the film
        that an ELAN file shows beside the score. provenance: of the text, for an ELAN file.
    Raises: AZeeError: cannot-write. ValueError: no format has that suffix.
    """
    from azee.export.track_rows import track_rows

    write = SCORE_WRITERS.get(Path(path).suffix.lower())
    if write is None:
        raise ValueError(f"no format has the suffix of {path}; known are {' '.join(SCORE_WRITERS)}")
    with writing(path):
        write(score, track_rows(tracks), ElanHeader(media, provenance), Path(path))


ClipWriter: TypeAlias = "Callable[[Clip, Rig, Path], None]"
ScoreWriter: TypeAlias = "Callable[[Score, Sequence[Row], ElanHeader, Path], None]"
Writer: TypeAlias = "Callable[[Score, Rig, Animation, Path], None]"
CameraWriter: TypeAlias = "Callable[[Clip, Rig, Path, Seen], None]"

CLIP_WRITERS: dict[str, ClipWriter] = {
    ".glb": _glb,
    ".vrma": _vrma,
    ".bvh": _bvh,
    ".json": _json,
    ".npz": _npz,
    ".pose": _pose,
}
"""Formats of a clip alone."""
SCORE_WRITERS: dict[str, ScoreWriter] = {
    ".svg": _score_svg,
    ".png": _score_png,
    ".eaf": _score_eaf,
}
"""Formats of a score alone."""
WRITERS: dict[str, Writer] = {
    **{suffix: _of_clip(write) for suffix, write in CLIP_WRITERS.items()},
    ".glb": _stamped_glb,
    ".svg": _svg,
    ".png": _png,
    ".eaf": _eaf,
}
"""Formats of an animation of a score; films are added below."""
SUFFIXES = tuple(WRITERS)
"""Suffixes of the formats in which a compilation can be saved, without films."""
FILM_SUFFIXES = (".mp4", ".webm")
"""Suffixes of films, which take longer and need the extra `film`."""
RENDER_SUFFIXES = (".png", *FILM_SUFFIXES)
"""Suffixes of what shows the body: pictures and films."""
CHART_SUFFIXES = (".svg", ".png", ".pdf")
"""Suffixes of charts of a corpus, which need the extra `charts`."""
CORPUS_SUFFIXES = (".csv", ".json", *CHART_SUFFIXES)
"""Suffixes of what the counts of a corpus can be written as."""
LANDMARK_SUFFIXES = (".pose", ".csv", ".npz")
"""Suffixes of landmarks."""
WRITERS |= dict.fromkeys(FILM_SUFFIXES, _film)
CAMERA_WRITERS: dict[str, CameraWriter] = {
    **dict.fromkeys(FILM_SUFFIXES, _film_from),
    ".pose": _pose_from,
}
"""Formats of a clip that is seen from somewhere: of those in `WRITERS`, what `azee batch` writes
for each camera."""
