"""`azee export`: a clip for tools that need more than a suffix, and bodies as avatars."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, news
from azee.cli.number import Number
from azee.cli.outputs import check_outputs, picture_size, size_of, with_suffix
from azee.clips import OpenClip, open_clip
from azee.export.pictures.shots import SHOTS
from azee.formats import LANDMARK_SUFFIXES, frames_counted, writing
from azee_grammar.diagnostic import AZeeError, Diagnostic

Command = TypeVar("Command", bound=Callable[..., Any])


@click.group("export", short_help="Landmarks, and movements on skeletons of others.")
def export() -> None:
    """Write clips for tools that need more than a suffix, and bodies as avatars."""


_file = click.argument("file", metavar="FILE", type=click.Path(path_type=Path))
_rig = click.option("--rig", metavar="R", help="A body by name, or its folder.")
_quiet = click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")


def _output(*suffixes: str) -> Callable[[Command], Command]:
    return click.option(
        "-o", "output", metavar="OUT", required=True, type=click.Path(path_type=Path),
        callback=with_suffix(*suffixes), help=f"The file to write: {' '.join(suffixes)}.",
    )  # fmt: skip


@export.command(short_help="What MediaPipe would find in a film.")
@_file
@click.option(
    "-o", "outputs", metavar="OUT", multiple=True, required=True,
    type=click.Path(path_type=Path), callback=with_suffix(*LANDMARK_SUFFIXES),
    help=f"A file to write: {' '.join(LANDMARK_SUFFIXES)}. Repeatable.",
)  # fmt: skip
@click.option(
    "--camera", "shot", default="front", show_default=True, type=click.Choice(SHOTS),
    help="From where.",
)  # fmt: skip
@click.option(
    "--size", default="720x720", show_default=True, callback=picture_size,
    help="Pixels, WIDTHxHEIGHT.",
)  # fmt: skip
@click.option("--fps", type=Number(1, 1000), default=25, show_default=True, help="Frames a second.")
@click.option(
    "--noise", type=Number(0, 1000), default=0, help="Standard deviation of points, in pixels."
)
@click.option(
    "--dropout", type=Number(0, 1), default=0,
    help="Share of hands, faces and points of the body that are lost.",
)  # fmt: skip
@click.option("--seed", type=click.IntRange(min=0), default=0, help="Of noise and losses.")
@_rig
@_quiet
def landmarks(
    file: Path,
    outputs: Sequence[Path],
    shot: str,
    size: tuple[int, int],
    fps: float,
    noise: float,
    dropout: float,
    seed: int,
    rig: str | None,
    quiet: bool,
) -> int:
    """Write the landmarks of MediaPipe Holistic that a film of FILE, a clip, shows.

    All numbers are exact: joints and skin of the body before the camera. Body 33, hands 21 each,
    face 468, and the body in metres. What hides behind the body is there.
    """
    from azee.export.landmarks.files import LANDMARK_WRITERS
    from azee.export.landmarks.view import View
    from azee.export.landmarks.view import landmarks as seen

    check_outputs(outputs)
    found = _open(file, rig, quiet)
    with frames_counted():
        marks = seen(found.clip, found.rig, View(shot, size, fps, noise, dropout, seed))
    for path in outputs:
        with writing(path):
            LANDMARK_WRITERS[path.suffix.lower()](marks, path)
        _wrote(path, quiet)
    return DONE


@export.command(short_help="A body that ships as a VRM avatar.")
@_output(".vrm")
@click.option(
    "--rig", metavar="R", default="signer", show_default=True, help="A body that ships, by name."
)
@_quiet
def avatar(output: Path, rig: str, quiet: bool) -> int:
    """Write a body that ships as a VRM 1.0 avatar, in the T-pose, with its expressions."""
    from azee.export.formats.vrm.avatar import NoAvatarError, write_vrm

    check_outputs([output])
    try:
        with writing(output):
            write_vrm(load_body(rig), output)
    except NoAvatarError as error:
        raise click.BadParameter(str(error), param_hint="'--rig'") from error
    _wrote(output, quiet)
    return DONE


@export.command(short_help="Joint angles of SMPL-X.")
@_file
@_output(".npz")
@_rig
@_quiet
def smplx(file: Path, output: Path, rig: str | None, quiet: bool) -> int:
    """Write FILE, a clip, as pose parameters of SMPL-X. The model itself is no part of azee."""
    from azee.export.formats.smplx import write_smplx

    check_outputs([output])
    found = _open(file, rig, quiet)
    with writing(output):
        write_smplx(found.clip, found.rig, output)
    _wrote(output, quiet)
    return DONE


@export.command(short_help="A movement for a body's own file.")
@_file
@click.option(
    "--onto", metavar="BODY.glb", required=True, type=click.Path(path_type=Path),
    help="The file that `azee rig import` took the body from.",
)  # fmt: skip
@_output(".glb")
@click.option(
    "--rig", metavar="DIR", required=True, help="The body's folder, as `azee rig import` wrote it."
)
@_quiet
def animation(file: Path, onto: Path, output: Path, rig: str, quiet: bool) -> int:
    """Write FILE, a clip, as an animation of the joints and morphs of BODY.glb itself.

    Mesh, textures and hair stay in BODY.glb. What its file calls its joints, the animation does.
    """
    from azee.export.formats.own_joints import write_own_animation

    check_outputs([output])
    found = _open(file, rig, quiet)
    with _of_its_body(onto), writing(output):
        notes = write_own_animation(found.clip, found.rig, onto, output)
    for note in notes:
        news(note, quiet=quiet)
    _wrote(output, quiet)
    return DONE


@contextmanager
def _of_its_body(onto: Path) -> Iterator[None]:
    """Turn a body's file that cannot be used into a diagnostic. Raises: AZeeError."""
    from azee.export.formats.own_joints import NotItsFileError
    from azee_rig.importing.fault import BodyError

    try:
        yield
    except BodyError as error:
        message = f"`{onto}`: {error.message}"
        raise AZeeError(
            Diagnostic(error.code, message, None, notes=error.notes, help=error.help)
        ) from error
    except NotItsFileError as error:
        raise AZeeError(Diagnostic("body-unsupported", f"`{onto}`: {error}", None)) from error


def _open(file: Path, rig: str | None, quiet: bool) -> OpenClip:
    found = open_clip(file, None if rig is None else load_body(rig))
    for note in found.notes:
        news(f"{file}: {note}", quiet=quiet)
    return found


def _wrote(path: Path, quiet: bool) -> None:
    news(f"wrote {path} ({size_of(path)})", quiet=quiet)
