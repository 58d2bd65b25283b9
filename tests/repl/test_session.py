"""What a session knows: rules typed and loaded, results, libraries, and files that change."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from azee.lang.program import Program
from azee.repl.session import Defined, Evaluated, Failed, Outcome, Session, Used


def entered(session: Session, text: str) -> Outcome:
    (outcome,) = session.enter(text)
    return outcome


def number(session: Session, text: str) -> object:
    outcome = entered(session, text)
    assert isinstance(outcome, Evaluated), outcome
    return outcome.value.content


def codes(outcome: Outcome) -> list[str]:
    assert isinstance(outcome, Failed), outcome
    return [d.code for d in outcome.diagnostics]


def write(path: Path, text: str) -> None:
    """Write a file so that its time differs from before, however coarse the clock is."""
    before = path.stat().st_mtime_ns if path.exists() else 0
    path.write_text(text, encoding="utf-8")
    os.utime(path, ns=(before + 10**9, before + 10**9))


def test_rules_that_are_typed_are_known_from_then_on_and_may_be_typed_again() -> None:
    session = Session()
    assert entered(session, "def n\n    1") == Defined("n", again=False, mistakes=())
    assert number(session, "n()") == 1
    assert entered(session, "def n\n    2") == Defined("n", again=True, mistakes=())
    assert number(session, "n()") == 2


def test_a_rule_with_a_mistake_is_told_and_hurts_only_who_uses_it() -> None:
    session = Session()
    bad = entered(session, "def bad\n    :not-there")
    assert isinstance(bad, Defined)
    assert [d.code for d in bad.mistakes] == ["unknown-rule"]
    assert number(session, "add 1 1") == 2
    assert codes(entered(session, "bad()")) == ["unknown-rule"]
    entered(session, "def not-there\n    3")
    assert number(session, "bad()") == 3


def test_a_text_with_a_syntax_error_changes_nothing() -> None:
    session = Session()
    entered(session, "def n\n    1")
    assert codes(entered(session, "def n\n    )")) == ["syntax"]
    assert number(session, "n()") == 1


def test_the_last_result_has_a_name() -> None:
    session = Session()
    assert codes(entered(session, "add ^_ 1")) == ["unknown-name"]
    assert number(session, "add 1 1") == 2
    assert number(session, "add ^_ ^_") == 4
    entered(session, ":nobody")
    assert number(session, "^_") == 4


def test_pasted_text_may_be_indented_as_a_whole() -> None:
    assert number(Session(), "    add 1\n        2") == 3


def test_libraries_are_added_to_what_is_in_scope(tmp_path: Path) -> None:
    write(tmp_path / "mine.azee", "def n\n    7\n")
    session = Session([tmp_path])
    assert codes(entered(session, ":n")) == ["unknown-rule"]
    assert entered(session, "use 'mine") == Used("mine")
    assert number(session, "n()") == 7
    assert isinstance(entered(session, ":arbre"), Evaluated)
    assert codes(entered(session, "use 'theirs")) == ["library-not-found"]
    assert number(session, "n()") == 7


def test_a_changed_file_counts_at_once_and_a_broken_one_not_until_it_is_mended(
    tmp_path: Path,
) -> None:
    file, library = tmp_path / "loaded.azee", tmp_path / "lib" / "mine.azee"
    library.parent.mkdir()
    write(library, "def n\n    1\n")
    write(file, "use 'mine\ndef m\n    add n() 10\n")
    session = Session([library.parent])
    assert session.load(file) == ()
    assert number(session, "m()") == 11
    assert session.refresh() is None

    write(library, "def n\n    2\n")
    reloaded = session.refresh()
    assert reloaded is not None
    assert (reloaded.paths, reloaded.mistakes) == ((library,), ())
    assert number(session, "m()") == 12

    write(file, "use 'mine\ndef m\n    add n(\n")
    broken = session.refresh()
    assert broken is not None
    assert [d.code for d in broken.mistakes] == ["unclosed-paren"]
    assert session.refresh() is None, "what is wrong is told once"
    entered(session, "def k\n    add m() 100")
    assert number(session, "k()") == 112, "the version before stays, also for new rules"

    write(file, "use 'mine\ndef m\n    add n() 20\n")
    assert session.refresh() is not None
    assert number(session, "k()") == 122

    file.unlink()
    gone = session.refresh()
    assert gone is not None
    assert [d.code for d in gone.mistakes] == ["cannot-read"]
    assert number(session, "k()") == 122


def test_an_interruption_leaves_the_session_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    session = Session()
    entered(session, "def n\n    1")

    def interrupted(*_: object) -> Iterator[Outcome]:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(Program, "result", interrupted)
        with pytest.raises(KeyboardInterrupt):
            list(session.enter("n()"))
    assert number(session, "n()") == 1
