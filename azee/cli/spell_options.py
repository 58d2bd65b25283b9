"""What the subcommands of `azee spell` share: options of timings, models, what is refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from azee.cli.number import Number
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.spelling.timing.model import TimingModel
    from azee.spelling.timing.published import Style
    from azee.spelling.timing.schedule import LetterTime

Command = TypeVar("Command", bound=Callable[..., Any])

STYLES = ("normal", "careful")
TIMINGS = ("variable", "motion", "normalised", "constant")
HOLDS = ("ridge", "naive-bayes", "naive-bayes-mean")
WAYS = ("with-doubles", "regression")
FACTOR = Number(0, min_open=True, max=100)


def model_options(command: Command) -> Command:
    """Add what chooses a timing model: a file, or the style of one that ships."""
    for option in (
        click.option(
            "--style", type=click.Choice(STYLES), default="normal", show_default=True,
            help="Which of the models that ship; both are fitted to drawn data.",
        ),
        click.option(
            "--model", "model_file", metavar="M.json", type=click.Path(path_type=Path),
            help="A model that `azee spell fit` wrote.",
        ),
    ):  # fmt: skip
        command = option(command)
    return command


def pace_options(command: Command) -> Command:
    """Add what chooses and changes a timing."""
    for option in reversed((
        click.option(
            "--timing", "chosen", type=click.Choice(TIMINGS), default="variable",
            show_default=True,
            help="variable: the model's; motion: as recorded; constant: Huenerfauth's; "
            "normalised: constant, as long as variable.",
        ),
        click.option(
            "--speed", type=FACTOR, default=1.0, show_default=True, help="2 is twice as fast."
        ),
        click.option(
            "--transition-factor", type=FACTOR, default=1.0, show_default=True,
            help="Transitions this many times as long; people prefer slower ones.",
        ),
        click.option(
            "--syllable-factor", type=FACTOR, default=1.0, show_default=True,
            help="Transitions between syllables this much longer, the word as long as before.",
        ),
        click.option(
            "--spelling", type=click.IntRange(1, 1000), default=1, show_default=True,
            help="2 for a word that its text spells for the second time: faster.",
        ),
        click.option(
            "--holds", type=click.Choice(HOLDS), default="ridge", show_default=True,
            help="The model of hold times; naive-bayes is the published one.",
        ),
        click.option(
            "--transitions", type=click.Choice(WAYS), default="with-doubles", show_default=True,
            help="The model of transitions; regression is the published one.",
        ),
    )):  # fmt: skip
        command = option(command)
    return command


def open_model(path: Path | None, style: Style) -> TimingModel:
    """Return the model of a file, or one that ships.

    Raises: AZeeError: cannot-read, spelling-times.
    """
    from azee.clips import reading
    from azee.spelling.timing.model import read_model, shipped_model

    if path is None:
        return shipped_model(style)
    with reading(path), refused():
        return read_model(path)


def times_of(
    word: str,
    model: TimingModel,
    *,
    chosen: Any,
    speed: float,
    transition_factor: float,
    syllable_factor: float,
    spelling: int,
    holds: Any,
    transitions: Any,
) -> tuple[LetterTime, ...]:
    """Return the times of a word as the options of `pace_options` choose them.

    Raises: AZeeError: spelling-times: it was not recorded, or has no letters.
    """
    from azee.spelling.timing.schedule import NotRecordedError, Pace, schedule

    if not word.isalnum():
        raise click.BadParameter(f"`{word}` is no word of letters and digits", param_hint="WORD")
    pace = Pace(speed, transition_factor, syllable_factor, spelling)
    try:
        return schedule(word, chosen, pace, model=model, holds=holds, transitions=transitions)
    except NotRecordedError as error:
        remedy = "another --timing foretells any word; --model names a model of your recordings"
        raise AZeeError(Diagnostic("spelling-times", str(error), None, help=remedy)) from error


@contextmanager
def refused() -> Iterator[None]:
    """Turn what is wrong with a file into a diagnostic."""
    from azee.spelling.timing.timed_word import TimesError

    try:
        yield
    except TimesError as error:
        raise AZeeError(Diagnostic("spelling-times", str(error), None)) from error


@contextmanager
def with_extra() -> Iterator[None]:
    """Turn a missing library into a diagnostic. Raises: AZeeError: not-installed."""
    try:
        yield
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in ("sklearn", "threadpoolctl", "matplotlib"):
            raise
        message = f"fitting and measuring spelling needs {error.name}"
        raise AZeeError(not_installed(message)) from error


def not_installed(message: str) -> Diagnostic:
    """Say which library is missing, and how to install it."""
    remedy = "install it with: pip install 'azee[spelling]'"
    return Diagnostic("not-installed", message, None, help=remedy)
