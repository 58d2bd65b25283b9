"""Bad input gets one clear message and the right exit code: no traceback, nothing left behind."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from programs import Python

from azee.cli.main import run
from azee.cli.number import Seconds

SYNC_CYCLE = """\
sync
    'A
    key 1 (look ^fwd)
    'B
    key 1 (look ^fwd)
    'start/end
    'C:start
    'C:end
    'C
    key 1 (look ^fwd)
    'start/end
    'B:start
    'B:end
"""
PAIR = """\
def pair
    azop
        'first
        'nodefault
        ^first
:pair
"""
TEXTS = {
    "unknown rule": (":wardrob", "unknown-rule"),
    "missing argument": (PAIR, "missing-argument"),
    "wrong type": ("key ^up (look ^fwd)", "wrong-type"),
    "unknown site": ("key 1 (place @CHIN_TIP ^Mssp)", "unknown-site"),
    "cyclic sync": (SYNC_CYCLE, "cyclic-sync"),
    "mixed tabs": ("key 1\n    cstr\n\t    look ^fwd\n", "tab-space-mix"),
    "unclosed parenthesis": ("key 1 (look ^fwd", "unclosed-paren"),
}
"""A text, and the code of what is wrong with it."""


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def _files() -> list[str]:
    return sorted(path.name for path in Path().iterdir())


def _told(capsys: pytest.CaptureFixture[str], code: str) -> str:
    """Return the one message, which must have this code and a first line of the user's words."""
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "Traceback" not in captured.err
    found = re.findall(r"^error\[([\w-]+)\]: .", captured.err, re.M)
    assert found == [code], captured.err
    return captured.err


@pytest.mark.parametrize("case", TEXTS)
@pytest.mark.parametrize("command", ["compile", "score", "check"])
def test_a_faulty_text(case: str, command: str, capsys: pytest.CaptureFixture[str]) -> None:
    text, code = TEXTS[case]
    Path("faulty.azee").write_text(text, encoding="utf-8")
    output = {"compile": ["-o", "x.glb"], "score": ["-o", "x.svg"], "check": ["--quiet"]}[command]
    assert run([command, "faulty.azee", *output]) == 1
    message = _told(capsys, code)
    assert "--> faulty.azee:" in message
    assert "^" in message
    assert _files() == ["faulty.azee"]


@pytest.mark.parametrize("command", ["compile", "score", "check"])
def test_what_cannot_be_read(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("folder").mkdir()
    Path("latin.azee").write_bytes(":âge".encode("latin-1"))
    Path("utf16.azee").write_bytes(":âge".encode("utf-16"))
    cases = {
        "missing.azee": "cannot-read",
        "folder": "cannot-read",
        "latin.azee": "not-utf8",
        "utf16.azee": "not-utf8",
    }
    for name, code in cases.items():
        assert run([command, name, *(["--quiet"] if command == "check" else [])]) == 1
        assert name in _told(capsys, code)


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="root may read everything")
def test_an_unreadable_file(capsys: pytest.CaptureFixture[str]) -> None:
    Path("secret.azee").write_text(":arbre")
    Path("secret.azee").chmod(0)
    assert run(["score", "secret.azee"]) == 1
    assert "permission" in _told(capsys, "cannot-read")


@pytest.mark.parametrize("text", ["", "\n\n", "# only a comment\n", "\ufeff"])
def test_an_empty_text_has_no_utterance(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("empty.azee").write_text(text, encoding="utf-8")
    assert run(["check", "--quiet", "empty.azee"]) == 0
    assert run(["compile", "empty.azee", "-o", "x.glb"]) == 1
    assert "empty.azee" in _told(capsys, "no-utterance")
    assert _files() == ["empty.azee"]


def test_more_frames_than_a_machine_holds(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["compile", "-e", "blank 86400", "-o", "day.json"]) == 1
    assert "error[clip-times]: 86400 s at 30 frames a second" in capsys.readouterr().err
    assert not Path("day.json").exists()


def test_an_utterance_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    Path("one.azee").write_text("key 1 (look ^fwd)")
    assert run(["score", "one.azee", "--utterance", "2"]) == 1
    _told(capsys, "no-utterance")


def test_outputs_that_cannot_be_written_are_refused_before_any_work(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("folder.glb").mkdir()
    Path("file").write_text("")
    Path("one.azee").write_text("key 1 (look ^fwd)")
    before = _files()
    for output, words in {
        "folder.glb": "is a directory",
        "missing/x.glb": "no folder",
        "file/x.glb": "not a directory",
    }.items():
        assert run(["compile", "one.azee", "-o", "fine.bvh", "-o", output]) == 1
        message = _told(capsys, "cannot-write")
        assert words in message
        assert output in message
        assert _files() == before


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="root may write everywhere")
def test_an_output_without_permission(capsys: pytest.CaptureFixture[str]) -> None:
    Path("one.azee").write_text("key 1 (look ^fwd)")
    Path("locked").mkdir(0o500)
    assert run(["compile", "one.azee", "-o", "locked/x.glb"]) == 1
    assert "permission" in _told(capsys, "cannot-write")


USAGE = {
    "no command": [],
    "unknown command": ["compil"],
    "no text": ["compile"],
    "unknown option": ["compile", "--no-such-option"],
    "unknown suffix": ["compile", "one.azee", "-o", "x.docx"],
    "no suffix": ["compile", "one.azee", "-o", "x"],
    "a score is no GLB": ["score", "one.azee", "-o", "x.glb"],
    "unknown rig": ["compile", "one.azee", "--rig", "nobody"],
    "unknown mode": ["compile", "one.azee", "--mode", "wild"],
    "no frames": ["compile", "one.azee", "--fps", "0"],
    "not a number": ["compile", "one.azee", "--fps", "nan"],
    "one file twice": ["score", "one.azee", "-o", "x.svg", "-o", "./x.svg"],
    "a report over a clip": ["compile", "one.azee", "-o", "x.json", "--report", "x.json"],
    "a film for no ELAN file": ["compile", "one.azee", "-o", "x.glb", "--media", "x.mp4"],
    "a video for no ELAN file": ["score", "one.azee", "--media", "x.mp4"],
    "no such hand": ["compile", "one.azee", "--dominant", "middle"],
    "no such library folder": ["check", "one.azee", "--library", "missing"],
    "which utterance": ["score", "one.azee", "-e", ":arbre", "--utterance", "1"],
    "utterances count from one": ["score", "one.azee", "--utterance", "0"],
    "nothing to check": ["check"],
    "nothing to format": ["fmt"],
    "nowhere to search": ["find", ":arbre"],
}


@pytest.mark.parametrize("case", USAGE)
def test_wrong_use(case: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("one.azee").write_text("key 1 (look ^fwd)")
    assert run(USAGE[case]) == 2
    captured = capsys.readouterr()
    assert "Usage:" in captured.err + captured.out
    assert "Traceback" not in captured.err
    assert _files() == ["one.azee"]


@pytest.mark.long
def test_the_process_itself_shows_no_traceback(python: Python) -> None:
    done = python("-m", "azee", "score", "-", stdin=":wardrob", expect=1)
    assert done.stderr.startswith("error[unknown-rule]")
    assert "<stdin>:1:1" in done.stderr
    assert done.stdout == ""


@pytest.mark.parametrize("module", ["azee", "azee.cli.main"])
def test_the_command_is_a_module_that_runs(module: str, python: Python) -> None:
    assert python("-m", module, "--version", expect=0).stdout.startswith("azee, version ")


@pytest.mark.long
def test_bytes_that_are_no_text_on_standard_input(python: Python) -> None:
    done = python("-m", "azee", "check", "-", stdin=b"\xff\xfe\x00\x01", expect=1)
    assert "error[not-utf8]" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.long
def test_a_reader_that_goes_away_is_no_fault(python: Python, tmp_path: Path) -> None:
    """As in `azee score FILE | head -1`: the pipe breaks while we write."""
    script = (
        "import os, sys\n"
        "from azee.cli.main import main\n"
        "read, write = os.pipe()\n"
        "os.close(read)\n"
        "os.dup2(write, 1)\n"
        "main(['score', '-e', 'key 1 (look ^fwd)'])\n"
    )
    done = python("-c", script)
    assert done.returncode != 0
    assert done.stderr == ""


@pytest.mark.long
@pytest.mark.skipif(os.name == "nt", reason="closed and full streams are those of POSIX")
def test_output_that_is_closed_or_full(python: Python) -> None:
    """A closed stream is nobody's who wants output; the next file opened must not become it."""
    call = "from azee.cli.main import main; main({})"
    draw = call.format(["score", "-e", "key 1 (look ^fwd)", "-o", "x.svg"])
    python("-c", f"import sys\nsys.stdout = sys.stderr = None\n{draw}", expect=0)
    assert (python.folder / "x.svg").read_bytes().startswith(b"<")
    for command in (["score", "-e", "key 1 (look ^fwd)"], ["repl", "--no-history"]):
        write = f"import sys\nsys.stdout = open('/dev/full', 'w')\n{call.format(command)}"
        if Path("/dev/full").exists():
            done = python("-c", write, stdin="count (list 1 2)", expect=1)
            assert done.stderr.startswith("error[cannot-write]"), done.stderr
            assert "Traceback" not in done.stderr


@pytest.mark.skipif(os.name == "nt", reason="there are no signals like those of POSIX")
def test_a_process_that_is_ended_leaves_nothing_half_written(python: Python) -> None:
    script = (
        "import os, signal\n"
        "from azee.cli import main\n"
        "from azee.export.files import replace_file\n"
        "def stopped(_):\n"
        "    with replace_file('x.glb') as file:\n"
        "        file.write(b'half')\n"
        "        os.kill(os.getpid(), signal.SIGTERM)\n"
        "main.run = stopped\n"
        "main.main()\n"
    )
    python("-c", script, expect=128 + 15)
    assert list(python.folder.iterdir()) == []


def test_a_fault_of_ours_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("ours")

    monkeypatch.setattr("azee.cli.score.Text.read", broken)
    with pytest.raises(RuntimeError, match="ours"):
        run(["score", "-e", ":arbre"])


def test_an_interrupt_has_its_own_code(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("azee.cli.score.Text.read", interrupted)
    assert run(["score", "-e", ":arbre"]) == 130


LONG = "n" * 300


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["check", LONG], 1),
        (["check", f"{LONG}/a.azee"], 1),
        (["fmt", LONG], 1),
        (["score", LONG], 1),
        (["find", ":bien", LONG], 1),
        (["check", "-e", ":bien", "--library", LONG], 2),
        (["check", "-e", ":bien", "--rig", LONG], 2),
        (["rules", "--library", LONG], 2),
        (["score", "-e", ":bien", "-o", f"{LONG}.svg"], 1),
        (["compile", "-e", ":bien", "-o", f"{LONG}.glb"], 1),
        (["compile", "-e", ":bien", "-o", "a.glb", "--report", f"{LONG}.json"], 1),
        (["render", "-e", ":bien", "-o", f"{LONG}.png"], 1),
        (["render", f"{LONG}.npz", "-o", "a.png"], 1),
        (["clip", "convert", f"{LONG}.bvh", "-o", "a.npz"], 1),
        (["retarget", f"{LONG}.bvh", "-o", "a.glb"], 1),
    ],
)
def test_a_name_that_no_system_takes_gets_one_message(
    arguments: list[str], code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(arguments) == code
    told = capsys.readouterr().err
    assert len(re.findall("(?m)^(?:error|Error)", told)) == 1
    assert LONG in told
    assert _files() == []


def test_a_name_as_long_as_any_may_be_is_written() -> None:
    name = "n" * 250
    Path(f"{name}.azee").write_text(":bien()\n", encoding="utf-8")
    assert run(["fmt", "--quiet", f"{name}.azee"]) == 0
    assert run(["score", f"{name}.azee", "-o", f"{name}.svg"]) == 0
    assert _files() == [f"{name}.azee", f"{name}.svg"]


@pytest.mark.parametrize("text", [".6s", "0.6", ".6", "0.6 s", "6e-1s"])
def test_a_time_is_written_with_its_unit_or_without(text: str) -> None:
    assert Seconds(min=0).convert(text, None, None) == 0.6


@pytest.mark.parametrize("text", ["-1s", "later", "1.2m", "s", "", "nan", "1.2.3", "1,2"])
def test_what_is_no_time_is_told(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["render", "-e", ":bien", "-o", "a.png", "--at", text]) == 2
    told = capsys.readouterr().err
    assert "'--at'" in told
    assert "1.2s" in told or "range" in told
    assert run(["clip", "cut", "a.npz", "-o", "b.npz", "--from", text]) == 2
