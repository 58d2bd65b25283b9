"""`azee fmt` lays texts out, and touches nothing that it need not touch."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from programs import Python

from azee.cli.main import run

CROOKED = "key\n  1\n  look  ^fwd   # ahead\n"
STRAIGHT = "key 1\n    look ^fwd  # ahead\n"
PUBLISHED = "key\n    1\n    look\n        ^fwd  # ahead\n"


@pytest.fixture(autouse=True)
def _in_a_folder_with_texts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write("crooked.azee", CROOKED)
    write("straight.azee", STRAIGHT)


def write(name: str, text: str) -> None:
    Path(name).write_bytes(text.encode("utf-8"))


def read(name: str) -> str:
    return Path(name).read_bytes().decode("utf-8")


def test_a_file_is_laid_out_anew(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["fmt", "crooked.azee"]) == 0
    assert read("crooked.azee") == STRAIGHT
    captured = capsys.readouterr()
    assert (captured.out, captured.err) == ("", "formatted crooked.azee\n")


def test_what_is_in_form_is_not_touched(capsys: pytest.CaptureFixture[str]) -> None:
    Path("straight.azee").chmod(0o444)
    os.utime("straight.azee", ns=(1, 1))
    before = Path("straight.azee").stat()
    assert run(["fmt", "straight.azee"]) == 0
    after = Path("straight.azee").stat()
    assert (after.st_mtime_ns, after.st_ino) == (before.st_mtime_ns, before.st_ino)
    assert capsys.readouterr().err == ""


def test_quiet_says_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["fmt", "--quiet", "crooked.azee"]) == 0
    assert capsys.readouterr().err == ""
    assert read("crooked.azee") == STRAIGHT


def test_check_lists_and_changes_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["fmt", "--check", "crooked.azee", "straight.azee"]) == 1
    assert capsys.readouterr().out == "crooked.azee\n"
    assert read("crooked.azee") == CROOKED
    assert run(["fmt", "--check", "straight.azee"]) == 0
    assert capsys.readouterr().out == ""


def test_published_form_has_a_token_a_line() -> None:
    assert run(["fmt", "--published", "crooked.azee"]) == 0
    assert read("crooked.azee") == PUBLISHED
    assert run(["fmt", "crooked.azee"]) == 0
    assert run(["fmt", "--published", "--check", "crooked.azee"]) == 1


def test_a_file_with_mistakes_is_left_alone_and_the_others_are_not(
    capsys: pytest.CaptureFixture[str],
) -> None:
    faulty = "key  1 (look ^fwd\n"
    write("faulty.azee", faulty)
    assert run(["fmt", "faulty.azee", "missing.azee", "crooked.azee"]) == 1
    captured = capsys.readouterr()
    assert "error[unclosed-paren]" in captured.err
    assert "--> faulty.azee:1:8" in captured.err
    assert "error[cannot-read]" in captured.err
    assert read("faulty.azee") == faulty
    assert read("crooked.azee") == STRAIGHT
    names = sorted(path.name for path in Path().iterdir())
    assert names == ["crooked.azee", "faulty.azee", "straight.azee"]


def test_it_needs_no_rules() -> None:
    write("unknown.azee", ":nobody  'a  :knows\n")
    assert run(["fmt", "unknown.azee"]) == 0
    assert read("unknown.azee") == ":nobody 'a :knows\n"


def test_a_file_that_cannot_be_written_is_one_message(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("azee.export.files.tempfile.mkstemp", full)
    assert run(["fmt", "crooked.azee"]) == 1
    assert "error[cannot-write]: cannot write `crooked.azee`: no space" in capsys.readouterr().err
    assert read("crooked.azee") == CROOKED


@pytest.mark.long
def test_standard_input_to_standard_output(python: Python) -> None:
    for text in (CROOKED, STRAIGHT):
        done = python("-m", "azee", "fmt", "-", stdin=text, expect=0)
        assert (done.stdout, done.stderr) == (STRAIGHT, "")
    done = python("-m", "azee", "fmt", "--check", "-", stdin=CROOKED, expect=1)
    assert done.stdout == "<stdin>\n"
    done = python("-m", "azee", "fmt", "-", stdin="key (", expect=1)
    assert done.stdout == ""
    assert "<stdin>:1:5" in done.stderr
