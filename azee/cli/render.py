"""`azee render`: pictures and films of a text or of a clip, without a display."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from azee.cli.body import load_body
from azee.cli.console import bar, news, working
from azee.cli.number import Number, Seconds
from azee.cli.outputs import check_outputs, picture_size, size_of, with_suffix
from azee.cli.text import (
    Text,
    dominant_option,
    rest_option,
    text_options,
    timing_options,
)
from azee.clips import CLIP_SUFFIXES
from azee.export.pictures.renderer import CHOICES
from azee.export.pictures.shots import SHOTS
from azee.formats import FILM_SUFFIXES, RENDER_SUFFIXES, drawing, filming, writing

if TYPE_CHECKING:
    from azee.clip.clip import Clip
    from azee.compilation import Hand
    from azee.export.pictures.scene import Look
    from azee.motion.keys.rest import Rest
    from azee.motion.timing.performed import Timing
    from azee_rig.rig import Rig

OF_TEXTS = (
    "expression", "utterance", "libraries", "dominant", "rest", "precise", "timing", "tempo",
    "no_life",
)  # fmt: skip
"""Options that say how a text is read and solved."""


@click.command(short_help="Pictures and films, without a display.")
@text_options
@click.option(
    "-o",
    "outputs",
    metavar="OUT",
    multiple=True,
    required=True,
    type=click.Path(path_type=Path),
    callback=with_suffix(*RENDER_SUFFIXES),
    help=f"A picture or a film: {' '.join(RENDER_SUFFIXES)}. Repeatable: all show one solution.",
)
@click.option(
    "--camera",
    "shots",
    multiple=True,
    default=("front",),
    show_default=True,
    type=click.Choice(SHOTS),
    help="From where; several stand side by side. Those on face and hands follow them.",
)
@click.option(
    "--size",
    default="1280x720",
    show_default=True,
    callback=picture_size,
    help="Pixels, WIDTHxHEIGHT.",
)
@click.option(
    "--fps",
    type=Number(1, 240),
    default=30,
    show_default=True,
    help="Frames a second of a film.",
)
@click.option(
    "--at",
    "moments",
    multiple=True,
    metavar="TIME",
    type=Seconds(min=0),
    help="The time of a picture, such as 1.2s; several stand side by side.",
)
@click.option(
    "--sheet", is_flag=True, help="Pictures of the key postures, and of half the way between them."
)
@click.option("--no-captions", is_flag=True, help="No strip with the names of what is running.")
@click.option("--transparent", is_flag=True, help="No background; in .png and .webm.")
@click.option(
    "--renderer",
    default="software",
    show_default=True,
    type=click.Choice(CHOICES),
    help="Who draws: our rasteriser, the same on every machine, or OpenGL (extra `gl`); `auto` is "
    "OpenGL where a graphics processor draws.",
)
@click.option("--rig", metavar="R", help="A body by name, or its folder.")
@dominant_option
@rest_option
@timing_options
@click.option(
    "--precise",
    is_flag=True,
    help="Meet constraints at any price; by default the last centimetre and 5° are eased for "
    "comfort.",
)
@click.option("--no-life", is_flag=True, help="No breathing and no blinking.")
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def render(
    file: str | None,
    expression: str | None,
    utterance: int | None,
    libraries: Sequence[Path],
    outputs: Sequence[Path],
    shots: Sequence[str],
    size: tuple[int, int],
    fps: float,
    moments: Sequence[float],
    sheet: bool,
    no_captions: bool,
    transparent: bool,
    renderer: str,
    rig: str | None,
    dominant: Hand,
    rest: Rest,
    timing: Timing | None,
    tempo: float,
    precise: bool,
    no_life: bool,
    quiet: bool,
) -> None:
    """Draw FILE, a text or a clip (.npz, .bvh), as pictures and films."""
    from azee.compilation import perform
    from azee.export.pictures.scene import Look, NoRoomError
    from azee.quality.outcome import longer

    keys: Sequence[float] | None
    films = [path for path in outputs if path.suffix.lower() in FILM_SUFFIXES]
    if transparent and any(path.suffix.lower() == ".mp4" for path in films):
        raise click.UsageError("MP4 has no transparency; write a .webm")
    if (moments or sheet) and len(films) == len(outputs):
        raise click.UsageError("--at and --sheet are of pictures: name a .png")
    if moments and sheet:
        raise click.UsageError("--at and --sheet exclude each other")
    try:
        look = Look(size, tuple(shots), not no_captions, transparent)
    except ValueError as error:
        raise click.UsageError(str(error)) from error
    check_outputs(outputs)
    if films:
        _encoder_there()
    look = _drawn_by(renderer, look, quiet)
    if file is not None and Path(file).suffix.lower() in CLIP_SUFFIXES:
        _refuse_options_of_texts()
        clip, body, keys = _of_clip(Path(file), rig, quiet)
    else:
        text = Text.read(file, expression, utterance, libraries)
        body = load_body(rig or "signer")
        score = text.score(dominant)
        with working("Solving …", quiet=quiet):
            made = perform(
                score, body, dominant=dominant, life=not no_life, rest=rest, precise=precise,
                timing=timing, tempo=tempo,
            )  # fmt: skip
        for line in longer(made.report):
            news(line, quiet=quiet)
        clip, keys = made.clip, made.animation.key_times
    beyond = [m for m in moments if m > clip.times[-1]]
    if beyond:
        raise click.BadParameter(
            f"{beyond[0]:g} s is after the end, at {clip.times[-1]:.2f} s", param_hint="'--at'"
        )
    for path in outputs:
        try:
            if path in films:
                _film(clip, body, path, look, fps, quiet)
            else:
                _picture(clip, body, path, look, moments, keys, sheet)
        except NoRoomError as error:
            raise click.BadParameter(str(error), param_hint="'--size'") from error
        news(f"wrote {path} ({size_of(path)})", quiet=quiet)


def _encoder_there() -> None:
    from azee.export.pictures.film import encoder

    with filming():
        encoder()


def _drawn_by(renderer: str, look: Look, quiet: bool) -> Look:
    """Find the renderer before anything is solved. Raises: AZeeError: not-installed."""
    from azee.export.pictures.renderer import resolved

    with drawing():
        chosen, name = resolved(renderer)
    if renderer != "software":
        news(f"drawn by {name}", quiet=quiet)
    return replace(look, renderer=chosen)


def _refuse_options_of_texts() -> None:
    """Refuse what says how a text is read and solved. Raises: click.UsageError."""
    context = click.get_current_context()
    for option in context.command.params:
        given = context.get_parameter_source(option.name or "") is ParameterSource.COMMANDLINE
        if given and option.name in OF_TEXTS:
            raise click.UsageError(f"{option.opts[0]} is for texts and does not go with a clip")


def _of_clip(file: Path, rig: str | None, quiet: bool) -> tuple[Clip, Rig, Sequence[float] | None]:
    from azee.clips import open_clip
    from azee_rig.load import RigError

    body = None if rig is None else load_body(rig)
    try:
        found = open_clip(file, body)
    except RigError as error:
        raise click.BadParameter(str(error), param_hint="'--rig'") from error
    for note in found.notes:
        news(f"{file}: {note}", quiet=quiet)
    return found.clip, found.rig, None


def _film(clip: Clip, body: Rig, path: Path, look: Look, fps: float, quiet: bool) -> None:
    from azee.export.pictures.film import write_film

    with bar(f"Filming {path}", quiet=quiet) as progress, filming(), writing(path):
        write_film(clip, body, path, look, fps=fps, progress=progress)


def _picture(
    clip: Clip,
    body: Rig,
    path: Path,
    look: Look,
    moments: Sequence[float],
    keys: Sequence[float] | None,
    sheet: bool,
) -> None:
    from azee.export.pictures.still import write_moments, write_sheet

    with writing(path), drawing():
        if sheet:
            write_sheet(clip, body, path, look, keys)
        else:
            write_moments(clip, body, path, look, moments or [clip.duration_s / 2])
