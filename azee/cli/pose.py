"""`azee pose`: drag parts of the body at one instant of a text, and get the text that does it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from azee.cli.body import load_body
from azee.cli.console import DONE, news, show_json, working
from azee.cli.number import Seconds
from azee.cli.text import dominant_option, library_option
from azee.formats import writing

if TYPE_CHECKING:
    from azee.compilation import Hand
    from azee.posing.proposal import Proposal
    from azee.posing.session import Frame, PosingSession

SHOWN = 8
"""How many proposals are printed."""


@click.command(short_help="Drag the body at one instant, and get the text for it.")
@click.argument("file", metavar="FILE")
@click.option("--at", "at_s", type=Seconds(), required=True, help="The instant, such as .6s.")
@click.option(
    "--drag",
    "drags",
    nargs=4,
    type=(str, float, float, float),
    multiple=True,
    metavar="PART X Y Z",
    help='A site, such as "I_TIP(s)", or the `gaze`, to a point in metres: left, up and forward '
    'of the signer\'s feet; or a bone, such as "!palm(s)" or "nrm !palm(s)", along a direction. '
    "Repeatable.",
)
@click.option(
    "--by",
    "moves",
    nargs=4,
    type=(str, float, float, float),
    multiple=True,
    metavar="SITE X Y Z",
    help="A site by so many metres from where it is. Repeatable.",
)
@click.option(
    "--morph",
    "morphs",
    nargs=2,
    type=(str, float),
    multiple=True,
    metavar="NAME WEIGHT",
    help='A shape of the face, such as "\'AU12", or of a finger, such as "\'index_bend s". '
    "Repeatable.",
)
@click.option(
    "--apply",
    "chosen",
    is_flag=False,
    flag_value=1,
    type=click.IntRange(min=1),
    metavar="[N]",
    help="Write the Nth proposal into FILE, the first unless said.",
)
@click.option("--utterance", metavar="N", type=click.IntRange(min=1), help="Only FILE's Nth.")
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json"]),
    default="text",
    help="json: one object on standard output.",
)
@click.option("--rig", metavar="R", default="signer", show_default=True, help="The body.")
@library_option
@dominant_option
@click.option("--quiet", is_flag=True, help="Do not tell what was written.")
def pose(
    file: str,
    at_s: float,
    drags: Sequence[tuple[str, float, float, float]],
    moves: Sequence[tuple[str, float, float, float]],
    morphs: Sequence[tuple[str, float]],
    chosen: int | None,
    utterance: int | None,
    form: str,
    rig: str,
    libraries: Sequence[Path],
    dominant: Hand,
    quiet: bool,
) -> int:
    """Compile FILE, drag parts of the body at one instant, and print what could be written for it.

    Each proposal says what it writes, where, and what it fixes, the best first. With --apply one of
    them is written into FILE: one change, in the canonical layout.

    Exit codes: 0 done, 1 mistakes or nothing that can be done, 2 wrong use.
    """
    from azee.posing.handle import checked_target
    from azee.posing.session import PosingSession

    if not (drags or moves or morphs):
        raise click.UsageError("say what to drag: --drag, --by or --morph")
    if chosen is not None and file == "-":
        raise click.UsageError("--apply writes into FILE, and standard input is none")
    for part, *target in (*drags, *moves):
        checked_target(part, target, weight=False)
    for name, weight in morphs:
        checked_target(name, (weight,), weight=True)
    body = load_body(rig)
    with working("Solving …"):
        session = PosingSession.open(
            Path(file), at_s, body, utterance=utterance, libraries=libraries, dominant=dominant
        )
        frames = _dragged(session, drags, moves, morphs)
        proposals = session.proposals()
    if form == "json":
        found = [proposal.as_json() for proposal in proposals]
        show_json({"frames": [_frame_json(frame) for frame in frames], "proposals": found})
    else:
        _print(frames, proposals)
    if chosen is not None:
        _apply(file, proposals, chosen, quiet=quiet)
    return DONE


def _dragged(
    session: PosingSession,
    drags: Sequence[tuple[str, float, float, float]],
    moves: Sequence[tuple[str, float, float, float]],
    morphs: Sequence[tuple[str, float]],
) -> list[Frame]:
    """Drag all, each on its way in steps as a hand would, and let go."""
    for part, *target in drags:
        session.drag_along(part, target)
    for part, *offset in moves:
        session.drag_along(part, session.beside(part, offset))
    for name, weight in morphs:
        session.drag(name, (weight,))
    return session.drop()


def _frame_json(frame: Frame) -> dict[str, Any]:
    data = frame.as_json()
    del data["rotations"], data["weights"], data["solve_ms"]
    return data


def _print(frames: Sequence[Frame], proposals: Sequence[Proposal]) -> None:
    for frame in frames:
        if frame.summary:
            click.echo(f"{frame.handle}: {frame.summary}")
    if not proposals:
        click.echo("nothing that could be written: a rule of a library decides it")
    for n, proposal in enumerate(proposals[:SHOWN], 1):
        click.echo(f"{n}  {proposal.written}")
        click.echo(f"   {proposal.where}; {proposal.fixes}{proposal.off_text}")


def _apply(file: str, proposals: Sequence[Proposal], chosen: int, *, quiet: bool) -> None:
    from azee.export.files import replace_file
    from azee.posing.fault import cannot_pose
    from azee_grammar.diagnostic import AZeeError

    if chosen > len(proposals):
        raise AZeeError(cannot_pose(f"there is no proposal {chosen}; there are {len(proposals)}"))
    proposal = proposals[chosen - 1]
    with writing(file), replace_file(file) as output:
        output.write(proposal.document.text.encode())
    news(f"wrote {proposal.written}", quiet=quiet)
