"""What the subcommands of `azee capture` share: reading markers, and what is refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from azee.cli.number import Number
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.capture.markers import Markers
    from azee.capture.training import Poses

Command = TypeVar("Command", bound=Callable[..., Any])

UNITS = ("mm", "cm", "m", "inch")


def split_names(_: click.Context, __: click.Parameter, value: str | None) -> tuple[str, ...] | None:
    """Split an option's names at commas."""
    if value is None:
        return None
    return tuple(name.strip() for name in value.split(",") if name.strip())


def reading_options(command: Command) -> Command:
    """Add what says how files of markers are read."""
    for option in reversed((
        click.option("--unit", type=click.Choice(UNITS), help="Of lengths, not what FILE says."),
        click.option(
            "--rate", "rate_hz", type=Number(5, 5000), metavar="HZ",
            help="Frames a second, not what FILE says.",
        ),
        click.option(
            "--label", "labels", metavar="NEW=OLD", multiple=True,
            help="Call the marker OLD of FILE by the name NEW. Repeatable.",
        ),
    )):  # fmt: skip
        command = option(command)
    return command


def hand_options(command: Command) -> Command:
    """Add what says which markers are a hand."""
    for option in reversed((
        click.option(
            "--root", metavar="A,B,C", callback=split_names,
            help="Markers that keep their distances; by default those called hand…, wrist…, "
            "forearm….",
        ),
        click.option(
            "--hand", "names", metavar="A,B,…", callback=split_names,
            help="All markers on digits; by default those whose names tell a place on one.",
        ),
    )):  # fmt: skip
        command = option(command)
    return command


def open_markers(
    path: Path, unit: str | None, rate_hz: float | None, labels: Sequence[str]
) -> Markers:
    """Read a file of markers. Raises: AZeeError: cannot-read, not-markers, not-installed."""
    from dataclasses import replace

    from azee.capture.reading import read_markers
    from azee.clips import reading

    pairs = [label.partition("=") for label in labels]
    for new, equals, old in pairs:
        if not (new and equals and old):
            raise click.BadParameter("it is NEW=OLD", param_hint="'--label'")
    with reading(path), refused(), with_extra():
        markers = read_markers(path, unit, rate_hz)
        markers.only([old for _, _, old in pairs]) if pairs else None
        renamed = {old: new for new, _, old in pairs}
        return replace(markers, names=tuple(renamed.get(name, name) for name in markers.names))


def open_poses(
    files: Sequence[Path],
    root: tuple[str, ...] | None,
    names: tuple[str, ...] | None,
    unit: str | None,
    rate_hz: float | None,
    labels: Sequence[str],
) -> Poses:
    """Read recordings of one hand with all its markers. Raises: AZeeError."""
    from azee.capture.places import root_markers
    from azee.capture.training import poses_of

    recordings = [open_markers(path, unit, rate_hz, labels) for path in files]
    with refused():
        return poses_of(recordings, root or root_markers(recordings[0].names), names)


@contextmanager
def refused() -> Iterator[None]:
    """Turn what is wrong with markers into a diagnostic. Raises: AZeeError: not-markers."""
    from azee.capture.markers import MarkersError

    try:
        yield
    except MarkersError as error:
        raise AZeeError(Diagnostic("not-markers", str(error), None, help=error.remedy)) from error


@contextmanager
def with_extra() -> Iterator[None]:
    """Turn a missing library into a diagnostic. Raises: AZeeError: not-installed."""
    try:
        yield
    except ModuleNotFoundError as error:
        needed = {"c3d": "reading C3D", "matplotlib": "drawing figures"}
        what = needed.get((error.name or "").partition(".")[0])
        if what is None:
            raise
        raise AZeeError(
            Diagnostic(
                "not-installed", f"{what} needs {error.name}", None,
                help="install it with: pip install 'azee[capture]'",
            )
        ) from error  # fmt: skip
