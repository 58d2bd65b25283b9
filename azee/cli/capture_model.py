"""`azee capture choose | train`: which markers to record, and a model of a hand."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from azee.cli.capture_options import hand_options, open_poses, reading_options, refused, split_names
from azee.cli.console import DONE, bar, news, show_json
from azee.cli.outputs import check_outputs, size_of, with_suffix
from azee.formats import writing

if TYPE_CHECKING:
    from azee.capture.training import Algorithm

ALGORITHMS = ("regression", "clusters", "clusters-printed", "components")
_algorithm = click.option(
    "--algorithm", type=click.Choice(ALGORITHMS), default="regression", show_default=True,
    help="regression: ours; clusters: algorithm 1 scored over all markers, clusters-printed: as it "
    "is printed; components: algorithm 2.",
)  # fmt: skip
_count = click.option(
    "--count", type=click.IntRange(1), default=6, show_default=True,
    help="Markers beside the root's.",
)  # fmt: skip
_files = click.argument(
    "files", nargs=-1, required=True, metavar="FILE…", type=click.Path(path_type=Path)
)


@click.command(short_help="Which markers to record.")
@_files
@_count
@_algorithm
@hand_options
@reading_options
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def choose(
    files: Sequence[Path],
    count: int,
    algorithm: Algorithm,
    root: tuple[str, ...] | None,
    names: tuple[str, ...] | None,
    form: str,
    quiet: bool,
    **read: Any,
) -> int:
    """Print the markers from which the whole hand comes best.

    FILEs are recordings of one hand with all its markers: C3D, TRC or NumPy archives.
    """
    from azee.capture.training import choose as chosen_of
    from azee.capture.training import left_open

    poses = open_poses(files, root, names, **read)
    with refused(), bar("Choosing", quiet=quiet) as told:
        chosen = chosen_of(poses, count, algorithm, told=told)
    off = left_open(poses, chosen)
    each_mm = {n: round(1000 * float(x), 2) for n, x in zip(poses.names, off, strict=True)}
    if form == "json":
        show_json({
            "algorithm": algorithm,
            "root": list(poses.root.names),
            "markers": list(chosen),
            "off_mm": each_mm,
        })  # fmt: skip
        return DONE
    for name in chosen:
        click.echo(name)
    unseen = {n: mm for n, mm in each_mm.items() if n not in (*chosen, *poses.root.names)}
    others = ", ".join(f"{name} {mm:.1f} mm" for name, mm in unseen.items())
    news(f"root: {', '.join(poses.root.names)}\nthe others would be off: {others}", quiet=quiet)
    return DONE


@click.command(short_help="A model of a hand.")
@_files
@click.option(
    "-o", "output", metavar="M.npz", required=True, type=click.Path(path_type=Path),
    callback=with_suffix(".npz"), help="Write the model.",
)  # fmt: skip
@click.option(
    "--markers", "chosen", metavar="A,B,…", callback=split_names,
    help="Markers that will be recorded beside the root's; by default they are chosen.",
)  # fmt: skip
@_count
@_algorithm
@hand_options
@reading_options
@click.option(
    "--side", type=click.Choice(["R", "L"]), default="R", show_default=True,
    help="Which hand it is.",
)  # fmt: skip
@click.option("--rig", metavar="R", default="signer", show_default=True,
              help="A body that ships, whose joints and limits the hand gets.")  # fmt: skip
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def train(
    files: Sequence[Path],
    output: Path,
    chosen: tuple[str, ...] | None,
    count: int,
    algorithm: Algorithm,
    root: tuple[str, ...] | None,
    names: tuple[str, ...] | None,
    side: str,
    rig: str,
    quiet: bool,
    **read: Any,
) -> int:
    """Fit a hand to FILEs, recordings of it with all markers, and keep them as a model."""
    from azee.capture.hand import Hand
    from azee.capture.model import write_model
    from azee.capture.training import choose as chosen_of
    from azee.capture.training import train as trained
    from azee.cli.body import load_body
    from azee.export.files import replace_file

    check_outputs([output])
    body = load_body(rig)
    poses = open_poses(files, root, names, **read)
    with refused():
        how = algorithm if chosen is None else "by hand"
        if chosen is None:
            with bar("Choosing markers", quiet=quiet) as told:
                chosen = chosen_of(poses, count, algorithm, told=told)
        with bar("Training", quiet=quiet) as told:
            model = trained(poses, chosen, Hand(body, side), algorithm=how, told=told)
    with writing(output), replace_file(output) as file:
        write_model(model, file)
    off = model.provenance["fit_off_m"]
    mean_mm = 1000 * sum(off.values()) / len(off)
    news(
        f"{len(model.poses)} poses; markers {', '.join(model.chosen)}\n"
        f"the hand's markers are off by {mean_mm:.1f} mm when all are recorded\n"
        f"wrote {output} ({size_of(output)})",
        quiet=quiet,
    )
    return DONE
