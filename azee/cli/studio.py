"""`azee studio`: a page on this machine to write, see and correct signing."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from azee.cli.console import DONE, news
from azee.cli.text import library_option
from azee_grammar.diagnostic import AZeeError, Diagnostic

_EXTRA = ("starlette", "uvicorn", "websockets", "pygls", "lsprotocol")


@click.command(short_help="A page to write, see and correct signing.")
@click.argument("place", metavar="[FILE|FOLDER]", default=".", type=click.Path(path_type=Path))
@library_option
@click.option(
    "--rig", "rigs", metavar="DIR", multiple=True, type=click.Path(path_type=Path),
    help="The folder of a further body, as `azee rig import` makes it; repeatable.",
)  # fmt: skip
@click.option("--port", type=click.IntRange(0, 65535), default=0, show_default=True,
              help="0 takes any that is free.")  # fmt: skip
@click.option(
    "--kept", metavar="FILE", type=click.Path(dir_okay=False, path_type=Path),
    help="Where drafts and versions are kept; by default in your folder for data.",
)  # fmt: skip
@click.option("--no-browser", is_flag=True, help="Only print the address.")
def studio(
    place: Path,
    libraries: Sequence[Path],
    rigs: Sequence[Path],
    port: int,
    kept: Path | None,
    no_browser: bool,
) -> int:
    """Open FILE or FOLDER on a page of this machine's browser, until Ctrl-C.

    The page shows the text, the signer, the score and what could not be met. Only who knows the
    address that is printed can use it. What is typed is kept at once; files are written when you
    save.
    """
    folder, first = _opened(place)
    bodies = _bodies(rigs)
    try:
        from platformdirs import user_data_path

        from azee.studio.serving import history_path, serve
        from azee.webserver.serving import LocalServer
    except ModuleNotFoundError as missing:
        if (missing.name or "").partition(".")[0] not in _EXTRA:
            raise
        message = f"the studio needs {missing.name}"
        remedy = "install it with: pip install 'azee[studio]'"
        raise AZeeError(Diagnostic("not-installed", message, None, help=remedy)) from missing
    try:
        server = LocalServer.on(port)
    except OSError as error:
        message = f"port {port} is taken: `--port 0` takes one that is free"
        raise click.BadParameter(message, param_hint="'--port'") from error
    news(f"the studio is at {server.url} (Ctrl-C ends it)")
    if not no_browser:
        import webbrowser

        webbrowser.open(server.url)
    path = kept or history_path(folder, user_data_path("azee"))
    libraries = [library.resolve() for library in libraries]
    try:
        serve(server, folder, first, libraries=libraries, bodies=bodies, kept=path)
    except OSError as error:
        if error.filename is None:
            raise
        message = f"cannot open `{error.filename}`: {(error.strerror or 'no such file').lower()}"
        raise AZeeError(Diagnostic("cannot-read", message, None)) from error
    return DONE


def _opened(place: Path) -> tuple[Path, str | None]:
    """Return the folder, and the text in it that is shown first. Raises: AZeeError."""
    from azee_grammar.files import TEXT_SUFFIXES, is_file, is_folder

    if is_folder(place):
        return place, None
    if place.suffix not in TEXT_SUFFIXES:
        message = (
            f"`{place}` is no folder, and no text: texts end with {' or '.join(TEXT_SUFFIXES)}"
        )
        raise AZeeError(Diagnostic("cannot-read", message, None))
    if not is_file(place) and not is_folder(place.parent):
        message = f"there is no folder `{place.parent}` for `{place}`"
        raise AZeeError(Diagnostic("cannot-read", message, None))
    return place.parent, place.name


def _bodies(folders: Sequence[Path]) -> dict[str, str]:
    """Return the bodies that ship and those of folders, by name."""
    from azee_rig.load import RigError, load_rig, shipped_rigs

    found = {name: name for name in sorted(shipped_rigs(), key=lambda name: name != "signer")}
    for folder in folders:
        try:
            load_rig(folder)
        except RigError as error:
            raise click.BadParameter(str(error), param_hint="'--rig'") from error
        found[folder.resolve().name] = str(folder.resolve())
    return found
