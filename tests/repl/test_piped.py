"""`azee repl` reading from a pipe: results printed, no terminal, an exit code for scripts."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

AZEE = (sys.executable, "-m", "azee", "repl")


def piped(text: str, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*AZEE, *arguments], input=text, cwd=folder, capture_output=True, encoding="utf-8",
        check=False, timeout=60,
    )  # fmt: skip


@pytest.mark.long
def test_items_are_read_as_in_a_file(tmp_path: Path) -> None:
    text = "# one\nadd 1\n\n    2\ndef four\n    mul(\n2,\n  2)\nfour()\n\n/doc @CH\n"
    done = piped(text, tmp_path)
    assert (
        done.stdout
        == "3  a number\ndefined :four\n4  a number\n@CH [SIDE]  site\n  Chin\n  bone      !head\n"
    )
    assert (done.stderr, done.returncode) == ("", 0)


def test_an_error_is_rendered_as_check_does_and_the_rest_is_read(tmp_path: Path) -> None:
    done = piped("look 1\nadd 1 1\n/nonsense\n", tmp_path)
    assert done.stdout == "2  a number\n"
    assert done.returncode == 1
    assert "error[wrong-type]" in done.stderr
    assert " --> <input 1>:1:6" in done.stderr
    assert "no command /nonsense" in done.stderr


def test_whoever_stops_reading_is_left_in_peace(tmp_path: Path) -> None:
    """A broken pipe ends the session without a word."""
    process = subprocess.Popen(
        AZEE, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path
    )
    assert process.stdin is not None
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdin.write(b"add 1 1\nadd 2 2\n")
    process.stdin.flush()
    assert process.stdout.readline() == b"2  a number\n"
    process.stdout.close()
    process.stdin.write(b":arbre\n" * 200)
    process.stdin.close()
    assert process.wait(timeout=60) == 1
    with process.stderr as wrong:
        assert wrong.read() == b""


@pytest.mark.parametrize("text", ["", "\n\n# nothing\n", "/quit\nthis is not read\n"])
def test_nothing_to_do_is_no_error(text: str, tmp_path: Path) -> None:
    done = piped(text, tmp_path)
    assert (done.stdout, done.stderr, done.returncode) == ("", "", 0)
