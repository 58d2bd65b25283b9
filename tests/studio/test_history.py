"""What was typed is there again, whoever was killed."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from azee.studio import history
from azee.studio.history import EVERY_S, History

KILLED = """
import sys
from pathlib import Path
from azee.studio.history import History
kept = History(Path(sys.argv[1]))
for i in range(10_000):
    kept.keep("a.azee", f"text {i}", "digest", float(i))
    print(i, flush=True)
"""


@pytest.fixture
def kept(tmp_path: Path) -> Iterator[History]:
    with closing(History(tmp_path / "new" / "kept.sqlite")) as history_of_a_folder:
        yield history_of_a_folder


def test_a_draft_is_there_until_it_is_saved_or_dropped(kept: History) -> None:
    kept.keep("a.azee", "one", "d", 1.0)
    kept.keep("a.azee", "two", None, 2.0)
    kept.keep("b.azee", "other", None, 2.0)
    draft = kept.draft("a.azee")
    assert draft is not None
    assert (draft.text, draft.digest, draft.at) == ("two", None, 2.0)
    assert kept.drafts() == ["a.azee", "b.azee"]
    kept.saved("a.azee", "two", 3.0)
    kept.drop("b.azee")
    assert (kept.draft("a.azee"), kept.draft("b.azee"), kept.drafts()) == (None, None, [])


def test_versions_are_what_was_saved_and_what_was_typed_once_a_minute(tmp_path: Path) -> None:
    with closing(History(tmp_path / "kept.sqlite")) as kept:
        for second in range(2 * EVERY_S + 1):
            kept.keep("a.azee", f"text {second}", None, float(second))
        kept.saved("a.azee", "saved", 200.0)
    with closing(History(tmp_path / "kept.sqlite")) as again:
        found = again.versions("a.azee")
        assert [(v.at, v.saved) for v in found] == [
            (200.0, True), (2.0 * EVERY_S, False), (float(EVERY_S), False), (0.0, False)
        ]  # fmt: skip
        assert again.version("a.azee", found[1].number) == f"text {2 * EVERY_S}"
        assert again.version("b.azee", found[1].number) is None
        assert again.version("a.azee", 10**15) is None


def test_old_versions_go(kept: History, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history, "MOST_VERSIONS", 3)
    for i in range(6):
        kept.saved("a.azee", f"{i}", float(i))
        kept.saved("b.azee", f"{i}", float(i))
    assert [v.at for v in kept.versions("a.azee")] == [5.0, 4.0, 3.0]
    assert len(kept.versions("b.azee")) == 3


def test_what_was_acknowledged_survives_kill_9(tmp_path: Path) -> None:
    path = tmp_path / "kept.sqlite"
    with subprocess.Popen(
        [sys.executable, "-c", KILLED, str(path)], stdout=subprocess.PIPE, text=True
    ) as writer:
        assert writer.stdout is not None
        for _ in range(50):
            writer.stdout.readline()
        writer.send_signal(signal.SIGKILL)
        told = writer.stdout.read().split()
    with closing(History(path)) as kept:
        draft = kept.draft("a.azee")
    assert draft is not None
    assert int(draft.text.split()[1]) >= int(told[-1] if told else 49)


def test_another_file_is_no_history(tmp_path: Path) -> None:
    (tmp_path / "kept.sqlite").write_text("this is a text, and long enough to be looked at" * 40)
    with pytest.raises(OSError, match="database"):
        History(tmp_path / "kept.sqlite")
