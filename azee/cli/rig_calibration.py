"""`azee rig calibration`: five postures in which a body or a capture touches itself."""

from __future__ import annotations

from pathlib import Path

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, MISSED, news, show_json, working
from azee.cli.number import Number
from azee_grammar.diagnostic import AZeeError, Diagnostic


@click.command(short_help="Whether hands, arms and face meet, on a body or in a capture.")
@click.argument("file", metavar="[FILE]", required=False, type=click.Path(path_type=Path))
@click.option("--rig", "name", metavar="R", default="signer", show_default=True, help="The body.")
@click.option(
    "--within", "within_mm", type=Number(0, 1000), metavar="MM",
    help="What counts as touching; by default 10 mm on a body, 20 mm in a capture.",
)  # fmt: skip
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
def calibration(file: Path | None, name: str, within_mm: float | None, form: str) -> int:
    """Check a body by five postures in which it touches itself (Gürel 2010, figure 3.3).

    With FILE, a recording or clip in which an actor takes these postures in any order, the frame
    that is nearest to each is looked for, on the body.

    Exit codes: 0 all touch, 1 a FILE or body that cannot be used, 3 some do not.
    """
    from azee.calibration import WITHIN_M, apart, of_body, of_capture
    from azee_solver.binding import BindingError

    body = load_body(name)
    within_m = (10.0 if file is None else 1000.0 * WITHIN_M) if within_mm is None else within_mm
    within_m /= 1000.0
    notes: tuple[str, ...] = ()
    try:
        with working("Solving …", quiet=form == "json"):
            if file is None:
                found = of_body(body)
            else:
                from azee.clips import open_clip

                opened = open_clip(file, body)
                notes, found = opened.notes, of_capture(opened.clip, body)
    except BindingError as error:
        message = f"the rig `{body.name}` has no site `{error.text}`"
        raise AZeeError(Diagnostic(error.code, message, None)) from error
    missed = apart(found, within_m)
    if form == "json":
        show_json({"rig": body.name, "postures": [m.as_json() for m in found]})
        return MISSED if missed else DONE
    for note in notes:
        news(f"{file}: {note}")
    for m in found:
        when = "" if m.time_s is None else f" at {m.time_s:.2f} s"
        verdict = "apart" if m in missed else "ok"
        text = f"{m.posture.number}  {m.posture.meaning}: {1000 * m.distance_m:.1f} mm{when}"
        click.echo(f"{text}  {verdict}")
    return MISSED if missed else DONE
