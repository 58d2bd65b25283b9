"""`azee retarget`: motion of one body on another."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, news, working
from azee.cli.outputs import check_outputs, size_of, with_suffix
from azee.formats import CLIP_WRITERS
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.clip.retarget_source import Measured

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
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def retarget(file: Path, outputs: Sequence[Path], rig: str, unit: str | None, quiet: bool) -> int:
    """Play the motion of FILE, a BVH of any skeleton with arms or a clip (.npz), on a body.

    Kept are: where the hands are from the middle of the shoulders, in arm lengths, how the palms
    are turned, how fingers bend, how trunk and head turn. Legs and the way of the body are not.
    """
    from azee.clip.retarget import retarget as on_other_body
    from azee.clips import save_clip

    check_outputs(outputs)
    body = load_body(rig)
    source = _measured(file, unit)
    with working("Retargeting …", quiet=quiet):
        made = on_other_body(source, body)
    for path in outputs:
        save_clip(made.clip, body, path)
    lines = [*source.notes, made.kept(body)]
    lines += [f"wrote {path} ({size_of(path)})" for path in outputs]
    news("\n".join(lines), quiet=quiet)
    return DONE


def _measured(file: Path, unit: str | None) -> Measured:
    """Read and measure. Raises: AZeeError: cannot-read, not-a-clip."""
    from azee.clip.bvh import read_bvh
    from azee.clip.bvh_hierarchy import BvhError
    from azee.clip.retarget_source import RetargetError, measure_clip, measure_recording
    from azee.clips import open_clip

    if file.suffix.lower() != ".bvh":
        opened = open_clip(file)
        return measure_clip(opened.clip, opened.rig)
    try:
        return measure_recording(read_bvh(file, unit))
    except (BvhError, RetargetError) as error:
        raise AZeeError(Diagnostic("not-a-clip", f"`{file}`: {error}", None)) from error
    except OSError as error:
        reason = (error.strerror or type(error).__name__).lower()
        raise AZeeError(
            Diagnostic("cannot-read", f"cannot read `{file}`: {reason}", None)
        ) from error
