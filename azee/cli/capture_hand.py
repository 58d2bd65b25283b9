"""`azee capture reconstruct | evaluate`: hands from recorded markers, and how good they are."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from azee.cli.capture_options import (
    hand_options,
    open_markers,
    open_poses,
    reading_options,
    refused,
    split_names,
    with_extra,
)
from azee.cli.console import DONE, bar, news, working
from azee.cli.number import Seconds
from azee.cli.outputs import check_outputs, size_of, with_suffix
from azee.formats import CLIP_WRITERS, writing

if TYPE_CHECKING:
    from azee.capture.reconstruction import Method


@click.command(short_help="A whole hand from few markers.")
@click.argument("file", metavar="FILE", type=click.Path(path_type=Path))
@click.option(
    "--model", "model_file", metavar="M.npz", required=True, type=click.Path(path_type=Path),
    help="What `azee capture train` wrote.",
)  # fmt: skip
@click.option(
    "-o", "outputs", metavar="OUT", multiple=True, required=True,
    type=click.Path(path_type=Path), callback=with_suffix(*CLIP_WRITERS),
    help=f"A file to write: {' '.join(CLIP_WRITERS)}. Repeatable.",
)  # fmt: skip
@click.option("--rig", metavar="R", help="The body that plays; by default the model's.")
@click.option(
    "--over", metavar="CLIP", type=click.Path(path_type=Path),
    help="Lay the hand over a movement of the body: a clip (.npz) or BVH.",
)  # fmt: skip
@click.option(
    "--start", "start_s", type=Seconds(), default=0.0, show_default=True,
    help="Second of --over at which FILE starts.",
)  # fmt: skip
@click.option(
    "--markers", "sparse", metavar="A,B,…", callback=split_names,
    help="Markers of FILE to use beside the root's; by default those that the model chose.",
)  # fmt: skip
@click.option(
    "--method", type=click.Choice(["regression", "nearest"]), default="regression",
    show_default=True, help="How the rest of the hand is foretold.",
)  # fmt: skip
@click.option(
    "--couple-tips", "coupled", is_flag=True,
    help="Bend the last joint of each finger by two thirds of the one before.",
)  # fmt: skip
@click.option(
    "--report", metavar="R.json", type=click.Path(path_type=Path), callback=with_suffix(".json"),
    help="Write what each marker is off.",
)  # fmt: skip
@reading_options
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def reconstruct(
    file: Path,
    model_file: Path,
    outputs: Sequence[Path],
    rig: str | None,
    over: Path | None,
    start_s: float,
    sparse: tuple[str, ...] | None,
    method: Method,
    coupled: bool,
    report: Path | None,
    quiet: bool,
    **read: Any,
) -> int:
    """Make the movement of the whole hand from FILE, markers on some of its digits.

    FILE is C3D, TRC or a NumPy archive. All joints stay inside the body's limits.
    """
    from azee.capture.hand_over import hand_clip, hand_over
    from azee.capture.model import read_model
    from azee.capture.reconstruction import reconstruct as made_of
    from azee.cli.body import load_body
    from azee.clips import open_clip, reading, save_clip
    from azee.export.files import replace_file

    written = [*outputs, *([report] if report else [])]
    check_outputs(written)
    with reading(model_file), refused():
        model = read_model(model_file)
    with refused():
        body = load_body(rig) if rig else model.rig
    markers = open_markers(file, **read)
    with working("Reconstructing …", quiet=quiet), refused():
        made = made_of(markers, model, method=method, coupled=coupled, sparse=sparse)
        hand = model.hand(coupled)
        if over is None:
            clip = hand_clip(made, hand, body)
        else:
            clip = hand_over(made, hand, body, open_clip(over, body).clip, start_s)
    for path in outputs:
        save_clip(clip, body, path)
    told = made.report()
    if report is not None:
        text = json.dumps(told, indent=2, ensure_ascii=False, allow_nan=False)
        with writing(report), replace_file(report) as to:
            to.write(f"{text}\n".encode())
    off = [each["mean_off_m"] for each in told["markers"].values() if each["mean_off_m"]]
    lines = [*made.notes]
    if off:
        lines.append(f"recorded markers are off by {1000 * sum(off) / len(off):.1f} mm on average")
    lines += [f"wrote {path} ({size_of(path)})" for path in written]
    news("\n".join(lines), quiet=quiet)
    return DONE


@click.command(short_help="How good hands from few markers are.")
@click.argument("files", nargs=-1, required=True, metavar="FILE…", type=click.Path(path_type=Path))
@click.option(
    "-o", "folder", metavar="FOLDER", required=True, type=click.Path(path_type=Path),
    help="Write evaluation.json, evaluation.md and the figures; it is made if it is not there.",
)  # fmt: skip
@hand_options
@reading_options
@click.option("--quick", is_flag=True, help="Fewer poses and frames: seconds instead of minutes.")
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def evaluate(
    files: Sequence[Path],
    folder: Path,
    root: tuple[str, ...] | None,
    names: tuple[str, ...] | None,
    quick: bool,
    quiet: bool,
    **read: Any,
) -> int:
    """Compare ways to choose markers and to make hands from them, on FILEs with all markers.

    Parts of the recordings are held out, one after the other, and made from few markers.
    """
    poses = open_poses(files, root, names, **read)
    with writing(folder):
        folder.mkdir(exist_ok=True)
    with with_extra():
        from azee.capture.evaluation import evaluate as measured
        from azee.capture.evaluation_report import write_report
    with bar("Measuring", quiet=quiet) as told, refused():
        found = measured(poses, quick=quick, told=told)
    with writing(folder):
        paths = write_report(found, folder)
    news("\n".join(f"wrote {path}" for path in paths), quiet=quiet)
    return DONE
