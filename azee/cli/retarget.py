"""`azee retarget`: motion of one body on another."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, news, working
from azee.cli.outputs import check_outputs, size_of, with_suffix
from azee.formats import CLIP_WRITERS, writing

UNITS = ("m", "cm", "inch", "mm", "dm", "foot")


@click.command(short_help="Motion of one body on another.")
@click.argument("file", metavar="FILE", type=click.Path(path_type=Path))
@click.option(
    "-o",
    "outputs",
    metavar="OUT",
    multiple=True,
    required=True,
    type=click.Path(path_type=Path),
    callback=with_suffix(*CLIP_WRITERS),
    help=f"A file to write: {' '.join(CLIP_WRITERS)}. Repeatable.",
)
@click.option(
    "--rig", metavar="R", default="signer", show_default=True, help="The body that is to move."
)
@click.option(
    "--unit", type=click.Choice(UNITS), help="Of a BVH's lengths; by default it is guessed."
)
@click.option(
    "--report",
    metavar="R.json",
    type=click.Path(path_type=Path),
    callback=with_suffix(".json"),
    help="Write how far hands and each finger are off.",
)
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def retarget(
    file: Path,
    outputs: Sequence[Path],
    rig: str,
    unit: str | None,
    report: Path | None,
    quiet: bool,
) -> int:
    """Play the motion of FILE on a body: BVH or glTF of any skeleton with arms, VRMA, or a clip.

    Kept are: where the hands are from the middle of the shoulders, in arm lengths, how the palms
    are turned, how fingers bend, how trunk and head turn. Legs and the way of the body are not.
    """
    from azee.clips import carry_over, save_clip
    from azee.export.files import replace_file

    check_outputs([*outputs, *([report] if report else [])])
    body = load_body(rig)
    with working("Retargeting …", quiet=quiet):
        made, notes = carry_over(file, body, unit)
    for path in outputs:
        save_clip(made.clip, body, path)
    if report is not None:
        text = json.dumps(made.report(body), indent=2, ensure_ascii=False, allow_nan=False)
        with writing(report), replace_file(report) as to:
            to.write(f"{text}\n".encode())
    written = [*outputs, *([report] if report else [])]
    lines = [*notes, made.kept(body)]
    lines += [f"wrote {path} ({size_of(path)})" for path in written]
    news("\n".join(lines), quiet=quiet)
    return DONE
