"""The AZee text a command is given: a file, standard input or an expression, with libraries."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from azee.arguments import FASTEST_TEMPO, SLOWEST_TEMPO
from azee.cli.number import Number

if TYPE_CHECKING:
    from azee.compilation import Hand
    from azee.lang.library_folder import Shelf
    from azee.lang.program import Program
    from azee.lang.recordings import Recordings
    from azee.lang.shortcuts import Shortcuts, Taken
    from azee.lang.written import Written
    from azee.score.provenance import Provenance
    from azee.score.score import Score
    from azee_grammar.diagnostic import Diagnostic

Command = TypeVar("Command", bound=Callable[..., Any])

library_option = click.option(
    "--library",
    "libraries",
    metavar="DIR",
    multiple=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="A folder of rules that `use` may name; repeatable.",
)
"""`--library DIR`, of every command that reads rules."""

expression_option = click.option(
    "-e",
    "expression",
    metavar="EXPR",
    help="An expression, instead of FILE's utterances; it sees FILE's rules.",
)
"""`-e EXPR`, of every command that reads a text or an expression."""

dominant_option = click.option(
    "--dominant",
    type=click.Choice(["right", "left"]),
    default="right",
    show_default=True,
    help="The signer's strong hand.",
)
"""`--dominant HAND`, of every command that tells strong and weak apart."""

rest_option = click.option(
    "--rest",
    type=click.Choice(["folded", "hanging", "ready"]),
    default="hanging",
    show_default=True,
    help="Where arms are that nothing is asked of: hands on one another, hanging, or held ready.",
)
"""`--rest REST`, of every command that makes a movement."""


def timing_options(command: Command) -> Command:
    """Add the options --timing and --tempo to a command that makes a text move."""
    timing = click.option(
        "--timing",
        type=click.Choice(["performed", "exact"]),
        help="performed: a hand that has too far to go for its time gets more. exact: all times "
        "are the text's. By default performed, with --mode flat exact.",
    )
    tempo = click.option(
        "--tempo",
        type=Number(SLOWEST_TEMPO, FASTEST_TEMPO),
        default=1,
        show_default=True,
        help="How many times faster all is that is not fixed.",
    )
    return timing(tempo(command))


def _note(ctx: click.Context, parameter: click.Parameter, value: object) -> None:
    ctx.meta[f"azee.{parameter.name}"] = value


def _noted(name: str) -> Any:
    context = click.get_current_context(silent=True)
    return context.meta.get(f"azee.{name}") if context else None


recordings_option = click.option(
    "--db",
    metavar="DB",
    envvar="AZEE_DB",
    expose_value=False,
    callback=_note,
    help="The database whose signs `recorded` plays: a file, or a URL. By default that of AZEE_DB.",
)
"""`--db DB`, of every command that evaluates a text; `Text.read` uses it."""

shortcuts_option = click.option(
    "--shortcuts",
    metavar="FILE",
    type=click.Path(path_type=Path),
    expose_value=False,
    callback=_note,
    help="Expressions for which recorded signs are played: lines such as `:bonjour => 'BONJOUR`.",
)
"""`--shortcuts FILE`, of the same commands."""


def text_options(command: Command) -> Command:
    """Add the argument FILE and the options -e, --utterance, --library and --db to a command."""
    options = (
        click.argument("file", required=False, metavar="[FILE]"),
        expression_option,
        click.option(
            "--utterance",
            metavar="N",
            type=click.IntRange(min=1),
            help="Only FILE's Nth utterance; by default all play, one after the other.",
        ),
        library_option,
        recordings_option,
        shortcuts_option,
    )
    for option in reversed(options):
        command = option(command)
    return command


@dataclass(frozen=True)
class Text:
    """A program, and which part of it is wanted."""

    program: Program
    expression: str | None
    utterance: int | None
    shortcuts: Shortcuts | None = None

    @classmethod
    def read(
        cls,
        file: str | None,
        expression: str | None,
        utterance: int | None,
        libraries: Sequence[Path],
        shelf: Shelf | None = None,
    ) -> Text:
        """Read what the command line names. shelf: as `load` takes it.

        Raises: click.UsageError: too little or too much of it. AZeeError: it cannot be read.
        """
        from azee.lang.program import load
        from azee_grammar.files import read_source
        from azee_grammar.source import Source

        if file is None and expression is None:
            raise click.UsageError("name a FILE (`-` is standard input) or give an expression, -e")
        if expression is not None and utterance is not None:
            raise click.UsageError("--utterance counts FILE's own and does not go with -e")
        source = Source("<none>", "") if file is None else read_source(file)
        program = load(source, libraries, shelf=shelf, recordings=_recordings())
        path = _noted("shortcuts")
        if path is None:
            return cls(program, expression, utterance)
        from azee.lang.shortcuts import Shortcuts

        shortcuts = Shortcuts.read(read_source(path))
        return cls(shortcuts.on(program), expression, utterance, shortcuts)

    def score(self, dominant: Hand = "right") -> Score:
        """Evaluate what is wanted. Raises: AZeeError: all that is wrong with it."""
        from azee.compilation import score_of

        return score_of(self.program, self.expression, self.utterance, dominant)

    @property
    def applications(self) -> list[Written]:
        """The applications of rules that are written in what is wanted."""
        from azee.lang.provenance import written

        return written(self.program, self.expression, self.utterance)

    @property
    def provenance(self) -> Provenance:
        """How far the forms of the rules in what is wanted are known.

        Raises: AZeeError: the manifest of a library cannot be read.
        """
        from azee.lang.provenance import provenance_of

        return provenance_of(self.applications)

    @property
    def shortcuts_taken(self) -> tuple[Taken, ...]:
        """The expressions for which recordings are played, once they are evaluated."""
        return self.shortcuts.taken if self.shortcuts else ()

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """What else there is to say about the text, then about the expression."""
        found = self.program.check()
        if self.expression is None:
            return found
        return (*found, *self.program.evaluate(self.expression).warnings)


def _recordings() -> Recordings | None:
    """Return the recorded signs of the database that the command line names."""
    place = _noted("db")
    if place is None:
        return None
    from azee.cli.db_place import in_words

    with in_words():
        from azee.signs.recordings import SignRecordings
    return SignRecordings(place)
