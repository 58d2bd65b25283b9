"""`azee play`: a text with the signs of a database, as a movement or on a page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, MISSED, news, show, working
from azee.cli.db_place import db_option, opened, usual_place
from azee.cli.number import Number, Seconds
from azee.cli.outputs import check_media, check_outputs, size_of, with_suffix
from azee.cli.play_page import Exported, export, page_options, show_page
from azee.cli.text import library_option, rest_option
from azee.formats import FILM_SUFFIXES, WRITERS
from azee_grammar.diagnostic import AZeeError

if TYPE_CHECKING:
    from collections.abc import Callable

    from azee.clip.blend import Blend
    from azee.compilation import Compilation
    from azee.lang.program import Program
    from azee.motion.keys.rest import Rest
    from azee.player.performing import Performance, Source
    from azee.signs.database import SignDatabase
    from azee.signs.wanted import TextMode
    from azee.spelling.text import Language
    from azee_grammar.diagnostic import Diagnostic
    from azee_rig.rig import Rig

    Played = tuple[Compilation, tuple[Diagnostic, ...]]


@click.command(short_help="A text with signs of a database, as a moving body.")
@click.argument("text", nargs=-1)
@page_options
@click.option(
    "-o", "outputs", metavar="OUT", multiple=True, type=click.Path(path_type=Path),
    callback=with_suffix(*WRITERS),
    help=f"A file to write; its suffix is the format: {' '.join(WRITERS)}. Repeatable.",
)  # fmt: skip
@db_option
@click.option(
    "--text-mode", "mode", type=click.Choice(["thesis", "turkish", "words"]), default="words",
    show_default=True,
    help="thesis: a sign a character, as in Gürel 2010: small letters, capitals for ç ğ ı ö ş ü. "
    "turkish: a sign a character, in Turkish case. words: a sign a word.",
)  # fmt: skip
@click.option(
    "--language", metavar="L",
    help="Only signs of this language; also whose rules and letters are used for words that the "
    "database lacks.",
)  # fmt: skip
@click.option("--variant", metavar="V", help="Only signs of this variant.")
@click.option(
    "--lexicon", metavar="NAME", help="A lexicon whose rules sign what the database lacks."
)
@library_option
@click.option(
    "--blend", type=click.Choice(["direct", "smooth", "linear"]), default="direct",
    show_default=True,
    help="direct: from sign to sign without a fall of the hands. linear: decay and attack averaged "
    "as in Gürel 2010; smooth: the same without jumps of speed.",
)  # fmt: skip
@click.option(
    "--transition", "transition_s", type=Seconds(min=0), metavar="S",
    help="The most seconds from one sign to the next; by default what attack and decay take.",
)  # fmt: skip
@click.option(
    "--idle", "idle_s", type=Seconds(min=0), default=0.5, show_default=True, metavar="S",
    help="Seconds that the signer stands idle before and after.",
)  # fmt: skip
@click.option(
    "--media", metavar="FILM", type=click.Path(path_type=Path),
    help="The film that an .eaf shows beside the signs; by default one written along with it.",
)  # fmt: skip
@click.option(
    "--rig", metavar="R", default="signer", show_default=True, help="A body by name, or its folder."
)
@click.option("--fps", type=Number(1, 1000), default=30, show_default=True, help="Frames a second.")
@rest_option
@click.option("--no-life", is_flag=True, help="No breathing and no blinking while idle.")
@click.option(
    "--report", metavar="R.json", type=click.Path(path_type=Path), callback=with_suffix(".json"),
    help="Write what was measured.",
)  # fmt: skip
@click.option("--strict", is_flag=True, help="Exit with 3 if a sign is missing.")
@click.option("--quiet", is_flag=True, help="Say nothing but what is wrong.")
def play(
    text: Sequence[str],
    outputs: Sequence[Path],
    place: str | None,
    mode: TextMode,
    language: str | None,
    variant: str | None,
    lexicon: str | None,
    libraries: Sequence[Path],
    blend: Blend,
    transition_s: float | None,
    idle_s: float,
    media: Path | None,
    rig: str,
    fps: float,
    rest: Rest,
    no_life: bool,
    report: Path | None,
    strict: bool,
    quiet: bool,
    page: bool,
    folder: Path | None,
    letters: Sequence[Language],
    texts: Sequence[Path],
    port: int,
    opens: bool,
) -> int:
    """Play TEXT: the signs that a database has for its characters or words, one after the other.

    A character without a sign is left out, and told. A word without one is signed by a rule, else
    spelled, and told.

    With --page, TEXT is what the page shows at first; AZee and spelled letters can be typed too.

    Exit codes: 0 done; 1 the input is at fault; 2 wrong use; 3 with --strict.
    """
    typed = " ".join(text)
    if page and outputs:
        raise click.UsageError("a page writes no file: give either --page or -o")
    if folder is not None and not page:
        raise click.UsageError("--export is of the page: give --page too")
    if folder is not None:
        wanted = Exported(typed, rig, letters, texts, libraries, place, language)
        return export(folder, wanted, quiet=quiet)
    if not (page or text):
        raise click.UsageError("give a TEXT, or --page")
    from azee.playing import Player

    def player(database: SignDatabase, where: str, body: Rig) -> Player:
        return Player(
            database, where, body, _rules(language, lexicon, libraries), language, variant, fps,
            rest, not no_life, blend, transition_s, idle_s,
        )  # fmt: skip

    if page:
        signs = _signs(place, lambda *of: player(*of).play, mode)
        return show_page(typed, rig, port, libraries, signs, opens=opens)
    files = [*outputs, *([report] if report else [])]
    check_outputs(files)
    check_media(media, outputs)
    media = media or next((p for p in outputs if p.suffix.lower() in FILM_SUFFIXES), None)
    body = load_body(rig)
    where = place or usual_place()
    with opened(where) as database, working("Playing …", quiet=quiet) as progress:
        with progress.preparing():
            made, told = player(database, where, body).play(typed, mode)
        for path in outputs:
            progress.now(f"Writing {path} …")
            made.save(path, media=media)
        if report:
            made.save_report(report)
    show([*told, *made.left_out])
    news(_lines(made, files), quiet=quiet)
    return MISSED if strict and told else DONE


def _signs(
    place: str | None,
    of: Callable[[SignDatabase, str, Rig], Callable[[str, TextMode], Played]],
    mode: TextMode,
) -> Source | None:
    """Return what plays signs on the page; none if there is no database and none is named."""
    where = place or usual_place()
    if place is None and not Path(where).is_file():
        return None
    with opened(where) as database:  # what is wrong with it is told before the page is shown
        title = database.store.name

    def play(text: str, rig: Rig) -> Performance:
        from azee.player.performing import Performance

        with opened(where) as database:
            made, told = of(database, where, rig)(text, mode)
        return Performance(made.clip, [*told, *made.left_out])

    from azee.player.performing import Source

    return Source("signs", "words", Path(title).name, play)


def _rules(language: str | None, lexicon: str | None, libraries: Sequence[Path]) -> Program:
    """Return an empty text with the libraries whose rules sign words. Raises: AZeeError."""
    from azee.lang.program import load
    from azee.lexicon.installed import lexicon_folder
    from azee.spelling.text import LANGUAGES
    from azee_grammar.source import Source

    folders = [*libraries]
    names: list[str] = [name for name in LANGUAGES if name == language]
    if lexicon is not None:
        folder = lexicon_folder(lexicon)
        folders.append(folder.parent)
        names.append(folder.name)
    program = load(Source("<play>", "".join(f"use '{name}\n" for name in names)), folders)
    if program.found:
        raise AZeeError(*program.found)
    return program


def _lines(made: Compilation, written: Sequence[Path]) -> str:
    clip = made.clip
    names = " ".join(label.text for label in clip.labels)
    lines = [f"{clip.duration_s:.2f} s at {made.report.fps:g} frames a second: {names}"]
    lines += [f"wrote {path} ({size_of(path)})" for path in written]
    return "\n".join(lines if written else [*lines, "nothing written: name files with -o"])
