"""`azee batch`: many texts on many bodies, in any formats, by all processors or a cluster."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from azee.arguments import FASTEST_TEMPO, SLOWEST_TEMPO
from azee.cli.console import DONE, FAULT, bar, news
from azee.cli.number import Number
from azee.cli.text import library_option, rest_option, timing_options
from azee.export.pictures.renderer import CHOICES
from azee.export.pictures.shots import SHOTS
from azee.formats import CAMERA_WRITERS, FILM_SUFFIXES, WRITERS

if TYPE_CHECKING:
    from azee.batch.run import Summary
    from azee.batch.task import Body
    from azee.batch.text import Text
    from azee.compilation import Hand
    from azee.motion.keys.rest import Rest
    from azee.motion.timing.performed import Timing

Value = TypeVar("Value")
FORMATS = tuple(suffix[1:] for suffix in WRITERS)


def _listed(read: Callable[[str], Value]) -> Callable[..., tuple[Value, ...]]:
    """Return an option's callback for values between commas, each once."""

    def values(_: click.Context, parameter: click.Parameter, value: str) -> tuple[Value, ...]:
        found = tuple(read(part.strip()) for part in value.split(","))
        for one in found:
            if found.count(one) > 1:
                raise click.BadParameter(f"`{one}` is there twice")
        return found

    return values


def _one_of(known: Sequence[str], what: str) -> Callable[[str], str]:
    def read(value: str) -> str:
        if value not in known:
            raise click.BadParameter(f"there is no {what} `{value}`; there are: {', '.join(known)}")
        return value

    return read


def _format(value: str) -> str:
    return f".{_one_of(FORMATS, 'format')(value.removeprefix('.').lower())}"


def _speed(value: str) -> float:
    try:
        speed = float(value)
    except ValueError:
        speed = 0.0
    if not SLOWEST_TEMPO <= speed <= FASTEST_TEMPO:
        raise click.BadParameter(
            f"`{value}` is no speed from {SLOWEST_TEMPO:g} to {FASTEST_TEMPO:g}, such as 0.8"
        )
    return speed


def _seed(value: str) -> int | None:
    if value == "score":
        return None
    if not (value.isascii() and value.isdigit()):
        raise click.BadParameter(f"`{value}` is no seed: a whole number from 0 on, or `score`")
    return int(value)


@click.command(short_help="Many texts on many bodies, resumable, on one machine or a cluster.")
@click.argument("sources", nargs=-1, metavar="SOURCE…", type=click.Path(path_type=Path))
@click.option(
    "-o",
    "--output",
    "out",
    metavar="OUT",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="The folder of outputs; it is made if need be.",
)
@click.option(
    "--rules",
    metavar="LIBRARY",
    multiple=True,
    help="Also each rule of a library by itself: its name, or its folder; repeatable.",
)
@click.option(
    "--formats",
    metavar="F,…",
    default="glb",
    show_default=True,
    callback=_listed(_format),
    help=f"Of {' '.join(WRITERS)}, with or without the dot.",
)
@click.option(
    "--bodies",
    metavar="R,…",
    default="signer",
    show_default=True,
    callback=_listed(str),
    help="Bodies by name, or their folders. Each is solved for itself.",
)
@click.option(
    "--hands",
    metavar="H,…",
    default="right",
    show_default=True,
    callback=_listed(_one_of(("right", "left"), "hand")),
    help="right, left or both; left is the mirror image.",
)
@click.option(
    "--seeds",
    metavar="N,…",
    default="score",
    show_default=True,
    callback=_listed(_seed),
    help="Of breathing, blinking and sway; `score` is the one that follows from the text.",
)
@click.option(
    "--speeds",
    metavar="X,…",
    default="1",
    show_default=True,
    callback=_listed(_speed),
    help="Factors by which the solved movement is played faster.",
)
@click.option(
    "--cameras",
    metavar="C,…",
    callback=lambda c, p, v: () if v is None else _listed(_one_of(SHOTS, "camera"))(c, p, v),
    help=f"Of {', '.join(SHOTS)}; for {' and '.join(CAMERA_WRITERS)}. By default front.",
)
@click.option(
    "--renderer",
    default="software",
    show_default=True,
    type=click.Choice(CHOICES),
    help="Who draws films: as for `azee render`.",
)
@click.option("--fps", type=Number(1, 1000), default=30, show_default=True, help="Frames a second.")
@rest_option
@timing_options
@click.option("--precise", is_flag=True, help="Meet constraints at any price of comfort.")
@click.option("--no-life", is_flag=True, help="No breathing, no blinking and no sway.")
@library_option
@click.option(
    "--workers",
    metavar="N",
    type=click.IntRange(min=1),
    help="Processes on this machine; by default one for each processor.",
)
@click.option(
    "--scheduler", metavar="ADDRESS", help="A Dask cluster instead, such as tcp://10.0.0.1:8786."
)
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def batch(
    sources: Sequence[Path],
    out: Path,
    rules: Sequence[str],
    formats: tuple[str, ...],
    bodies: tuple[str, ...],
    hands: tuple[Hand, ...],
    seeds: tuple[int | None, ...],
    speeds: tuple[float, ...],
    cameras: tuple[str, ...],
    renderer: str,
    fps: float,
    rest: Rest,
    timing: Timing | None,
    tempo: float,
    precise: bool,
    no_life: bool,
    libraries: Sequence[Path],
    workers: int | None,
    scheduler: str | None,
    quiet: bool,
) -> int:
    """Compile the texts of all SOURCES on all bodies, with all variations.

    A source is a file of AZee, a list (.jsonl: an object with `text` a line), or a folder of these;
    --rules adds the signs of a lexicon.
    OUT/manifest.jsonl tells what came of each. A run that was stopped or killed goes on with the
    same command; one that is complete does nothing.

    Exit codes: 0 done; 1 some text is at fault, all others are done; 2 wrong use.
    """
    if not sources and not rules:
        raise click.UsageError("nothing to compile: give a SOURCE, or --rules LIBRARY")
    if workers is not None and scheduler is not None:
        raise click.UsageError("--workers are on this machine and do not go with --scheduler")
    seen = [suffix for suffix in formats if suffix in CAMERA_WRITERS]
    if cameras and not seen:
        known = ", ".join(suffix[1:] for suffix in CAMERA_WRITERS)
        raise click.UsageError(f"--cameras need a format that is seen from one: {known}")
    if renderer != "software" and not set(FILM_SUFFIXES) & set(formats):
        known = ", ".join(suffix[1:] for suffix in FILM_SUFFIXES)
        raise click.UsageError(f"--renderer needs a film: {known}")

    from azee.batch.folder import opened
    from azee.batch.options import Options
    from azee.batch.run import run_batch
    from azee.batch.text import told_apart

    options = Options(
        formats, hands, seeds, speeds, (cameras or ("front",)) if seen else (), renderer,
        float(fps), rest, timing, float(tempo), precise, not no_life,
    )  # fmt: skip
    found = _bodies(bodies)
    texts = told_apart(_texts(sources, rules, quiet))
    with opened(out) as folder:
        count = workers or _processors()
        with bar("Compiling", quiet=quiet) as progress:
            summary = run_batch(
                texts, found, options, folder, _workers(count, scheduler, folder), libraries,
                progress,
            )  # fmt: skip
    _tell(summary, out, quiet)
    return FAULT if summary.faulty else DONE


def _texts(sources: Sequence[Path], rules: Sequence[str], quiet: bool) -> list[Text]:
    """Return the texts of sources, then those of rules; say how many rules are none."""
    from azee.batch.rules import rules_of
    from azee.batch.text import texts_of

    found = texts_of(sources)
    for library in rules:
        texts, left_out = rules_of(library)
        found += texts
        if left_out:
            news(
                f"{left_out} rules of {library} are left out: they need arguments and have no "
                "example, or give no score",
                quiet=quiet,
            )
    return found


def _bodies(places: Sequence[str]) -> list[Body]:
    """Return the bodies. Raises: click.BadParameter: one is not there, or two have one name."""
    from azee.batch.task import body_of
    from azee_rig.load import RigError

    try:
        found = [body_of(place) for place in places]
    except RigError as error:
        raise click.BadParameter(str(error), param_hint="'--bodies'") from error
    names = [body.name for body in found]
    for name in names:
        if names.count(name) > 1:
            raise click.BadParameter(f"two bodies are called `{name}`", param_hint="'--bodies'")
    return found


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _workers(count: int, scheduler: str | None, out: Path) -> Callable[[], Any]:
    if scheduler is not None:
        from azee.batch.cluster import ClusterWorkers

        return lambda: ClusterWorkers(scheduler, out)
    from azee.batch.local import LocalWorkers

    return lambda: LocalWorkers(count, out)


def _tell(summary: Summary, out: Path, quiet: bool) -> None:
    for line in summary.errors:
        click.echo(line, err=True)
    rate = f", {summary.done / summary.seconds:.2f} a second" if summary.done else ""
    news(
        f"{summary.tasks} tasks, {summary.done} of them now in {summary.seconds:.1f} s{rate}; "
        f"{summary.faulty} faulty\n"
        f"{summary.clips} clips, {summary.files} files, {summary.size_bytes / 1e6:.1f} MB; "
        f"see {out / 'manifest.jsonl'}",
        quiet=quiet,
    )
