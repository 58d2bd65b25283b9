"""`azee compile`: from a text to files with the moving body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, FAULT, MISSED, as_json, news, show, show_json, working
from azee.cli.number import Number
from azee.cli.outcome import outcome_lines
from azee.cli.outputs import check_media, check_outputs, with_suffix
from azee.cli.profile import Profile
from azee.cli.text import (
    Text,
    dominant_option,
    rest_option,
    text_options,
    timing_options,
)
from azee.compilation import perform
from azee.formats import FILM_SUFFIXES, WRITERS
from azee_grammar.diagnostic import AZeeError

if TYPE_CHECKING:
    from azee.compilation import Compilation, Hand, Method
    from azee.motion.keys.rest import Rest
    from azee.motion.tasks.key_selection import Mode
    from azee.motion.timing.performed import Timing
    from azee_grammar.diagnostic import Diagnostic


@click.command("compile", short_help="A text as a moving body: GLB, BVH, films and more.")
@text_options
@click.option(
    "-o",
    "outputs",
    metavar="OUT",
    multiple=True,
    type=click.Path(path_type=Path),
    callback=with_suffix(*WRITERS),
    help=f"A file to write; its suffix is the format: {' '.join(WRITERS)}. "
    "Repeatable: all come from one solution.",
)
@click.option(
    "--media",
    metavar="FILM",
    type=click.Path(path_type=Path),
    help="The film that an .eaf shows beside the score; by default one written along with it.",
)
@click.option(
    "--rig", metavar="R", default="signer", show_default=True, help="A body by name, or its folder."
)
@click.option(
    "--fps",
    type=Number(1, 1000),
    default=30,
    show_default=True,
    help="Frames a second.",
)
@dominant_option
@click.option(
    "--mode",
    type=click.Choice(["tracks", "flat"]),
    default="tracks",
    show_default=True,
    help="How blocks become movement: each keys what it needs, or all on one time line, as in "
    "the 2018 paper.",
)
@click.option(
    "--solver",
    type=click.Choice(["grouped", "two-level"]),
    default="grouped",
    show_default=True,
    help="How postures are found; two-level: the iterations of the 2018 paper, for comparison.",
)
@rest_option
@timing_options
@click.option(
    "--precise",
    is_flag=True,
    help="Meet constraints at any price; by default the last centimetre and 5° are eased for "
    "comfort.",
)
@click.option(
    "--no-life", is_flag=True, help="No breathing, no blinking and none of what bodies do besides."
)
@click.option(
    "--report",
    metavar="R.json",
    type=click.Path(path_type=Path),
    callback=with_suffix(".json"),
    help="Write what was solved and how well.",
)
@click.option(
    "--strict-body",
    is_flag=True,
    help="Refuse a text that names what the body lacks; by default that is left out.",
)
@click.option(
    "--strict",
    is_flag=True,
    help="Exit with 3 if a constraint is out of tolerance or a finger inside another.",
)
@click.option("--profile", is_flag=True, help="Tell where the time of the whole process goes.")
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json"]),
    default="text",
    help="json: one object with diagnostics, outputs and the report on standard output.",
)
def compile_(
    file: str | None,
    expression: str | None,
    utterance: int | None,
    libraries: Sequence[Path],
    outputs: Sequence[Path],
    media: Path | None,
    rig: str,
    fps: float,
    dominant: Hand,
    mode: Mode,
    solver: Method,
    rest: Rest,
    timing: Timing | None,
    tempo: float,
    precise: bool,
    no_life: bool,
    report: Path | None,
    strict_body: bool,
    strict: bool,
    profile: bool,
    quiet: bool,
    form: str,
) -> int:
    """Compile FILE (`-` is standard input) to a signing body.

    Exit codes: 0 done; 1 the input is at fault; 2 wrong use; 3 with --strict, if a
    constraint is out of tolerance or a finger is inside another where no touch is asked for.
    """
    files = [*outputs, *([report] if report else [])]
    check_media(media, outputs)
    media = media or next((p for p in outputs if p.suffix.lower() in FILM_SUFFIXES), None)
    watch = Profile()
    watch.load("numpy", "importing numpy")
    with watch.stage("loading the body"):
        body = load_body(rig)
    try:
        check_outputs(files)
        watch.load("azee.lang.program", "importing the language")
        with watch.stage("parsing"):
            text = Text.read(file, expression, utterance, libraries)
        with watch.stage("evaluating"):
            score = text.score(dominant)
        with working("Solving …", quiet=quiet or form == "json") as progress:
            with progress.preparing():
                watch.load_solver()
            with progress.preparing(), watch.stage("making the movement"):
                made = perform(
                    score,
                    body,
                    dominant=dominant,
                    fps=fps,
                    mode=mode,
                    life=not no_life,
                    rest=rest,
                    solver=solver,
                    precise=precise,
                    strict_body=strict_body,
                    timing=timing,
                    tempo=tempo,
                    provenance=text.provenance,
                )
                made = replace(made, shortcuts=text.shortcuts_taken)
            watch.split(made.report)
            for path in outputs:
                progress.now(f"Writing {path} …")
                with watch.stage(f"writing {path.name}"):
                    made.save(path, media=media)
        if report:
            with watch.stage(f"writing {report.name}"):
                made.save_report(report)
    except AZeeError as error:
        if form != "json":
            raise
        show_json({"diagnostics": as_json(error.diagnostics), "outputs": [], "report": None})
        return FAULT
    if form == "json":
        with watch.stage("the report"):
            measured = made.report_json()
        show_json(
            {
                "diagnostics": as_json(_warnings(text, made)),
                "outputs": [str(path) for path in outputs],
                "report": measured,
                **({"profile": watch.as_json()} if profile else {}),
            }
        )
    else:
        show(_warnings(text, made))
        news(outcome_lines(made, files), quiet=quiet)
        if profile:
            watch.show()
    return MISSED if strict and made.report.missed else DONE


def _warnings(text: Text, made: Compilation) -> list[Diagnostic]:
    return [*text.warnings, *made.left_out, *made.unshown]
