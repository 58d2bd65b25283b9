"""`azee rig import`: a body that others made, as a rig."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.console import DONE, news, show_json, working
from azee.cli.outputs import check_outputs, with_suffix
from azee.formats import cannot_write, writing
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee_rig.importing.bone_map import BoneMap
    from azee_rig.importing.report import ImportReport

FOUND = {
    "VRM": "the bones-map is the file's own (VRM)",
    "names": "the bones-map was found by the joints' names",
    "shape": "the joints' names say nothing: the bones-map was found by the shape of the skeleton",
    "given": "the bones-map is yours",
}


@click.command("import", short_help="Take in a body: skinned glTF or VRM.")
@click.argument("body", metavar="BODY.glb", type=click.Path(path_type=Path))
@click.option(
    "-o", "folder", metavar="DIR", type=click.Path(path_type=Path), help="The rig's folder."
)
@click.option(
    "--map",
    "bone_map",
    metavar="MAP.json",
    type=click.Path(path_type=Path),
    help="Your own bones-map, or a proposal that you corrected.",
)
@click.option(
    "--propose",
    "proposal",
    metavar="MAP.json",
    type=click.Path(path_type=Path),
    callback=with_suffix(".json"),
    help="Only write the bones-map that would be used.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json"]),
    default="text",
    help="json: one object with all findings on standard output.",
)
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def import_(
    body: Path,
    folder: Path | None,
    bone_map: Path | None,
    proposal: Path | None,
    form: str,
    quiet: bool,
) -> int:
    """Make a rig of a skinned body: BODY is a .glb, .gltf or .vrm file.

    Joints are told by the file itself (VRM), by their names, or by the shape of the skeleton. DIR
    then stands wherever a command takes --rig; its map.json may be corrected and given to --map.

    Exit codes: 0 done; 1 the body cannot be taken in; 2 wrong use.
    """
    if (folder is None) == (proposal is None):
        raise click.UsageError("say either -o DIR or --propose MAP.json")
    with _diagnosed(body, folder or proposal):
        if proposal is not None:
            check_outputs([proposal])
            _propose(body, proposal, quiet=quiet)
        elif folder is not None:
            _import(body, folder, bone_map, form, quiet=quiet)
    return DONE


@contextmanager
def _diagnosed(body: Path, target: Path | None) -> Iterator[None]:
    from azee_rig.importing.fault import BodyError

    try:
        yield
    except BodyError as error:
        damaged = error.code == "body-unreadable" and body.name not in error.message
        message = f"`{body}`: {error.message}" if damaged else error.message
        raise AZeeError(
            Diagnostic(error.code, message, None, notes=error.notes, help=error.help)
        ) from error
    except OSError as error:
        raise AZeeError(cannot_write(target or Path(), error)) from error


def _propose(body: Path, path: Path, *, quiet: bool) -> None:
    from azee.export.files import replace_file
    from azee_rig.importing.importer import propose_bones

    found = propose_bones(body)
    data = json.dumps(found.as_json(), indent=1, ensure_ascii=False)
    with writing(path), replace_file(path) as file:
        file.write(f"{data}\n".encode())
    news("\n".join([FOUND[found.family], *_lacking(found), f"wrote {path}"]), quiet=quiet)


def _lacking(found: BoneMap) -> list[str]:
    return [f"to be filled in: {', '.join(found.lacking)}"] if found.lacking else []


def _import(body: Path, folder: Path, bone_map: Path | None, form: str, *, quiet: bool) -> None:
    from azee_rig.importing.folder import check_folder, write_folder
    from azee_rig.importing.importer import import_body

    check_folder(folder)
    with working("Taking the body in …", quiet=quiet or form == "json"):
        made = import_body(body, folder.resolve().name, bone_map)
        write_folder(made, folder)
    if form == "json":
        show_json({"diagnostics": [], "rig": str(folder), "report": made.report.as_json()})
    else:
        news(_told(made.report, folder), quiet=quiet)


def _told(report: ImportReport, folder: Path) -> str:
    lines = [
        FOUND[report.family],
        f"{report.kept} of {report.joints} joints are kept, {report.vertices} vertices",
        *report.notes,
        *(f"doubtful: {doubt}" for doubt in report.doubts),
        *(f"missing: {missing}" for missing in report.missing(folder)),
        f"wrote {folder}: use it with --rig {folder}",
    ]
    return "\n".join(lines)
