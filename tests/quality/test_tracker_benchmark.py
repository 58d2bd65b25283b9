"""What is made of a tracker's landmarks, and what is said where there is no tracker."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest

from azee.clip.clip import Clip
from azee_rig.rig import Rig
from benchmarks.ik.elsewhere import NotThere
from benchmarks.tracker import __main__ as bench
from benchmarks.tracker import environment
from benchmarks.tracker.filmed import FPS, LOOK, Filmed, joints_in_pictures
from benchmarks.tracker.seen import POSE, seen


def tracked(folder: Path) -> tuple[Filmed, Path]:
    """100 frames: a left hand that is found a third of the time, a right one that leaves."""
    count = 100
    body = np.zeros((count, 5, 2))
    body[:, 0], body[:, 1] = (410.0, 200.0), (230.0, 200.0)  # 180 pixels are 36 cm
    body[:, 2:] = (320.0, 300.0)
    hands = {side: np.full((count, 21, 2), 300.0) for side in "LR"}
    hands["R"][50:, 20, 0] = LOOK.size[0] + 5.0
    pose = np.full((count, 33, 2), 50.0)
    pose[:, POSE] = body
    left, right = hands["L"] + (15.0, 20.0), hands["R"].copy()
    left[np.arange(count) % 3 > 0] = np.nan
    right[:10] = np.nan
    face = np.arange(count) < 80
    out = folder / "film.npz"
    np.savez(out, pose=pose, left=left, right=right, face=face, fps=FPS, size=LOOK.size)
    return Filmed(folder / "film.mp4", body, hands), out


def test_hands_are_looked_for_where_they_are_in_view(tmp_path: Path) -> None:
    found = seen("film", *tracked(tmp_path))
    assert found.found == {"L": pytest.approx(0.34), "R": pytest.approx(0.8)}
    assert [found.face, found.pose] == pytest.approx([0.8, 1.0])
    # 25 pixels of 500 a metre.
    assert found.apart_cm == {"L": pytest.approx(5.0), "R": pytest.approx(0.0)}
    assert found.tracked.both_stopped_share == 1.0
    assert found.tracked == found.own
    assert found.frames == 100


def test_the_table_has_films_and_people(tmp_path: Path) -> None:
    lines = [*bench.lines([seen("film", *tracked(tmp_path))])]
    film = next(line for line in lines if line.startswith("film"))
    assert film.split()[:6] == ["film", "0.80", "0.34", "0.80", "0.0", "5.0"]
    persons = [line for line in lines if line.startswith("person")]
    assert len(persons) == 7
    assert persons[1].split()[2:] == ["0.18", "1.12", "–", "–", "–", "2.9", "0.27", "9.6"]


def test_joints_are_where_the_picture_shows_them(signer: Rig) -> None:
    idle = signer.coordinates.idle[None]
    clip = Clip(np.zeros(1), idle, (), np.zeros((1, 0)))
    body, hands = joints_in_pictures(clip, signer)
    left, right, _, _, nose = body[0]
    middle = LOOK.size[0] / 2.0
    # The signer's left is on the right of the picture; y grows downwards.
    assert left[0] - middle == pytest.approx(middle - right[0], abs=0.5)
    assert left[0] > middle
    assert nose[1] < left[1]
    assert nose[0] == pytest.approx(middle, abs=0.5)
    film = Filmed(Path("film.mp4"), body, hands)
    assert film.in_view("L").all()
    assert hands["L"].shape == (1, 21, 2)
    assert hands["L"][0, 0] == pytest.approx(body[0, 2])
    # The tip of the middle finger is farther from the wrist than its knuckle.
    reach = np.linalg.norm(hands["L"][0] - hands["L"][0, 0], axis=1)
    assert reach[12] > reach[9] > 0.0


def test_without_a_fitting_python_it_says_so(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(environment, "FOLDER", tmp_path / "env")
    monkeypatch.setattr(environment, "VERSIONS", ())
    assert bench.main(["not-but"]) == 1
    assert "mediapipe==0.10.14 needs Python 3.9 to 3.12" in capsys.readouterr().err


def test_a_package_that_cannot_be_installed_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(environment, "FOLDER", tmp_path / "env")
    monkeypatch.setattr(environment, "_base", lambda: "python")

    def run(command: list[str], **_: object) -> subprocess.CompletedProcess[str]:
        failed = "install" in command
        return subprocess.CompletedProcess(command, failed, "", "much\nERROR: no match\n")

    monkeypatch.setattr(subprocess, "run", run)
    with pytest.raises(
        NotThere, match=r"mediapipe==0\.10\.14 cannot be installed: ERROR: no match"
    ):
        environment.interpreter()


def test_an_environment_that_is_ready_is_used(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(environment, "FOLDER", tmp_path)
    (tmp_path / ".ready").write_text(" ".join(environment.PACKAGES), encoding="utf-8")
    monkeypatch.setattr(environment, "_run", lambda *_: pytest.fail("made anew"))
    assert environment.interpreter().parent.parent == tmp_path
