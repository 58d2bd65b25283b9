"""`azee repl`: a prompt at which AZee is tried."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, FAULT
from azee.cli.text import dominant_option, library_option

if TYPE_CHECKING:
    from azee.compilation import Hand

SHIPPED = "signer"


@click.command(short_help="A prompt to try expressions and rules at.")
@click.argument("files", nargs=-1, metavar="[FILE…]", type=click.Path(path_type=Path))
@library_option
@click.option("--rig", metavar="R", default=SHIPPED, show_default=True, help="The body that plays.")
@dominant_option
@click.option(
    "--precise",
    is_flag=True,
    help="Meet constraints at any price; by default the last centimetre and 5° are eased for "
    "comfort.",
)
@click.option("--plain", is_flag=True, help="No line editing, no colours, no completion.")
@click.option("--no-history", is_flag=True, help="Neither read nor keep what was typed.")
@click.option(
    "--solve/--no-solve",
    default=None,
    help="Solve every score at once and tell the outcome; by default, at a terminal.",
)
def repl(
    files: Sequence[Path],
    libraries: Sequence[Path],
    rig: str,
    dominant: Hand,
    precise: bool,
    plain: bool,
    no_history: bool,
    solve: bool | None,
) -> int:
    """Read expressions and definitions, show what they evaluate to. `/help` tells the rest.

    The rules of each FILE are known at the prompt. A change of a rule file counts at once. Input
    from a pipe is read as a file is, and its results are printed.

    Exit codes: 0 done; 1 something in piped input or FILE was at fault; 2 wrong use.
    """
    from azee.repl.performer import Performer
    from azee.repl.plain import converse, read_through
    from azee.repl.repl import Repl
    from azee.repl.screen import plain_screen
    from azee.repl.session import Session

    if rig != SHIPPED:
        load_body(rig)  # to be told now, not at the first score
    typed = sys.stdin.isatty()
    on_terminal = typed and sys.stdout.isatty() and os.environ.get("TERM") != "dumb"
    edited = on_terminal and not plain
    screen = plain_screen()
    if edited:
        from azee.repl.prompt import terminal_screen

        screen = terminal_screen()
    performer = Performer(rig, dominant, precise=precise)
    answering = Repl(
        Session(libraries),
        performer,
        screen,
        interactive=typed,
        solving=typed if solve is None else solve,
    )
    right = answering.load(files)
    if not typed:
        return DONE if read_through(answering, sys.stdin) and right else FAULT
    performer.warm_up()
    screen.say("AZee. /help tells what there is, Ctrl-D leaves.")
    if edited:
        from azee.repl.history import history_file, remembered
        from azee.repl.prompt import converse as converse_edited

        converse_edited(answering, remembered(None if no_history else history_file()))
    else:
        converse(answering)
    if not performer.ready():
        _leave_now()
    return DONE


def _leave_now() -> None:
    """End the process beside a thread that compiles, which an orderly end would wait for."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(DONE)
