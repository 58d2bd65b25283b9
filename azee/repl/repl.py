"""The loop of the prompt: evaluates, shows and solves inputs, and carries out commands."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Sequence
from pathlib import Path

from azee.repl.ink import Ink
from azee.repl.performer import Performer, playable
from azee.repl.refusal import Refusal
from azee.repl.residuals import summary
from azee.repl.screen import Screen
from azee.repl.session import Defined, Evaluated, Failed, Outcome, Reloaded, Session, Used
from azee.repl.value_text import value_lines
from azee_grammar.diagnostic import AZeeError, Severity

PATIENCE_S = 1.5
"""After this time, a message explains why an answer takes longer."""


class Quit(Exception):  # noqa: N818 - the user wants to
    """The session ends."""


class Repl:
    """A session, a body and a screen.

    interactive: whether a user waits at a prompt, where Ctrl-C only interrupts what is running.
    solving: whether every score is solved at once and the outcome printed.
    """

    def __init__(
        self,
        session: Session,
        performer: Performer,
        screen: Screen,
        *,
        interactive: bool,
        solving: bool,
    ) -> None:
        self.session, self.performer, self.screen = session, performer, screen
        self.interactive, self.solving = interactive, solving

    def evaluate(self, text: str) -> bool:
        """Evaluate an input and show its value; return whether it had no mistake.

        Raises: AZeeError: the text is at fault.
        """
        self.refresh()
        right = True
        for outcome in self.session.enter(text):
            right = self._shown(outcome) and right
        return right

    def attempt(self, action: Callable[[], bool]) -> bool:
        """Call a function and report its errors; return whether there was none.

        Raises: Quit: the user ended the session.
        """
        try:
            return action()
        except AZeeError as error:
            self.screen.complain(error.diagnostics)
        except Refusal as refusal:
            self.screen.refuse(refusal.message, refusal.hint)
        except KeyboardInterrupt:
            if not self.interactive:
                raise
            self.screen.say("interrupted", Ink.WARNING)
        except Quit:
            raise
        except Exception:
            if not self.interactive:
                raise
            self.screen.put_wrong(traceback.format_exc())
            self.screen.say("that is a fault of azee, not yours; the session goes on", Ink.WARNING)
        return False

    def load(self, paths: Sequence[Path]) -> bool:
        """Load files; return whether none has a mistake."""
        right = True
        for path in paths:
            try:
                mistakes = self.session.load(path)
            except AZeeError as error:
                self.screen.complain(error.diagnostics)
                right = False
                continue
            self.screen.complain(mistakes)
            right = right and not mistakes
        return right

    def refresh(self) -> None:
        """Read changed files before evaluation."""
        if (reloaded := self.session.refresh()) is not None:
            self.tell(reloaded)

    def tell(self, reloaded: Reloaded) -> None:
        """Report the result of reading files again."""
        names = ", ".join(path.name for path in reloaded.paths)
        if reloaded.mistakes:
            self.screen.complain(reloaded.mistakes)
            if names:
                self.screen.say(f"{names}: the version before stays in use", Ink.WARNING)
        elif names:
            self.screen.say(f"reloaded {names}")

    def solved(self) -> None:
        """Solve the last result and report the outcome."""
        score = playable(self.session.last.value) if self.session.last else None
        if score is None:
            return
        if not self.performer.ready(PATIENCE_S):
            self.screen.say("getting the solver ready: the first time takes longer …")
        made = self.performer.perform(score)
        self.screen.show(summary(made.report, self.performer.took_s))

    def _shown(self, outcome: Outcome) -> bool:
        screen = self.screen
        match outcome:
            case Failed(diagnostics=diagnostics):
                screen.complain(diagnostics)
                return not any(d.severity is Severity.ERROR for d in diagnostics)
            case Used(name=name):
                screen.say(f"using '{name}")
            case Defined(name=name, again=again, mistakes=mistakes):
                screen.complain(mistakes)
                done = f"{'redefined' if again else 'defined'} :{name}"
                if mistakes:
                    count = "a mistake" if len(mistakes) == 1 else f"{len(mistakes)} mistakes"
                    screen.say(f"{done}, with {count}", Ink.WARNING)
                    return False
                screen.say(done)
            case Evaluated(value=value):
                screen.show(value_lines(value, screen.columns, colour=screen.colour))
                if self.solving:
                    self.solved()
        return True
