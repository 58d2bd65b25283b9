"""What `azee play --page` does: a page on this machine, or a folder for a web server."""

from __future__ import annotations

import tempfile
import webbrowser
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, bar, news
from azee.cli.db_place import opened
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.player.export import Vocabulary
    from azee.player.performing import Source
    from azee.spelling.text import Language
    from azee_rig.rig import Rig

Command = TypeVar("Command", bound=Callable[..., Any])


def page_options(command: Command) -> Command:
    """Add what `--page` needs besides the options of `azee play`."""
    for option in reversed((
        click.option("--page", is_flag=True,
                     help="Open a page on which a signer plays what one types."),
        click.option(
            "--export", "folder", metavar="FOLDER", type=click.Path(path_type=Path),
            help="With --page: write the page into a folder for a web server, and do no more.",
        ),
        click.option(
            "--letters", multiple=True, type=click.Choice(["asl", "lsf", "tid"]),
            help="With --export: an alphabet that can be typed. Repeatable.",
        ),
        click.option(
            "--azee", "texts", metavar="FILE", multiple=True, type=click.Path(path_type=Path),
            help="With --export: a text that can be played by the name of its file. Repeatable.",
        ),
        click.option("--port", type=click.IntRange(0, 65535), default=8049, show_default=True,
                     help="With --page: 0 takes any that is free."),
        click.option("--open", "opens", is_flag=True,
                     help="With --page: show it in the web browser."),
    )):  # fmt: skip
        command = option(command)
    return command


def show_page(
    text: str,
    rig: str,
    port: int,
    libraries: Sequence[Path],
    signs: Source | None = None,
    *,
    opens: bool,
) -> int:
    """Serve the page until the process is interrupted, or Quit is pressed.

    Args: signs: plays signs of a database, where there is one.
    """
    with _with_extra():
        from azee.player.app import Offer, player_app
        from azee.webserver.serving import LocalServer
    from azee.player.performing import sources
    from azee_rig.load import load_rig, shipped_rigs

    body = load_body(rig)
    bodies = {name: partial(load_rig, name) for name in (body.name, *shipped_rigs())}
    bodies[body.name] = partial(load_rig, rig)
    known = (*((signs,) if signs else ()), *sources(libraries))
    offer = Offer(bodies, known, body.name, known[0].id, text)
    try:
        server = LocalServer.on(port)
    except OSError as error:
        message = f"port {port} is taken: `--port 0` takes one that is free"
        raise click.BadParameter(message, param_hint="'--port'") from error
    with tempfile.TemporaryDirectory(prefix="azee-player-") as scratch:
        news(f"the player is at {server.url} (Ctrl-C ends it)")
        if opens:
            webbrowser.open(_leading_to(server.url, Path(scratch)).as_uri())
        server.serve(player_app(offer, Path(scratch)), largest_body=200_000)
    return DONE


def _leading_to(url: str, folder: Path) -> Path:
    """Return a page in the user's own folder that leads to an address.

    Arguments of a browser can be read by other users of the machine; its token must not.
    """
    page = folder / "open.html"
    page.write_text(f'<!doctype html><meta http-equiv="refresh" content="0; url={url}">', "utf-8")
    return page


@dataclass(frozen=True, slots=True)
class Exported:
    """What an exported page has.

    text: typed at first. letters, texts: alphabets and files in AZee. place: a database with signs,
    of which those of a language are meant.
    """

    text: str
    rig: str
    letters: Sequence[Language]
    texts: Sequence[Path]
    libraries: Sequence[Path]
    place: str | None
    language: str | None


def export(folder: Path, wanted: Exported, *, quiet: bool) -> int:
    """Write the page into a folder for a web server."""
    if not (wanted.letters or wanted.texts or wanted.place):
        raise click.UsageError("give --letters, --azee or --db: what can be typed on the page")
    from azee.formats import writing
    from azee.player.export import NotAnExportError, export_page
    from azee.player.vocabularies import letters, texts

    body = load_body(wanted.rig)
    with ExitStack() as stack:
        known: list[Vocabulary] = []
        if wanted.place:
            known.append(_signs(stack, wanted.place, body, wanted.language))
        known += [letters(one, body) for one in wanted.letters]
        if wanted.texts:
            known.append(texts(wanted.texts, body, wanted.libraries))
        with bar("Solving", quiet=quiet) as progress, writing(folder):
            try:
                count = export_page(folder, body, known, text=wanted.text, progress=progress)
            except NotAnExportError as error:
                help_ = "name a new folder, or one that `azee play --page --export` wrote"
                raise AZeeError(Diagnostic("cannot-write", str(error), None, help=help_)) from error
    size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    news(f"wrote {folder}: {count} signs, {size / 1e6:.1f} MB", quiet=quiet)
    return DONE


def _signs(stack: ExitStack, place: str, body: Rig, language: str | None) -> Vocabulary:
    database = stack.enter_context(opened(place))
    from azee.player.vocabularies import signs

    return signs(database, body, language)


@contextmanager
def _with_extra() -> Iterator[None]:
    """Turn a missing library into a diagnostic. Raises: AZeeError: not-installed."""
    try:
        yield
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in ("starlette", "uvicorn", "anyio"):
            raise
        message = f"the page needs {error.name}"
        remedy = "install it with: pip install 'azee[studio]'"
        raise AZeeError(Diagnostic("not-installed", message, None, help=remedy)) from error
