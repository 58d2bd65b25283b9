"""`azee spell timing | fit | evaluate | warp`: when the letters of spelled words are held."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from azee.cli.console import DONE, news, show_json, working
from azee.cli.number import Seconds
from azee.cli.outputs import check_outputs, size_of, with_suffix
from azee.cli.spell_options import (
    STYLES,
    model_options,
    not_installed,
    open_model,
    pace_options,
    refused,
    times_of,
    with_extra,
)
from azee.formats import CLIP_WRITERS, writing
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.spelling.timing.published import Style
    from azee.spelling.timing.recordings import Recorded
    from azee.spelling.timing.schedule import LetterTime


@click.command(short_help="When the letters of a word are held.")
@click.argument("word")
@pace_options
@model_options
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
def timing(word: str, form: str, model_file: Path | None, style: Style, **chosen: Any) -> int:
    """Print how long each letter of WORD is held, and each way to the next letter takes."""
    from azee.spelling.timing.schedule import duration_s

    model = open_model(model_file, style)
    times = times_of(word, model, **chosen)
    if form == "json":
        rows = [
            {
                "letter": t.letter,
                "hold_ms": round(1000 * t.hold_s, 2),
                "transition_ms": round(1000 * t.transition_s, 2),
            }
            for t in times
        ]
        whole = round(1000 * duration_s(times), 2)
        show_json(
            {"word": word.upper(), "origin": model.origin, "duration_ms": whole, "letters": rows}
        )
        return DONE
    click.echo("letter  hold ms  transition ms")
    for t in times:
        passed = f"{1000 * t.transition_s:13.0f}" if t.transition_s else ""
        click.echo(f"{t.letter:6}  {1000 * t.hold_s:7.0f}  {passed}".rstrip())
    click.echo(f"{1000 * duration_s(times):.0f} ms; times {model.origin}")
    return DONE


@click.command(short_help="A timing model of recorded words.")
@click.argument("files", nargs=-1, metavar="FILE…", type=click.Path(path_type=Path))
@click.option(
    "-o", "output", metavar="M.json", required=True, type=click.Path(path_type=Path),
    callback=with_suffix(".json"), help="Write the model.",
)  # fmt: skip
@click.option(
    "--times", "times_file", metavar="T.csv", type=click.Path(path_type=Path),
    callback=with_suffix(".csv"), help="Write the times that were found, a letter a row.",
)  # fmt: skip
@click.option(
    "--tiers", nargs=2, metavar="WORDS LETTERS", default=("words", "letters"), show_default=True,
    help="Tiers of ELAN files.",
)  # fmt: skip
@click.option(
    "--drawn", metavar="SEED", type=click.IntRange(0),
    help="Instead of FILEs, draw words from published statistics, as for the models that ship.",
)  # fmt: skip
@click.option(
    "--style", type=click.Choice(STYLES), default="normal", show_default=True,
    help="Of the drawn words.",
)  # fmt: skip
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def fit(
    files: Sequence[Path],
    output: Path,
    times_file: Path | None,
    tiers: tuple[str, str],
    drawn: int | None,
    style: Style,
    quiet: bool,
) -> int:
    """Fit a timing model to FILEs in which somebody spells words.

    A FILE is an ELAN file with tiers of words and of letter holds (.eaf); landmarks of a hand
    with the word that it spells (.npz with `landmarks`, `rate_hz` and `text`); or a table (.csv).
    """
    from azee.spelling.timing.model import DRAWN, model_text
    from azee.spelling.timing.timed_word import write_times

    if bool(files) == (drawn is not None):
        raise click.UsageError("give FILEs, or --drawn SEED, and not both")
    check_outputs([output, *([times_file] if times_file else [])])
    with refused(), with_extra():
        from azee.spelling.timing.fitting import fit_model

        if drawn is not None:
            from azee.spelling.timing.drawn import drawn_words

            words, origin = list(drawn_words(drawn, style)), DRAWN
        else:
            words = [found.word for file in files for found in _recorded(file, tiers)]
            origin = f"fitted to {len(words)} recorded words"
        with working("Fitting …", quiet=quiet):
            model = fit_model(words, origin)
    with writing(output):
        output.write_text(model_text(model), encoding="utf-8")
    if times_file is not None:
        with writing(times_file):
            write_times(words, times_file)
    letters = sum(len(word.word) for word in words)
    news(f"{len(words)} words, {letters} letters; wrote {output} ({size_of(output)})", quiet=quiet)
    return DONE


@click.command(short_help="How well a timing model foretells, beside the published figures.")
@click.option(
    "-o", "folder", metavar="FOLDER", required=True, type=click.Path(path_type=Path),
    help="Write evaluation.json, evaluation.md and the figures; it is made if it is not there.",
)  # fmt: skip
@model_options
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def evaluate(folder: Path, model_file: Path | None, style: Style, quiet: bool) -> int:
    """Measure a timing model on its own words, learnt, left out and held out.

    It writes tables 4.2 and 4.3 and figures 4.3 to 4.8 of Wheatland (2016) with our data, and
    every published figure beside ours.
    """
    model = open_model(model_file, style)
    with writing(folder):
        folder.mkdir(exist_ok=True)
    with with_extra():
        from azee.spelling.timing.report import evaluate_model, write_report

    with working("Measuring …", quiet=quiet) as progress, refused():
        found = evaluate_model(model, style, told=lambda what: progress.now(f"Measuring: {what} …"))
        with writing(folder):
            written = write_report(found, folder)
    news(
        f"held-out words: error {found.gain:.1f} times smaller than the best constant model's\n"
        + "\n".join(f"wrote {path}" for path in written),
        quiet=quiet,
    )
    return DONE


@click.command(short_help="A recorded word in other times.")
@click.argument("file", metavar="CLIP", type=click.Path(path_type=Path))
@click.option("--word", required=True, help="The word that CLIP spells.")
@click.option(
    "--times", "times_file", metavar="T", required=True, type=click.Path(path_type=Path),
    help="When its letters are held: a table (.csv), an ELAN file (.eaf) or landmarks (.npz).",
)  # fmt: skip
@click.option(
    "--start", "start_s", type=Seconds(min=0),
    help="Second of CLIP at which the first hold starts; by default as the times say.",
)  # fmt: skip
@click.option("--smooth", is_flag=True, help="Without jumps of speed between holds and ways.")
@click.option(
    "-o", "outputs", metavar="OUT", multiple=True, required=True,
    type=click.Path(path_type=Path), callback=with_suffix(*CLIP_WRITERS),
    help=f"A file to write: {' '.join(CLIP_WRITERS)}. Repeatable.",
)  # fmt: skip
@click.option("--rig", metavar="R", help="A body by name, or its folder.")
@pace_options
@model_options
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def warp(
    file: Path,
    word: str,
    times_file: Path,
    start_s: float | None,
    smooth: bool,
    outputs: Sequence[Path],
    rig: str | None,
    model_file: Path | None,
    style: Style,
    quiet: bool,
    **chosen: Any,
) -> int:
    """Warp CLIP, a recording of a spelled word, to another timing."""
    from azee.cli.body import load_body
    from azee.clip.resample import at_rate
    from azee.clips import open_clip, save_clip
    from azee.spelling.timing.warp import warped

    check_outputs(outputs)
    model = open_model(model_file, style)
    opened = open_clip(file, load_body(rig) if rig else None)
    recordings = _recorded(times_file, ("words", "letters"))
    found = [recorded for recorded in recordings if recorded.word.word == word.upper()]
    if not found:
        message = f"`{times_file}` has no word `{word.upper()}`"
        raise AZeeError(Diagnostic("spelling-times", message, None))
    recorded = found[0]
    times = (
        _as_letter_times(recorded)
        if chosen["chosen"] == "motion"
        else times_of(word, model, **chosen)
    )
    clip = opened.clip
    try:
        made = warped(
            clip, recorded.word, times,
            recorded.start_s if start_s is None else start_s, smooth=smooth,
        )  # fmt: skip
    except ValueError as error:
        raise AZeeError(Diagnostic("spelling-times", str(error), None)) from error
    fps = (len(clip.times) - 1) / clip.duration_s
    made = at_rate(made, round(fps, 3), opened.rig.coordinates)
    for path in outputs:
        save_clip(made, opened.rig, path)
    lines = [f"{clip.duration_s:.2f} s became {made.duration_s:.2f} s; times {model.origin}"]
    lines += [f"wrote {path} ({size_of(path)})" for path in outputs]
    news("\n".join(lines), quiet=quiet)
    return DONE


def _as_letter_times(recorded: Recorded) -> tuple[LetterTime, ...]:
    from azee.spelling.timing.schedule import LetterTime

    word = recorded.word
    rows = zip(word.word, word.holds_s, (*word.transitions_s, 0.0), strict=True)
    return tuple(LetterTime(*row) for row in rows)


def _recorded(path: Path, tiers: tuple[str, str]) -> Sequence[Recorded]:
    from azee.clips import reading
    from azee.corpus.annotations import NoElanLibraryError
    from azee.spelling.timing.letter_poses import asl_poses
    from azee.spelling.timing.recordings import read_recording

    try:
        with reading(path), refused():
            return read_recording(path, asl_poses(), tiers)
    except NoElanLibraryError as error:
        raise AZeeError(not_installed(str(error))) from error
