"""Opens clips in files of any format for a body, and writes them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from azee.formats import CLIP_WRITERS, writing
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.clip.clip import Clip
    from azee.clip.recording import Recording
    from azee.clip.retarget import Retargeted
    from azee_rig.rig import Rig

CLIP_SUFFIXES = (".npz", ".bvh", ".glb", ".gltf", ".vrm", ".vrma")
"""Formats from which clips are read."""
SHIPPED = "signer"
OUR_UNIT = "cm"
"""Unit of length of the BVH files that azee writes."""


@dataclass(frozen=True, eq=False)
class OpenClip:
    """A clip, its body, and notes for the user on how it was read."""

    clip: Clip
    rig: Rig
    notes: tuple[str, ...] = ()


def open_clip(path: str | Path, rig: Rig | None = None) -> OpenClip:
    """Read a clip that `azee` stored (.npz), a BVH file or the animation of a glTF file.

    Args: rig: the body; by default the one that a stored clip names, else the signer.
    Raises: AZeeError: cannot-read, not-a-clip. RigError: the body cannot be read.
    """
    path = Path(path)
    with reading(path):
        if _kind(path) == "clip":
            return _stored(path, rig)
        return _recorded(path, rig)


def open_recording(path: str | Path, unit: str | None = None) -> Recording | None:
    """Read a BVH or glTF file as it was recorded; None where it is a clip that `azee` stored.

    Args: unit: of a BVH's lengths; by default it is guessed.
    Raises: AZeeError: cannot-read, not-a-clip.
    """
    from azee.clip.bvh import read_bvh
    from azee.clip.bvh_hierarchy import BvhError
    from azee.clip.gltf_motion import GltfMotionError, read_gltf_motion

    path = Path(path)
    with reading(path):
        kind = _kind(path)
        if kind == "clip":
            return None
        try:
            return read_gltf_motion(path) if kind == "gltf" else read_bvh(path, unit)
        except (BvhError, GltfMotionError) as error:
            raise AZeeError(_no_clip(f"`{path}`: {error}")) from error


def _kind(path: Path) -> str:
    """Return "bvh", "gltf" or "clip". Raises: OSError. AZeeError: it is none of these."""
    from azee.clip.file_kind import motion_kind

    kind = motion_kind(path)
    if kind in ("bvh", "clip", "gltf"):
        return kind
    if not kind:
        return "clip"
    raise AZeeError(
        _no_clip(
            f"`{path}` is {kind}; motion is read from BVH and glTF of any skeleton and from clips "
            "(.npz)",
            "export it as BVH: Blender does, with File > Export > Motion Capture",
        )
    )


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Turn what goes wrong while a file is read into a diagnostic.

    Raises: AZeeError: cannot-read.
    """
    try:
        yield
    except OSError as error:
        raise AZeeError(_unreadable(path, error)) from error


def save_clip(clip: Clip, rig: Rig, path: str | Path) -> None:
    """Write a clip; the suffix names the format: one of `CLIP_WRITERS`.

    Raises: AZeeError: cannot-write. ValueError: no format has that suffix.
    """
    write = CLIP_WRITERS.get(Path(path).suffix.lower())
    if write is None:
        raise ValueError(f"no format has the suffix of {path}; known are {' '.join(CLIP_WRITERS)}")
    with writing(path):
        write(clip, rig, Path(path))


def _stored(path: Path, rig: Rig | None) -> OpenClip:
    from azee.clip.archive import ClipFileError, OtherBodyError, read_clip, rig_of
    from azee_rig.load import load_rig

    try:
        body = rig or load_rig(_shipped(path, rig_of(path) or SHIPPED))
        return OpenClip(read_clip(path, body), body)
    except ClipFileError as error:
        other = isinstance(error, OtherBodyError)
        remedy = "`azee retarget` carries motion over to another body" if other else None
        raise AZeeError(_no_clip(str(error), remedy)) from error


def _shipped(path: Path, name: str) -> str:
    """Return the name of a body if it ships: folders that a clip names are not opened.

    Raises: AZeeError: not-a-clip.
    """
    from azee_rig.load import shipped_rigs

    if name in shipped_rigs():
        return name
    message = f"`{path}` moves the body `{name}`, which does not ship"
    raise AZeeError(_no_clip(message, "name the body's folder with --rig"))


def _recorded(path: Path, rig: Rig | None) -> OpenClip:
    from azee_rig.load import load_rig

    body = rig or load_rig(SHIPPED)
    recording = open_recording(path, OUR_UNIT)
    assert recording is not None
    if own := _own(recording, body):
        return replace(own, notes=(*recording.notes, *own.notes))
    made, notes = carry_over(path, body)
    note = f"another skeleton's motion, carried over to `{body.name}`: {made.kept(body)}"
    return OpenClip(made.clip, body, (*notes, note))


def carry_over(
    path: str | Path, body: Rig, unit: str | None = None
) -> tuple[Retargeted, list[str]]:
    """Play the motion of a BVH of any skeleton, or of any clip, on a body.

    Returns: the motion, and what its user should know about how it was read.
    Raises: AZeeError: cannot-read, not-a-clip.
    """
    from azee.clip.retarget import as_it_was, retarget
    from azee.clip.retarget_source import RetargetError, measure_clip, measure_recording

    recording = open_recording(path, unit)
    opened = open_clip(path) if recording is None else _of_any_body(recording, body)
    if opened is None:
        assert recording is not None
        try:
            source = measure_recording(recording)
        except RetargetError as error:
            raise AZeeError(_no_clip(f"`{path}`: {error}")) from error
        return retarget(source, body), [*source.notes]
    notes = [*opened.notes]
    if recording is not None:
        named = open_recording(path, OUR_UNIT)  # of its own skeleton the unit needs no guess
        notes = [*(named.notes if named else ()), *notes]
        if opened.rig is body:
            notes.append("it is the body's own skeleton: all joints are as they were")
            return as_it_was(opened.clip), notes
    return retarget(measure_clip(opened.clip, opened.rig), body), notes


def _of_any_body(recording: Recording, body: Rig) -> OpenClip | None:
    """Return a recording of the skeleton of a body, or of one that ships, as a clip of it."""
    from azee_rig.load import load_rig, shipped_rigs

    if own := _own(recording, body):
        return own
    others = (load_rig(name) for name in shipped_rigs() if name != body.name)
    return next((own for rig in others if (own := _own(recording, rig))), None)


def _own(recording: Recording, body: Rig) -> OpenClip | None:
    """Return a recording of a body's own skeleton as a clip; None if it is one of another."""
    from azee.clip.own_bvh import LOST_RAD, is_own, own_clip

    if not is_own(recording, body):
        return None
    clip, lost_rad = own_clip(recording, body)
    notes = []
    if lost_rad > LOST_RAD:
        notes.append(
            f"the body cannot do all of it: joints are up to {math.degrees(lost_rad):.1f}° off"
        )
    return OpenClip(clip, body, tuple(notes))


def _no_clip(message: str, remedy: str | None = None) -> Diagnostic:
    return Diagnostic("not-a-clip", message, None, help=remedy)


def _unreadable(path: Path, error: OSError) -> Diagnostic:
    if isinstance(error, FileNotFoundError):
        return Diagnostic("cannot-read", f"there is no file `{path}`", None)
    if isinstance(error, IsADirectoryError):
        return Diagnostic("cannot-read", f"`{path}` is a directory", None)
    reason = error.strerror or type(error).__name__
    return Diagnostic("cannot-read", f"cannot read `{path}`: {reason.lower()}", None)
