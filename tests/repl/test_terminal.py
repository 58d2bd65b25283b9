"""The prompt as its user meets it, in a pseudo-terminal."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest

if sys.platform == "win32":
    pytest.skip("pseudo-terminals are POSIX", allow_module_level=True)

from terminal import Terminal

RULE = 'def wag\n    \'meaning "a tail, wagging"\n    key {length} (look ^fwd)\n'


@pytest.mark.slow
def test_a_session(tmp_path: Path) -> None:
    """Completion, a score, an error, an interrupted solve, an edited rule, and the end."""
    rules = tmp_path / "mine.azee"
    rules.write_text(RULE.format(length=0.5), encoding="utf-8")
    history = tmp_path / "state" / "history"
    with Terminal(tmp_path, str(rules), AZEE_HISTORY=str(history)) as terminal:
        terminal.wait("azee>")

        terminal.type(":info-ab")
        terminal.wait("info, said about topic")  # the menu shows what the rule means
        terminal.press("tab")
        terminal.wait("azee> :info-about")
        terminal.press("enter")  # takes what was completed
        terminal.press("enter")
        terminal.wait(lambda text: "'topic" in text.splitlines()[-1])  # what is applied
        terminal.type("'in")
        terminal.wait("'info  ")
        terminal.press("tab")
        terminal.type(" :bien\n'to")
        terminal.wait("'topic  ")
        terminal.press("tab")
        terminal.type(" :arbre\n\n")
        terminal.wait("TOPIC · arbre")
        terminal.wait("solved in")
        assert "'info :bien" in terminal.text
        assert "a score of" in terminal.text
        assert terminal.coloured

        terminal.type(":wagg\n")
        terminal.wait("error[unknown-rule]")
        terminal.wait("did you mean `:wag`")

        terminal.type("seq (map (azop 'n 'nodefault :info-about(:arbre, :bien)) (range 1 600))\n")
        terminal.wait("4800 blocks")
        time.sleep(0.5)
        terminal.press("ctrl-c")
        assert terminal.wait("interrupted") < 3
        terminal.type("add 20 3\n")
        terminal.wait("23  a number")

        terminal.type(":wag\n")
        terminal.wait("a score of 0.5 s")
        rules.write_text(RULE.format(length=0.75), encoding="utf-8")
        terminal.type(":wag\n")
        terminal.wait("a score of 0.75 s")
        assert "reloaded mine.azee" in terminal.text

        terminal.type("add\n1\n\n")
        terminal.wait("error[missing-argument]")
        terminal.press("up")
        terminal.type("\n41\n\n")  # an earlier input goes on where it ended
        terminal.wait("42  a number")

        terminal.press("ctrl-d")
        assert terminal.ended() == 0
    assert "+:wagg" in history.read_text(encoding="utf-8")


@pytest.mark.slow
def test_without_colours_history_and_line_editing(tmp_path: Path) -> None:
    with Terminal(tmp_path, "--plain", "--no-solve", NO_COLOR="1") as terminal:
        terminal.wait("azee>")
        terminal.type("key .5\n    look ^fwd\n\n")
        terminal.wait("├key─")
        terminal.type("def x\n    :chat\n\n")
        terminal.wait("defined :x")
        terminal.press("ctrl-c")
        terminal.wait("/quit leaves")
        assert not terminal.coloured
        terminal.type("/quit\n")
        assert terminal.ended() == 0
