"""`azee db`: what the command does with files and databases, and what it says."""

from __future__ import annotations

import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from made_signs import STICK, facts, motion
from recorded_files import wave

from azee.cli.main import run
from azee.clip.archive import read_clip
from azee.clip.clip import Clip
from azee.clips import save_clip
from azee.signs.database import SignDatabase
from azee.signs.integrity import problems
from azee_rig.rig import Rig


def nodding(signer: Rig, phase: float, frames: int = 31) -> Clip:
    """A second of the idle posture with a little movement, which tells clips apart."""
    times = np.arange(frames) / 30
    q = np.tile(signer.coordinates.idle, (frames, 1))
    q[:, signer.coordinates.index["arm_R.flexion"]] += 0.05 * np.sin(5 * times + phase) + 0.06
    return Clip(times, q, signer.units[:1], np.full((frames, 1), 0.5))


@pytest.fixture
def db(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A new database, which the environment names."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("AZEE_DB", "signs.db")
    assert run(["db", "create", "--quiet"]) == 0
    return "signs.db"


def test_a_clip_comes_back_number_by_number(db: str, signer: Rig) -> None:
    clip = nodding(signer, 0.3)
    save_clip(clip, signer, "NOD.npz")
    assert run(["db", "add", "NOD.npz"]) == 0
    assert run(["db", "export", "NOD", "-o", "back.npz", "--original", "same.npz"]) == 0
    back = read_clip("back.npz", signer)
    np.testing.assert_array_equal(back.coordinates, clip.coordinates)
    np.testing.assert_array_equal(back.times, clip.times)
    assert Path("same.npz").read_bytes() == Path("NOD.npz").read_bytes()


@pytest.mark.long
def test_a_recording_of_another_skeleton_keeps_its_finger_errors(
    db: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("WAVE.bvh").write_text(wave(), encoding="utf-8")
    assert run(["db", "add", "WAVE.bvh"]) == 0
    assert "finger tips are off in the palm by up to: thumb" in capsys.readouterr().err
    assert run(["db", "show", "WAVE"]) == 0
    shown = json.loads(capsys.readouterr().out)
    report = shown["provenance"]["retargeted"]
    assert report["frames"] == 31
    assert 0.0 < report["digits"]["thumb_R"]["tip_m"]["max"] < 0.02
    assert shown["provenance"]["file"] == "WAVE.bvh"
    with SignDatabase.open(db) as signs:
        assert list(problems(signs)) == []


@pytest.mark.long
def test_the_same_file_is_a_sign_of_each_body(
    db: str, signer: Rig, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("WAVE.bvh").write_text(wave(), encoding="utf-8")
    assert run(["db", "add", "WAVE.bvh"]) == 0
    assert run(["db", "add", "WAVE.bvh", "--rig", "child"]) == 0
    assert run(["db", "add", "WAVE.bvh", "--rig", "child"]) == 0
    assert "0 signs added, 1 there already" in capsys.readouterr().err
    assert run(["db", "list", "--format", "json"]) == 0
    found = json.loads(capsys.readouterr().out)["signs"]
    assert [sign["skeleton"] for sign in found] == ["signer", "child"]
    assert run(["db", "show", "WAVE"]) == 1
    assert "2 signs are called `WAVE`" in capsys.readouterr().err


def test_other_bytes_under_a_name_are_no_resumed_import(
    db: str, signer: Rig, capsys: pytest.CaptureFixture[str]
) -> None:
    save_clip(nodding(signer, 0.0), signer, "NOD.npz")
    assert run(["db", "add", "NOD.npz"]) == 0
    save_clip(nodding(signer, 1.0), signer, "NOD.npz")
    assert run(["db", "add", "NOD.npz"]) == 1
    assert "error[sign-exists]: `NOD.npz`:" in capsys.readouterr().err
    assert run(["db", "add", "NOD.npz", "--variant", "2"]) == 0


def test_files_that_are_no_signs_do_not_stop_the_others(
    db: str, signer: Rig, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("in/deep").mkdir(parents=True)
    save_clip(nodding(signer, 0.0), signer, "in/deep/NOD.npz")
    Path("in/broken.npz").write_bytes(b"PK\x03\x04 broken")
    Path("in/broken.bvh").write_text("HIERARCHY\nROOT x {", encoding="utf-8")
    Path("in/notes.txt").write_text("no sign", encoding="utf-8")
    assert run(["db", "add", "in", "missing.bvh"]) == 1
    told = capsys.readouterr().err
    assert "1 sign added, 3 failed" in told
    assert told.count("error[not-a-clip]") == 2
    assert "there is no file `missing.bvh`" in told
    Path("empty").mkdir()
    assert run(["db", "add", "empty"]) == 1
    assert "no file of motion is in the folder `empty`" in capsys.readouterr().err


def test_a_name_that_no_text_can_be_is_told(
    db: str, signer: Rig, capsys: pytest.CaptureFixture[str]
) -> None:
    save_clip(nodding(signer, 0.0), signer, "NO\nD.npz")
    assert run(["db", "add", "NO\nD.npz"]) == 1
    assert "error[bad-sign]" in capsys.readouterr().err


def test_search_finds_nothing_with_its_own_code(
    db: str, signer: Rig, capsys: pytest.CaptureFixture[str]
) -> None:
    save_clip(nodding(signer, 0.0), signer, "NOD.npz")
    assert run(["db", "add", "NOD.npz", "--tag", "head"]) == 0
    assert run(["db", "search", "NO"]) == 0
    assert run(["db", "search", "--tag", "head"]) == 0
    assert run(["db", "search", "head"]) == 0
    assert run(["db", "search", "NOx"]) == 3
    assert run(["db", "search"]) == 2
    assert run(["db", "tag", "NOD"]) == 2
    assert run(["db", "export", "NOD"]) == 2
    assert run(["db", "copy", "--to", "x.db"]) == 2


def test_nothing_is_removed_if_one_name_is_wrong(db: str, signer: Rig) -> None:
    save_clip(nodding(signer, 0.0), signer, "NOD.npz")
    assert run(["db", "add", "NOD.npz"]) == 0
    assert run(["db", "remove", "NOD", "NONE"]) == 1
    assert run(["db", "show", "NOD"]) == 0
    assert run(["db", "remove", "NOD"]) == 0
    assert run(["db", "show", "NOD"]) == 1


def test_damage_is_found_and_the_rest_can_be_copied(
    db: str, signer: Rig, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, phase in (("A", 0.0), ("B", 1.0)):
        save_clip(nodding(signer, phase), signer, f"{name}.npz")
    assert run(["db", "add", "A.npz", "B.npz"]) == 0
    assert run(["db", "check"]) == 0
    with sqlite3.connect(db) as connection:
        connection.execute("UPDATE motion SET clip = substr(clip, 2) WHERE sign = 1")
    connection.close()
    capsys.readouterr()
    assert run(["db", "check"]) == 1
    told = capsys.readouterr().err
    assert "2 signs: 1 problem" in told
    assert "the movement of `A` is damaged" in told
    assert run(["db", "create", "--db", "other.db"]) == 0
    assert run(["db", "copy", "--all", "--to", "other.db"]) == 1
    assert "1 of 2 signs copied" in capsys.readouterr().err
    assert run(["db", "check", "--db", "other.db"]) == 0
    assert run(["db", "export", "A", "--original", "A2.npz"]) == 0
    assert Path("A2.npz").read_bytes() == Path("A.npz").read_bytes()


def test_a_body_that_does_not_ship_is_asked_for(
    db: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with SignDatabase.open(db) as signs:
        signs.add(facts("A"), motion("a"), STICK)
    assert run(["db", "export", "A", "-o", "a.bvh"]) == 1
    assert "`A` moves the body `stick`, which does not ship" in capsys.readouterr().err


def test_without_the_library_the_remedy_is_told(
    db: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "sqlalchemy", None)
    assert run(["db", "list"]) == 1
    assert "install it with: pip install 'azee[signs]'" in capsys.readouterr().err


def test_the_usual_place_is_the_user_s_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("AZEE_DB", raising=False)
    monkeypatch.setattr("platformdirs.user_data_path", lambda *_, **__: tmp_path / "data" / "azee")
    assert run(["db", "list"]) == 1
    assert "no such file" in capsys.readouterr().err
    assert run(["db", "create"]) == 0
    assert (tmp_path / "data" / "azee" / "signs.db").is_file()
    assert run(["db", "list"]) == 0


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
def test_a_killed_command_goes_on_where_it_was(
    db: str, signer: Rig, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("in").mkdir()
    for number in range(60):
        save_clip(nodding(signer, number / 10), signer, f"in/NOD_{number:02}.npz")
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    command = [sys.executable, "-m", "azee", "db", "add", "in", "--quiet"]
    process = subprocess.Popen(command, env=environment)
    with SignDatabase.open(db) as signs:
        while not (there := len(signs.find())):
            assert process.poll() is None
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)
        process.wait()
        assert there < 60
        assert list(problems(signs)) == []
        before = len(signs.find())
    assert run(["db", "add", "in"]) == 0
    assert f"{60 - before} signs added, {before} there already" in capsys.readouterr().err
    assert run(["db", "check"]) == 0
