"""The commands of the prompt: lines that begin with `/` and a letter.

No operator of AZee begins with `/`. A rule whose name does is applied as `:/name`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from azee.formats import SCORE_WRITERS, WRITERS, save_score
from azee.repl.ink import Ink, Line
from azee.repl.performer import required
from azee.repl.refusal import Refusal
from azee.repl.repl import Quit, Repl
from azee.repl.residuals import table
from azee.repl.rule_lists import described, listed

if TYPE_CHECKING:
    from azee.score.score import Score

_COMMAND = re.compile(r"\s*/([A-Za-z]+)(?:\s+(.*?))?\s*\Z", re.S)


@dataclass(frozen=True, slots=True)
class Command:
    """A command: its notation, its effect, and its function."""

    pattern: str
    meaning: str
    run: Callable[[Repl, str], None]


def is_command(text: str) -> bool:
    """Whether a text is a command for `carry_out`."""
    start = text.lstrip()
    return len(start) > 1 and start[0] == "/" and start[1].isalpha()


def answer(repl: Repl, text: str) -> bool:
    """Carry out a command or evaluate AZee; return whether the input had no mistake.

    Raises: Quit: the user ended the session.
    """
    if is_command(text):
        return repl.attempt(lambda: carry_out(repl, text))
    return repl.attempt(lambda: repl.evaluate(text))


def carry_out(repl: Repl, text: str) -> bool:
    """Carry out a command, and return True.

    Raises: Refusal: the command is impossible. AZeeError: the input or a file is at fault. Quit.
    """
    found = _COMMAND.match(text)
    name = found[1] if found else text.split()[0][1:]
    command = COMMANDS.get(name)
    if command is None or found is None:
        near = [f"/{known}" for known in COMMANDS if known.startswith(name[:2])]
        hint = f"did you mean {' or '.join(near)}?" if near else "/help lists all commands"
        raise Refusal(f"there is no command /{name}", hint)
    command.run(repl, found[2] or "")
    return True


def _help(repl: Repl, argument: str) -> None:
    wanted = argument.removeprefix("/")
    if wanted and wanted not in COMMANDS:
        raise Refusal(f"there is no command /{wanted}", "/help lists all commands")
    shown = [COMMANDS[wanted]] if wanted else list(COMMANDS.values())
    wide = max(len(command.pattern) for command in shown) + 2
    lines: list[Line] = [
        ((Ink.NAME, f"  {command.pattern:<{wide}}"), (Ink.PLAIN, command.meaning))
        for command in shown
    ]
    repl.screen.show([*lines, *(() if wanted else _HINTS)])


_HINTS: tuple[Line, ...] = (
    (),
    (
        (
            Ink.PLAIN,
            "Anything else is AZee: an expression, `def name` with a body below, `use 'lib`.",
        ),
    ),
    (
        (
            Ink.PLAIN,
            "^_ is the last result. Tab completes. An empty line ends what has lines below.",
        ),
    ),
)


def _rules(repl: Repl, argument: str) -> None:
    lines = list(listed(repl.session.knowledge, argument, repl.screen.columns))
    if not lines:
        raise Refusal(f"no rule speaks of `{argument}`")
    repl.screen.show(lines)


def _doc(repl: Repl, argument: str) -> None:
    if not argument:
        raise Refusal("which name?", "/doc :info-about, /doc @I_TIP, /doc place …")
    repl.screen.show(described(repl.session.knowledge, argument, repl.screen.columns))


def _load(repl: Repl, argument: str) -> None:
    path = Path(_needed(argument, "/load FILE.azee")).expanduser()
    mistakes = repl.session.load(path)
    repl.screen.complain(mistakes)
    count = len(repl.session.program.scope.own.rules)
    repl.screen.say(f"loaded {path.name}: {count} rules are known here beside the libraries'")


def _reload(repl: Repl, argument: str) -> None:
    reloaded = repl.session.reload()
    repl.tell(reloaded)
    if not reloaded.paths and not reloaded.mistakes:
        repl.screen.say("nothing has changed")


def _score(repl: Repl, argument: str) -> None:
    from azee.export.score_text import tree

    score = _last_score(repl)
    if not argument:
        repl.screen.put(tree(score))
        return
    path = _output(argument, SCORE_WRITERS)
    save_score(score, path)
    repl.screen.say(f"wrote {path}")


def _solve(repl: Repl, argument: str) -> None:
    if argument in ("on", "off"):
        repl.solving = argument == "on"
        when = "at once" if repl.solving else "when /solve, /render or /save ask for it"
        repl.screen.say(f"scores are solved {when}")
        return
    if argument:
        raise Refusal(f"/solve knows no `{argument}`", "/solve, /solve on, /solve off")
    made = repl.performer.perform(_last_score(repl))
    repl.screen.show(table(made.report, repl.screen.columns))
    repl.solved()


def _render(repl: Repl, argument: str) -> None:
    from azee.repl.posture import Wish, drawn

    wish = Wish.read(argument)
    made = repl.performer.perform(_last_score(repl))
    if wish.path is None and not repl.screen.colour:
        raise Refusal("this terminal shows no pictures", "/render FILE.png writes one")
    text = drawn(made, wish, repl.screen.columns, repl.screen.rows)
    if wish.path is None:
        repl.screen.put(text)
    repl.screen.say(f"wrote {wish.path}" if wish.path else f"{wish.at(made):.2f} s")


def _save(repl: Repl, argument: str) -> None:
    from azee.repl.saved import save_text

    path = _output(argument, (".azee", *WRITERS))
    if path.suffix == ".azee":
        save_text(repl.session, path)
    else:
        repl.performer.perform(_last_score(repl)).save(path)
    repl.screen.say(f"wrote {path}")


def _time(repl: Repl, argument: str) -> None:
    session = repl.session
    if argument:
        repl.screen.complain(
            d for o in session.enter(argument) for d in getattr(o, "diagnostics", ())
        )
    if session.last is None:
        raise Refusal("there is no result yet", "/time EXPRESSION")
    lines: list[Line] = [((Ink.PLAIN, f"evaluated in {session.last.evaluate_s * 1000:.1f} ms"),)]
    try:
        score = _last_score(repl)
    except Refusal:
        repl.screen.show(lines)
        return
    report = repl.performer.perform(score).report
    took_s = repl.performer.took_s
    more = f"postures {report.solve_s:.3f} s, reasons {report.explain_s:.3f} s"
    lines.append(((Ink.PLAIN, f"solved in {took_s:.3f} s, of this {more}"),))
    lines.append(((Ink.PLAIN, f"{report.evaluations} evaluations of objectives"),))
    repl.screen.show(lines)


def _rig(repl: Repl, argument: str) -> None:
    if argument:
        repl.performer.change(rig_name=argument)
    rig = repl.performer.rig
    free = len(rig.coordinates.names)
    repl.screen.say(
        f"{rig.name}: {len(rig.bones)} bones, {len(rig.sites)} sites, {free} coordinates"
    )


def _hand(repl: Repl, argument: str) -> None:
    match argument:
        case "left" | "right":
            repl.performer.change(hand=argument)
        case "":
            pass
        case _:
            raise Refusal(f"`{argument}` is no hand", "/hand left or /hand right")
    repl.screen.say(f"the strong hand is the {repl.performer.hand} one")


def _quit(repl: Repl, argument: str) -> None:
    raise Quit


def _last_score(repl: Repl) -> Score:
    if repl.session.last is None:
        raise Refusal("there is no result yet", "an expression gives one, such as :arbre")
    return required(repl.session.last.value)


def _needed(argument: str, pattern: str) -> str:
    if not argument:
        raise Refusal("which file?", pattern)
    return argument


def _output(argument: str, suffixes: Collection[str]) -> Path:
    """Return the path of a file to write. Raises: Refusal: its suffix names no format."""
    path = Path(_needed(argument, f"its suffix is the format: {' '.join(suffixes)}")).expanduser()
    if path.suffix.lower() not in suffixes:
        raise Refusal(f"`{path}`: the suffix is the format: {' '.join(suffixes)}")
    return path


def names() -> Iterator[tuple[str, str]]:
    """Yield the commands with their meanings, for completion."""
    for name, command in COMMANDS.items():
        yield f"/{name}", command.meaning


COMMANDS: Mapping[str, Command] = {
    "help": Command("/help [COMMAND]", "what commands there are", _help),
    "rules": Command(
        "/rules [WORDS]", "the rules in scope; those that speak of some words", _rules
    ),
    "doc": Command("/doc NAME", "what a rule, operator, bone, site, morph or constant means", _doc),
    "score": Command(
        f"/score [FILE{'|'.join(SCORE_WRITERS)}]",
        "the last score with its constraints; or drawn, or for ELAN",
        _score,
    ),
    "solve": Command(
        "/solve [on|off]", "how well each constraint is met; on: after every score", _solve
    ),
    "render": Command(
        "/render [FILE.png] [SECONDS] [VIEW]", "the posture at a time, here or in a file", _render
    ),
    "save": Command(
        "/save FILE",
        f"what was typed as .azee; the last score as {' '.join(WRITERS)}",
        _save,
    ),
    "time": Command("/time [EXPRESSION]", "how long evaluating and solving take", _time),
    "load": Command(
        "/load FILE.azee", "take in the rules of a file, now and when it changes", _load
    ),
    "reload": Command("/reload", "read all rule files again", _reload),
    "rig": Command("/rig [NAME]", "the body that plays", _rig),
    "hand": Command("/hand [left|right]", "the signer's strong hand", _hand),
    "quit": Command("/quit", "leave; so does Ctrl-D", _quit),
}
