"""`azee rig`: what a body has, as tables, JSON or pictures.

Tables speak in degrees and millimetres; JSON in radians and metres, as all machine formats do.
"""

from __future__ import annotations

import math
import shutil
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, MISSED, news, show_json, working
from azee.cli.outputs import check_outputs, with_suffix
from azee.cli.rig_calibration import calibration
from azee.cli.rig_import import import_

if TYPE_CHECKING:
    from azee_rig.rig import Rig
    from azee_rig.site_check import AtBind, OverRange

Command = TypeVar("Command", bound=Callable[..., Any])
Row = dict[str, Any]

WORST = 10
"""Sites that `azee rig check` lists."""

rig_option = click.option(
    "--rig", "body", metavar="R", default="signer", show_default=True,
    help="A body by name, or its folder.",
)  # fmt: skip
format_option = click.option(
    "--format", "form", type=click.Choice(["text", "json"]), default="text",
    help="json: one object on standard output, in metres and radians.",
)  # fmt: skip


def picture_option(shown: str) -> Callable[[Command], Command]:
    """Return the option `--picture OUT.png`, with what it shows for its help."""
    return click.option(
        "--picture", metavar="OUT.png", type=click.Path(path_type=Path),
        callback=with_suffix(".png"), help=shown,
    )  # fmt: skip


@click.group("rig", short_help="What a body has: sites, bones, limits, morphs; taking one in.")
def rig() -> None:
    """Show what AZee's names mean on a body, or take one in."""


rig.add_command(import_)
rig.add_command(calibration)


@rig.command()
@rig_option
@format_option
@picture_option("Labelled dots on the whole body, the head and the right hand.")
def sites(body: str, form: str, picture: Path | None) -> None:
    """List the sites: bone, place, outward normal, description.

    Places are those in the posture that the mesh was modelled in.
    """
    _list(
        "sites", load_body(body), form, picture, _sites,
        ("site", "bone", "left mm", "up mm", "fwd mm", "normal", "description"),
        lambda row: (
            row["name"], row["bone"], *_mm(row["position_m"]), _triple(row["normal"]),
            row["description"],
        ),
    )  # fmt: skip


@rig.command()
@rig_option
@format_option
@picture_option("The zero pose with every bone's axes: x red, dir green, nrm blue.")
def bones(body: str, form: str, picture: Path | None) -> None:
    """List the bones: parent, coordinates, proximal joint, dir and nrm in the zero pose."""
    _list(
        "bones", load_body(body), form, picture, _bones,
        ("bone", "parent", "left mm", "up mm", "fwd mm", "dir", "nrm", "coordinates"),
        lambda row: (
            row["name"], row["parent"] or "", *_mm(row["position_m"]), _triple(row["dir"]),
            _triple(row["nrm"]), " ".join(row["coordinates"]),
        ),
    )  # fmt: skip


@rig.command()
@rig_option
@format_option
@picture_option("Each coordinate of trunk, head and right side at both limits.")
def limits(body: str, form: str, picture: Path | None) -> None:
    """List how far each coordinate goes, counted from the zero pose."""
    _list(
        "limits", load_body(body), form, picture, _limits,
        ("coordinate", "from °", "to °"),
        lambda row: (row["coordinate"], _deg(row["lower_rad"]), _deg(row["upper_rad"])),
    )  # fmt: skip


@rig.command()
@rig_option
@format_option
@picture_option("Refused: `azee rig limits` has the pictures.")
def coordinates(body: str, form: str, picture: Path | None) -> None:
    """List the coordinates: bone, idle and bind posture, stiffness, the nodes that it turns."""
    if picture:
        raise click.UsageError(
            "a coordinate has no place to be drawn at: "
            "`azee rig limits --picture` shows each at both its limits"
        )
    _list(
        "coordinates", load_body(body), form, None, _coordinates,
        ("coordinate", "bone", "idle °", "bind °", "stiffness", "turns"),
        lambda row: (
            row["name"], row["bone"], _deg(row["idle_rad"]), _deg(row["bind_rad"]),
            f"{row['stiffness']:g}", " ".join(turn["node"] for turn in row["turns"]),
        ),
    )  # fmt: skip


@rig.command()
@rig_option
@format_option
@picture_option("Every facial morph that this body can show, at weight 1.")
def morphs(body: str, form: str, picture: Path | None) -> None:
    """List the morphs: what each moves at weight 1, and those that this body cannot show."""
    _list(
        "morphs", load_body(body), form, picture, _morphs,
        ("morph", "moves", "description"), _morph_line,
    )  # fmt: skip


@rig.command()
@rig_option
@format_option
def check(body: str, form: str) -> int:
    """Measure how true the sites are to the skin.

    As the mesh was modelled: distance from the skin, side, bone, and whether normals look
    outward. Over the range of every joint, its coordinates at their limits in every combination:
    the ten sites that leave the skin farthest, negative where they sink.

    Exit codes: 0 all is as it should be, 2 wrong use, 3 something is not.
    """
    from azee_rig.site_check import at_bind, over_range

    loaded = load_body(body)
    with working("measuring the sites over every joint"):
        resting, ranged = at_bind(loaded), over_range(loaded)
    wrong = [site.site for site in resting if site.faults]
    astray = [site.site for site in ranged if not site.is_near]
    if form == "json":
        show_json(
            {
                "rig": loaded.name,
                "at_bind": [_as_json(site) for site in resting],
                "over_range": [_as_json(site) for site in ranged],
            }
        )
        return MISSED if wrong or astray else DONE
    off, apart = (max(getattr(s, what) for s in resting) for what in ("distance_m", "mirror_m"))
    click.echo(
        f"as modelled: {len(resting)} sites, at most {1000 * off:.1f} mm off the skin; "
        f"left and right mirror each other within {1000 * apart:.1f} mm"
    )
    for site in resting:
        for fault in site.faults:
            click.echo(f"  {site.site}: {fault}")
    click.echo("over the range of every joint, farthest off:")
    _table(
        ("site", "off mm", "where"),
        [
            (site.site, f"{1000 * site.distance_m:+.1f}",
             ", ".join(f"{name} {_deg(angle)}°" for name, angle in site.at_rad.items()))
            for site in ranged[:WORST]
        ],
    )  # fmt: skip
    if astray:
        click.echo(f"too far off: {', '.join(astray)}")
    return MISSED if wrong or astray else DONE


def _as_json(site: AtBind | OverRange) -> Row:
    from dataclasses import asdict

    return asdict(site)


def _sites(loaded: Rig) -> Iterator[Row]:
    from azee_grammar.vocabulary import SITES

    frames = loaded.chain.frames(loaded.coordinates.bind)
    for name, site in loaded.sites.items():
        yield {
            "name": name,
            "bone": site.bone,
            "position_m": site.point(frames).tolist(),
            "normal": site.outward(frames).tolist(),
            "description": SITES[name].description,
        }


def _bones(loaded: Rig) -> Iterator[Row]:
    from azee_grammar.vocabulary import BONES
    from azee_rig.chain import DIR, NRM

    frames = loaded.chain.frames(0.0 * loaded.coordinates.bind)
    for name, nodes in loaded.bones.items():
        yield {
            "name": name,
            "parent": BONES[name],
            "position_m": frames.positions[nodes.origin_node].tolist(),
            "dir": frames.rotations[nodes.node][:, DIR].tolist(),
            "nrm": frames.rotations[nodes.node][:, NRM].tolist(),
            "coordinates": [n for n in loaded.coordinates.names if n.partition(".")[0] == name],
        }


def _limits(loaded: Rig) -> Iterator[Row]:
    c = loaded.coordinates
    for name, lower, upper in zip(c.names, c.lower.tolist(), c.upper.tolist(), strict=True):
        yield {"coordinate": name, "lower_rad": lower, "upper_rad": upper}


def _coordinates(loaded: Rig) -> Iterator[Row]:
    c, chain = loaded.coordinates, loaded.chain
    for i, name in enumerate(c.names):
        yield {
            "name": name,
            "bone": name.partition(".")[0],
            "lower_rad": float(c.lower[i]),
            "upper_rad": float(c.upper[i]),
            "idle_rad": float(c.idle[i]),
            "bind_rad": float(c.bind[i]),
            "stiffness": float(c.stiffness[i]),
            "turns": [
                {
                    "node": node,
                    "axis": ("x", "dir", "nrm")[chain.dof_axis[d]],
                    "share": float(chain.dof_scale[d]),
                }
                for b, node in enumerate(chain.names)
                for d in range(chain.dof_start[b], chain.dof_start[b + 1])
                if chain.dof_coordinate[d] == i
            ],
        }


def _morphs(loaded: Rig) -> Iterator[Row]:
    from azee_grammar.vocabulary import MORPHS

    for name, entry in MORPHS.items():
        yield {
            "name": name,
            "kind": entry.kind,
            "description": entry.description,
            "coordinates_rad": dict(loaded.skeletal_morphs.get(name, {})),
            "units": dict(loaded.face_morphs.get(name, {})),
            "not_shown": loaded.unexpressed_morphs.get(name),
        }


def _morph_line(row: Row) -> tuple[str, str, str]:
    angles = [f"{name} {_deg(angle)}°" for name, angle in row["coordinates_rad"].items()]
    units = [f"{unit} {weight:g}" for unit, weight in row["units"].items()]
    return row["name"], ", ".join(angles + units) or f"— {row['not_shown']}", row["description"]


def _list(
    what: str,
    loaded: Rig,
    form: str,
    picture: Path | None,
    rows: Callable[[Rig], Iterable[Row]],
    heads: Sequence[str],
    line: Callable[[Row], Sequence[str]],
) -> None:
    """Draw what a body has, tell it as JSON, or write a table of it."""
    if picture:
        _draw(what, loaded, picture)
    if form == "json":
        show_json({"rig": loaded.name, what: list(rows(loaded))})
    elif not picture:
        _table(heads, [line(row) for row in rows(loaded)])


def _draw(what: str, loaded: Rig, path: Path) -> None:
    """Draw a sheet, save it and say so. Raises: AZeeError: cannot-write."""
    from azee.export.pictures.atlas import write_sheet
    from azee.formats import writing

    check_outputs([path])
    with writing(path):
        write_sheet(what, loaded, path)
    news(f"wrote {path}")


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Write a table as wide as the terminal, or as 120 columns where there is none."""
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, header_style="bold", pad_edge=False)
    for k, head in enumerate(heads):
        number = head.endswith((" mm", " °"))
        table.add_column(head, justify="right" if number else "left", no_wrap=k == 0 or number)
    for row in rows:
        table.add_row(*row)
    width = shutil.get_terminal_size((120, 24)).columns
    Console(width=width, highlight=False, markup=False, emoji=False).print(table)


def _mm(point_m: Sequence[float]) -> tuple[str, str, str]:
    x, y, z = (f"{1000.0 * v:.1f}" for v in point_m)
    return x, y, z


def _deg(angle_rad: float) -> str:
    return f"{math.degrees(angle_rad) + 0.0:.1f}"


def _triple(unit: Sequence[float]) -> str:
    return " ".join(f"{v:+.2f}" for v in unit)
