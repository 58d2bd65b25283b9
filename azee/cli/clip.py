"""`azee clip`: parts of clips, clips joined, other speeds and rates, the other hand."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from azee.cli.body import load_body
from azee.cli.console import news
from azee.cli.number import Number, Seconds
from azee.cli.outputs import check_outputs, size_of, with_suffix
from azee.formats import CLIP_WRITERS
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.clip.blend import Blend
    from azee.clip.clip import Clip
    from azee.clips import OpenClip
    from azee_rig.rig import Rig

Command = TypeVar("Command", bound=Callable[..., Any])

SECONDS = Seconds(min=0)


@click.group("clip", short_help="Cut, join, mirror and retime clips.")
def clip() -> None:
    """Work on clips: files that `azee compile -o x.npz` wrote, or BVH."""


def _options(command: Command) -> Command:
    """Add what all subcommands take: the outputs, their rate, the body, --quiet."""
    for option in reversed(
        (
            click.option(
                "-o",
                "outputs",
                metavar="OUT",
                multiple=True,
                required=True,
                type=click.Path(path_type=Path),
                callback=with_suffix(*CLIP_WRITERS),
                help=f"A file to write: {' '.join(CLIP_WRITERS)}. Repeatable.",
            ),
            click.option(
                "--fps",
                type=Number(1, 1000),
                help="Frames a second of what is written; by default those of FILE.",
            ),
            click.option("--rig", metavar="R", help="A body by name, or its folder."),
            click.option("--quiet", is_flag=True, help="Say nothing but what is wrong."),
        )
    ):
        command = option(command)
    return command


_file = click.argument("file", metavar="FILE", type=click.Path(path_type=Path))


@clip.command(short_help="A part of a clip.")
@_file
@click.option("--from", "start_s", type=SECONDS, default=0, help="First second; default 0.")
@click.option("--to", "end_s", type=SECONDS, help="Last second; by default the end.")
@_options
def cut(
    file: Path,
    start_s: float,
    end_s: float | None,
    outputs: Sequence[Path],
    fps: float | None,
    rig: str | None,
    quiet: bool,
) -> None:
    """Write the part of FILE between two times."""
    from azee.clip.edit import cut as cut_out
    from azee.clip.edit import shifted

    check_outputs(outputs)
    found = _open([file], rig, quiet)[0]
    with _in_words():
        whole = shifted(found.clip, -float(found.clip.times[0]))
        last = whole.duration_s
        part = cut_out(whole, start_s, last if end_s is None else end_s, found.rig.coordinates)
    _save(part, found.rig, outputs, fps or _rate([found.clip]), quiet)


@clip.command(short_help="Clips one after the other.")
@click.argument("files", nargs=-1, required=True, metavar="FILE…", type=click.Path(path_type=Path))
@click.option(
    "--overlap",
    "overlap_s",
    type=SECONDS,
    default=0.5,
    show_default=True,
    help="Seconds in which the end of each is blended with the start of the next.",
)
@click.option(
    "--blend",
    type=click.Choice(["smooth", "linear"]),
    default="smooth",
    show_default=True,
    help="smooth: without a jump of speed or acceleration; linear: as in the 2010 thesis.",
)
@_options
def join(
    files: Sequence[Path],
    overlap_s: float,
    blend: Blend,
    outputs: Sequence[Path],
    fps: float | None,
    rig: str | None,
    quiet: bool,
) -> None:
    """Join the FILEs into one clip, blending each with the next."""
    from azee.clip.blend import joined

    check_outputs(outputs)
    found = _open(files, rig, quiet)
    clips = [each.clip for each in found]
    body = found[0].rig
    if foreign := [
        path for path, each in zip(files, found, strict=True) if each.rig.name != body.name
    ]:
        message = f"`{foreign[0]}` moves another body than `{files[0]}`"
        raise AZeeError(Diagnostic("not-a-clip", message, None, help="name one body with --rig"))
    with _in_words():
        whole = joined(
            clips, body.coordinates, overlap_s=overlap_s, blend=blend, fps=fps or _rate(clips)
        )
    _save(whole, body, outputs, None, quiet)


@clip.command(short_help="The other hand.")
@_file
@_options
def mirror(
    file: Path, outputs: Sequence[Path], fps: float | None, rig: str | None, quiet: bool
) -> None:
    """Write the mirror image of FILE, as a left-handed signer signs it."""
    from azee.clip.edit import left_handed

    check_outputs(outputs)
    found = _open([file], rig, quiet)[0]
    _save(left_handed(found.clip, found.rig.coordinates), found.rig, outputs, fps, quiet)


@clip.command(short_help="Slower or faster.")
@_file
@click.option("--duration", "duration_s", type=SECONDS, help="Seconds that it is to last.")
@click.option("--speed", type=Number(0, min_open=True), help="2 is twice as fast.")
@_options
def retime(
    file: Path,
    duration_s: float | None,
    speed: float | None,
    outputs: Sequence[Path],
    fps: float | None,
    rig: str | None,
    quiet: bool,
) -> None:
    """Write FILE slower or faster; the frame rate stays."""
    from azee.clip.edit import retimed

    if (duration_s is None) == (speed is None):
        raise click.UsageError("give either --duration or --speed")
    check_outputs(outputs)
    found = _open([file], rig, quiet)[0]
    with _in_words():
        seconds = duration_s if duration_s is not None else found.clip.duration_s / (speed or 1.0)
        moved = retimed(found.clip, seconds)
    _save(moved, found.rig, outputs, fps or _rate([found.clip]), quiet)


@clip.command(short_help="Another format or frame rate.")
@_file
@_options
def convert(
    file: Path, outputs: Sequence[Path], fps: float | None, rig: str | None, quiet: bool
) -> None:
    """Write FILE in other formats, or with another frame rate."""
    check_outputs(outputs)
    found = _open([file], rig, quiet)[0]
    _save(found.clip, found.rig, outputs, fps, quiet)


def _open(files: Sequence[Path], rig: str | None, quiet: bool) -> list[OpenClip]:
    """Read clips for one body. Raises: AZeeError, click.BadParameter."""
    from azee.clips import open_clip
    from azee_rig.load import RigError

    body = None if rig is None else load_body(rig)
    try:
        found = [open_clip(file, body) for file in files]
    except RigError as error:
        raise click.BadParameter(str(error), param_hint="'--rig'") from error
    for file, each in zip(files, found, strict=True):
        for note in each.notes:
            news(f"{file}: {note}", quiet=quiet)
    return found


def _save(made: Clip, body: Rig, outputs: Sequence[Path], fps: float | None, quiet: bool) -> None:
    """Write a clip in every format asked for, evenly spaced, and say so."""
    from azee.clip.resample import at_rate, rate
    from azee.clips import save_clip

    if fps is None and len(made.times) > 1:
        fps = 30.0 if rate(made) is None else None
    if fps is not None:
        with _in_words():
            made = at_rate(made, fps, body.coordinates)
    for path in outputs:
        save_clip(made, body, path)
    lines = [f"{made.duration_s:.2f} s, {len(made.times)} frames"]
    news("\n".join([*lines, *(f"wrote {path} ({size_of(path)})" for path in outputs)]), quiet=quiet)


def _rate(clips: Sequence[Clip]) -> float | None:
    from azee.clip.blend import common_rate

    return common_rate(clips)


@contextmanager
def _in_words() -> Iterator[None]:
    """Turn what cannot be done with a clip into a diagnostic. Raises: AZeeError: clip-times."""
    try:
        yield
    except ValueError as error:
        raise AZeeError(Diagnostic("clip-times", str(error), None)) from error
