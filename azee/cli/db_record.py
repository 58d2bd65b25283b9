"""`azee db record`: a text, compiled, becomes a sign of a database."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, news, show, working
from azee.cli.db_place import db_option, opened
from azee.cli.number import Number
from azee.cli.text import Text, dominant_option, expression_option, library_option, rest_option
from azee.compilation import perform

if TYPE_CHECKING:
    from azee.clip.clip import Clip
    from azee.compilation import Compilation, Hand
    from azee.motion.keys.rest import Rest


@click.command(short_help="A text, compiled, as a sign.")
@click.argument("name", metavar="NAME")
@click.argument("file", required=False, metavar="[FILE]")
@expression_option
@library_option
@click.option("--rig", metavar="R", default="signer", show_default=True, help="The body.")
@click.option("--fps", type=Number(1, 1000), default=30, show_default=True, help="Frames a second.")
@dominant_option
@rest_option
@click.option("--no-life", is_flag=True, help="No breathing, no blinking and no sway.")
@click.option("--language", metavar="L", default="", help="Its language, such as lsf.")
@click.option("--variant", metavar="V", default="", help="What tells signs of one name apart.")
@click.option("--tag", "tags", metavar="T", multiple=True, help="A tag. Repeatable.")
@click.option("--licence", metavar="L", default="", help="Its licence.")
@db_option
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def record(
    name: str,
    file: str | None,
    expression: str | None,
    libraries: Sequence[Path],
    rig: str,
    fps: float,
    dominant: Hand,
    rest: Rest,
    no_life: bool,
    language: str,
    variant: str,
    tags: Sequence[str],
    licence: str,
    place: str | None,
    quiet: bool,
) -> int:
    """Compile FILE's utterances, or an expression (-e), and store the movement as the sign NAME.

    Its attack is the way from rest into the text, its decay the way back. The text is kept as the
    file that the sign came from.
    """
    body = load_body(rig)
    with opened(place) as database:
        from azee.signs.packing import packed, timing_of
        from azee.signs.sign import Identity, Motion, SignFacts
        from azee.signs.skeleton import StoredSkeleton

        identity = Identity(name, language, variant)
        text = Text.read(file, expression, None, libraries)
        score = text.score(dominant)
        with working("Solving …", quiet=quiet) as progress, progress.preparing():
            made = perform(
                score, body, dominant=dominant, fps=fps, rest=rest, life=not no_life,
                provenance=text.provenance,
            )  # fmt: skip
        clip, attack_s, decay_s = _without_standing(made)
        timing = timing_of(clip, attack_s, decay_s)
        facts = SignFacts(identity, timing, "azee", tuple(tags), licence, _provenance(text, made))
        original = _source(text)
        motion = Motion(packed(clip, body), original.encode(), f"{identity.name}.azee")
        database.add(facts, motion, StoredSkeleton.of(body))
    show([*text.warnings, *made.left_out, *made.unshown])
    news(f"{identity}: {clip.duration_s:.2f} s, {len(clip.times)} frames", quiet=quiet)
    return DONE


def _without_standing(made: Compilation) -> tuple[Clip, float, float]:
    """Return a clip from where the body leaves its rest until it is back; its attack and decay."""
    from azee.clip.edit import shifted
    from azee.motion.overlay.life import AFTER_S, BEFORE_S

    clip, report = made.clip, made.report
    first, last = float(clip.times[0]), float(clip.times[-1])
    rows = (clip.times >= first + BEFORE_S) & (clip.times <= last - AFTER_S)
    part = replace(
        clip,
        times=clip.times[rows],
        coordinates=clip.coordinates[rows],
        unit_weights=clip.unit_weights[rows],
    )
    zero_s = float(part.times[0])
    attack_s = max(0.0, report.lead_s - zero_s)
    decay_s = max(0.0, float(part.times[-1]) - report.lead_s - report.score_s)
    return shifted(part, -zero_s), attack_s, decay_s


def _source(text: Text) -> str:
    """Return what was compiled, as an AZee text."""
    own = text.program.source.text
    if text.expression is None:
        return own
    return f"{own.rstrip()}\n\n{text.expression}\n" if own.strip() else f"{text.expression}\n"


def _provenance(text: Text, made: Compilation) -> dict[str, object]:
    """Return what a database keeps of how a movement was compiled."""
    report = made.report
    known = made.provenance.as_json() if made.provenance else None
    name = None if text.expression is not None else text.program.source.name
    return {
        "file": name and Path(name).name,
        "expression": text.expression,
        "rules": known,
        "constraints": len(report.constraints),
        "missed": sum(c.missed for c in report.constraints),
    }
