"""`azee spell word`: a text spelled by a body."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, MISSED, news, show, working
from azee.cli.number import Number
from azee.cli.outcome import outcome_lines
from azee.cli.outputs import check_outputs, with_suffix
from azee.cli.spell_options import model_options, open_model, pace_options, times_of
from azee.cli.text import Text, dominant_option, rest_option
from azee.formats import WRITERS
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity

if TYPE_CHECKING:
    from azee.compilation import Hand
    from azee.motion.keys.rest import Rest
    from azee.spelling.text import Language, SpelledText, TextMode
    from azee.spelling.timing.model import TimingModel
    from azee.spelling.timing.published import Style


@click.command(short_help="A text spelled by a body; `word` may be left out.")
@click.argument("text", nargs=-1, required=True)
@click.option(
    "--language", type=click.Choice(["asl", "lsf", "tid"]), default="asl", show_default=True,
    help="Whose manual alphabet.",
)  # fmt: skip
@click.option(
    "--text-mode", "mode", type=click.Choice(["letters", "thesis", "words"]), default="letters",
    show_default=True,
    help="thesis: as in Gürel 2010, small letters for those of English, capitals for ğ ı ö ş ü ç. "
    "words: words that the language's library has are signed.",
)  # fmt: skip
@pace_options
@model_options
@click.option(
    "-o", "outputs", metavar="OUT", multiple=True, type=click.Path(path_type=Path),
    callback=with_suffix(*WRITERS),
    help=f"A file to write; its suffix is the format: {' '.join(WRITERS)}. Repeatable.",
)  # fmt: skip
@click.option(
    "--rig", metavar="R", default="signer", show_default=True, help="A body by name, or its folder."
)
@click.option("--fps", type=Number(1, 1000), default=30, show_default=True, help="Frames a second.")
@dominant_option
@rest_option
@click.option("--no-life", is_flag=True, help="No breathing, no blinking and no sway.")
@click.option(
    "--report", metavar="R.json", type=click.Path(path_type=Path), callback=with_suffix(".json"),
    help="Write what was solved and how well.",
)  # fmt: skip
@click.option("--show", "shown", is_flag=True, help="Print the AZee expression, and do no more.")
@click.option(
    "--strict", is_flag=True,
    help="Exit with 3 if a constraint is out of tolerance, a finger inside another, or a "
    "character is left out.",
)  # fmt: skip
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def word(
    text: Sequence[str],
    language: Language,
    mode: TextMode,
    outputs: Sequence[Path],
    rig: str,
    fps: float,
    dominant: Hand,
    rest: Rest,
    no_life: bool,
    report: Path | None,
    shown: bool,
    strict: bool,
    quiet: bool,
    model_file: Path | None,
    style: Style,
    **pace: Any,
) -> int:
    """Spell TEXT: letters, digits, words and sentences.

    Case follows the language: Turkish `i` is İ and `I` is ı. A character that the alphabet lacks
    is left out, and told.

    Exit codes: 0 done; 1 the input is at fault; 2 wrong use; 3 with --strict.
    """
    from azee.spelling.text import spelled

    files = [*outputs, *([report] if report else [])]
    check_outputs(files)
    read = spelled(" ".join(text), language, mode)
    left_out = [_left_out(character, language) for character in read.unknown]
    if not read.words:
        raise AZeeError(*left_out, _nothing(language))
    show(left_out)
    expression = read.expression(_times(read, open_model(model_file, style), pace))
    if shown:
        click.echo(expression)
        return MISSED if strict and left_out else DONE
    from azee.compilation import perform

    body = load_body(rig)
    source = Text.read(None, expression, None, ())
    with working("Solving …", quiet=quiet) as progress:
        made = perform(
            source.score(dominant),
            body,
            dominant=dominant,
            fps=fps,
            life=not no_life,
            rest=rest,
            provenance=source.provenance,
        )
        for path in outputs:
            progress.now(f"Writing {path} …")
            made.save(path)
    if report:
        made.save_report(report)
    show([*made.left_out, *made.unshown])
    news(outcome_lines(made, files), quiet=quiet)
    return MISSED if strict and (left_out or made.report.missed) else DONE


def _times(
    read: SpelledText, model: TimingModel, pace: dict[str, Any]
) -> list[list[tuple[float, float]]]:
    """Return a hold and the transition after it for each letter of each word that is spelled."""
    spelled = ([] if w.sign else times_of("".join(w.letters), model, **pace) for w in read.words)
    return [[(t.hold_s, t.transition_s) for t in of_word] for of_word in spelled]


def _left_out(character: str, language: Language) -> Diagnostic:
    message = f"the manual alphabet of {language.upper()} has no `{character}`; it is left out"
    return Diagnostic("unknown-character", message, None, severity=Severity.WARNING)


def _nothing(language: Language) -> Diagnostic:
    message = f"the text has nothing that the manual alphabet of {language.upper()} spells"
    return Diagnostic("unknown-character", message, None)
