"""Opens clips in files of any format for a body, and writes them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from azee.formats import CLIP_WRITERS, writing
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.clip.clip import Clip
    from azee.clip.recording import Recording
    from azee_rig.rig import Rig

CLIP_SUFFIXES = (".npz", ".bvh")
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
    """Read a clip that `azee` stored (.npz) or a BVH file.

    Args: rig: the body; by default the one that a stored clip names, else the signer.
    Raises: AZeeError: cannot-read, not-a-clip. RigError: the body cannot be read.
    """
    path = Path(path)
    try:
        if path.suffix.lower() == ".bvh":
            return _recorded(path, rig)
        return _stored(path, rig)
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
    from azee.clip.bvh import read_bvh
    from azee.clip.bvh_hierarchy import BvhError
    from azee.clip.own_bvh import LOST_RAD, is_own, own_clip
    from azee_rig.load import load_rig

    try:
        recording = read_bvh(path, OUR_UNIT)
        body = rig or load_rig(SHIPPED)
        if not is_own(recording, body):
            recording = read_bvh(path)  # somebody scaled it, and then it says so
    except BvhError as error:
        raise AZeeError(_no_clip(f"`{path}`: {error}")) from error
    if not is_own(recording, body):
        return _carried_over(path, recording, body)
    clip, lost_rad = own_clip(recording, body)
    notes = list(recording.notes)
    if lost_rad > LOST_RAD:
        notes.append(
            f"the body cannot do all of it: joints are up to {math.degrees(lost_rad):.1f}° off"
        )
    return OpenClip(clip, body, tuple(notes))


def _carried_over(path: Path, recording: Recording, body: Rig) -> OpenClip:
    """Play the motion of another skeleton on a body. Raises: AZeeError: not-a-clip."""
    from azee.clip.retarget import retarget
    from azee.clip.retarget_source import RetargetError, measure_recording

    try:
        source = measure_recording(recording)
    except RetargetError as error:
        raise AZeeError(_no_clip(f"`{path}`: {error}")) from error
    made = retarget(source, body)
    note = f"another skeleton's motion, carried over to `{body.name}`: {made.kept(body)}"
    return OpenClip(made.clip, body, (*source.notes, note))


def _no_clip(message: str, remedy: str | None = None) -> Diagnostic:
    return Diagnostic("not-a-clip", message, None, help=remedy)


def _unreadable(path: Path, error: OSError) -> Diagnostic:
    if isinstance(error, FileNotFoundError):
        return Diagnostic("cannot-read", f"there is no file `{path}`", None)
    if isinstance(error, IsADirectoryError):
        return Diagnostic("cannot-read", f"`{path}` is a directory", None)
    reason = error.strerror or type(error).__name__
    return Diagnostic("cannot-read", f"cannot read `{path}`: {reason.lower()}", None)
