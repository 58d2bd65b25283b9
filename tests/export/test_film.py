"""Films and stills show the body where it is, and are read back as they were asked for."""

from __future__ import annotations

import shutil
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from azee.cli.main import run
from azee.clip.clip import Clip, Label
from azee.clips import save_clip
from azee.export.pictures.camera import projected
from azee.export.pictures.camerawork import cameras
from azee.export.pictures.film import write_film
from azee.export.pictures.scene import Look, Scene
from azee.export.pictures.shots import SHOTS
from azee.export.pictures.still import resting_times, write_sheet
from azee.export.pictures.strip import Strip
from azee.export.pictures.typeface import typeface
from azee_rig.rig import Rig

Pixels = NDArray[np.uint8]


@pytest.fixture(scope="module")
def waving(signer: Rig) -> Clip:
    """A second and a half: the right hand is raised, named, and comes down again."""
    c = signer.coordinates
    times = np.arange(46) / 30
    share = np.sin(np.pi * times / 1.5) ** 2
    raised = c.idle.copy()
    raised[c.index["arm_R.flexion"]] = np.radians(80)
    raised[c.index["f_arm_R.flexion"]] = np.radians(110)
    q = c.idle + share[:, None] * (raised - c.idle)
    labels = (Label(("salut",), 0.3, 1.2), Label(("salut", "main levée"), 0.5, 1.0))
    return Clip(times, q, ("jawOpen",), share[:, None], labels)


def read(path: Path) -> tuple[list[Pixels], Any]:
    """All frames of a film, RGB, and what its stream says of itself."""
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        frames = [
            np.asarray(frame.to_ndarray(format="rgb24"), dtype=np.uint8)
            for frame in container.decode(stream)
        ]
        said = {
            "rate": stream.average_rate,
            "seconds": (container.duration or 0) / 1e6,
            "primaries": stream.codec_context.color_primaries,
            "matrix": stream.codec_context.colorspace,
            "range": stream.codec_context.color_range,
        }
    return frames, said


def hand_pixel(clip: Clip, rig: Rig, frame: int, shot: str, size: tuple[int, int]) -> list[int]:
    node = rig.bones["palm_R"].node
    frames = rig.chain.frames(clip.coordinates[frame])
    middle = frames.positions[node] + 0.05 * frames.rotations[node][:, 1]
    eye = cameras(clip, rig, shot, size[0] / size[1])[frame]
    return [int(x) for x in projected(middle[None], eye, *size)[0][0, :2]]


def is_skin(pixel: Pixels) -> bool:
    r, g, b = (int(x) for x in pixel[:3])
    return r > g > b and r > b + 30


@pytest.mark.long
@pytest.mark.parametrize("suffix", [".mp4", pytest.param(".webm", marks=pytest.mark.slow)])
def test_a_film_has_its_frames_its_length_its_size_and_the_hand_where_it_is(
    waving: Clip, signer: Rig, tmp_path: Path, suffix: str
) -> None:
    look = Look((241, 181), captions=False, samples=1)
    for name in ("a", "b"):
        write_film(waving, signer, tmp_path / f"{name}{suffix}", look, fps=15)
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"a{suffix}", f"b{suffix}"]
    frames, said = read(tmp_path / f"a{suffix}")
    assert len(frames) == 23
    assert frames[0].shape == (182, 242, 3)
    assert said == {
        "rate": 15,
        "seconds": pytest.approx(23 / 15, abs=0.01),
        "primaries": 1,
        "matrix": 1,
        "range": 1,
    }
    x, y = hand_pixel(waving, signer, 22, "front", (242, 182))
    shown = Scene(waving, signer, Look((242, 182), captions=False, samples=1))
    with shown.canvases() as (canvases,):
        drawn = shown.frame(22, canvases)
    assert is_skin(drawn[y, x])
    assert not is_skin(frames[0][y, x]), "the hand is elsewhere at first"
    # What a player shows is what was drawn: neither colours nor places are lost in the coding.
    error = np.abs(frames[11].astype(int) - drawn.astype(int))
    assert error.mean() < 2.5
    assert np.abs(frames[11][y, x].astype(int) - drawn[y, x]).max() < 24


def test_a_transparent_film_has_an_alpha_channel(waving: Clip, signer: Rig, tmp_path: Path) -> None:
    path = tmp_path / "a.webm"
    look = Look((96, 96), captions=False, transparent=True, samples=1)
    write_film(waving, signer, path, look, fps=5)
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        assert stream.metadata.get("alpha_mode") == "1"
        decoder = av.codec.CodecContext.create("libvpx-vp9", "r")
        frames = [f for packet in container.demux(stream) for f in decoder.decode(packet)]
    alpha = frames[0].to_ndarray(format="rgba")[..., 3]
    assert alpha[2, 2] < 8
    assert alpha[48, 48] > 247
    with pytest.raises(ValueError, match="transparency"):
        write_film(waving, signer, tmp_path / "a.mp4", look)
    assert not (tmp_path / "a.mp4").exists()


@pytest.mark.parametrize("shot", SHOTS)
def test_every_camera_shows_its_subject_and_moves_smoothly(
    waving: Clip, signer: Rig, shot: str
) -> None:
    eyes = cameras(waving, signer, shot, 1.0)
    assert len(eyes) == len(waving.times)
    way = np.array([np.r_[eye.eye, eye.target] for eye in eyes])
    assert np.abs(np.diff(way, 2, axis=0)).max() < 0.015, "metres a frame, each frame"
    if shot in ("hands", "right hand", "front", "whole"):
        x, y = hand_pixel(waving, signer, 23, shot, (100, 100))
        assert 0 < x < 100
        assert 0 < y < 100


def test_the_strip_names_what_runs(waving: Clip) -> None:
    strip = Strip(waving.labels, (640, 360))
    running = [[label.text for label in row] for row in strip.running(0.6)]
    assert running == [["salut"], ["main levée"]]
    assert strip.running(1.3) == [[], []]
    quiet, loud = strip.draw(0.1), strip.draw(0.6)
    assert quiet.shape == loud.shape == (strip.height, 640, 4)
    assert np.abs(quiet.astype(int) - loud).max() > 100
    deep = tuple(Label(tuple("abcdefg"[: n + 1]), 0.0, 1.0) for n in range(7))
    last = Strip(deep, (640, 360)).running(0.5)[-1]
    assert [label.text for label in last] == ["d", "e", "f", "g"], "none is left out"


def test_the_strip_has_room_for_any_number_of_blocks() -> None:
    labels = [Label((f"{i}",), 0.0, 1.0) for i in range(200)]
    drawn = Strip(labels, (160, 120)).draw(0.5)
    assert drawn.shape[1] == 160
    assert len(np.unique(drawn.reshape(-1, 4), axis=0)) > 1


def test_every_letter_of_european_names_can_be_written() -> None:
    font = typeface(24)
    nothing = bytes(font.getmask("\uffff"))
    letters = "éèêëçñäößøåæœğşıİřžłőșțΩжé · › – … “x”"
    assert [c for c in letters if c != " " and bytes(font.getmask(c)) == nothing] == []


def test_frames_are_the_same_however_many_threads_draw_them(waving: Clip, signer: Rig) -> None:
    scene = Scene(waving, signer, Look((120, 90), ("front", "face"), samples=1))
    with scene.canvases() as (canvases,):
        one = [scene.frame(i, canvases) for i in (0, 11, 22, 44)]
    many = list(scene.frames([0, 11, 22, 44]))
    assert all((a == b).all() for a, b in zip(one, many, strict=True))


def test_the_body_rests_at_its_turning_points(waving: Clip) -> None:
    assert resting_times(waving) == pytest.approx([0.0, 0.7333, 1.5], abs=0.04)


def test_a_sheet_has_no_picture_of_the_idle_ends(
    waving: Clip, signer: Rig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[float] = []

    def noted(*given: Any) -> list[Image.Image]:
        drawn.extend(given[3])
        return [Image.new("RGB", (128, 160)) for _ in given[3]]

    monkeypatch.setattr("azee.export.pictures.still._drawn", noted)
    look = Look((200, 320), ("front",))
    write_sheet(waving, signer, tmp_path / "s.png", look, [0.4, 0.7333])
    assert drawn == pytest.approx([0.4, 0.5667, 0.7333], abs=0.02)
    drawn.clear()
    write_sheet(waving, signer, tmp_path / "s.png", look)  # a recording: nobody knows its keys
    assert drawn[0] == 0
    assert drawn[-1] == 1.5


@pytest.mark.long
def test_one_command_writes_pictures_and_films_of_a_clip(
    waving: Clip, signer: Rig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    save_clip(waving, signer, "w.npz")
    small = ["--quiet", "--size", "160x120"]
    assert run(["render", "w.npz", *small, "--fps", "4", "-o", "w.mp4", "-o", "w.webm"]) == 0
    assert len(read(Path("w.mp4"))[0]) == len(read(Path("w.webm"))[0]) == 7
    assert run(["render", "w.npz", *small, "-o", "s.png", "--sheet"]) == 0
    assert run(["render", "w.npz", *small, "-o", "t.png", "--at", "0s", "--at", "0.7"]) == 0
    two = np.asarray(Image.open("t.png"))
    assert two.shape == (120, 320, 3)
    assert np.abs(two[:, :160].astype(int) - two[:, 160:]).max() > 60
    assert run(["render", "w.npz", *small, "-o", "c.png", "--transparent", "--no-captions"]) == 0
    assert np.asarray(Image.open("c.png"))[0, 0, 3] == 0


def test_what_cannot_be_drawn_is_said_in_one_message(
    waving: Clip,
    signer: Rig,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    save_clip(waving, signer, "w.npz")
    wrong = {
        "-o w.gif": 2,
        "-o w.mp4 --transparent": 2,
        "-o w.mp4 --sheet": 2,
        "-o w.png --at 9s": 2,
        "-o w.png --at soon": 2,
        "-o w.png --size 2x2": 2,
        "-o w.png --size 16x24": 2,
        "-o w.mp4 --fps nan": 2,
        "-o w.png -e :arbre": 2,
        "-o w.png --utterance 2": 2,
        "-o w.png --no-life": 2,
        "-o w.png --timing exact": 2,
        "-o w.png --tempo 2": 2,
        "-o w.png -o ./w.png": 2,
        "-o nowhere/w.png": 1,
    }
    for options, code in wrong.items():
        assert run(["render", "w.npz", *options.split()]) == code, options
        assert "Traceback" not in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "av", None)
    assert run(["render", "w.npz", "-o", "w.mp4"]) == 1
    told = capsys.readouterr().err
    assert "error[not-installed]" in told
    assert "pip install 'azee[film]'" in told
    assert sorted(path.name for path in tmp_path.iterdir()) == ["w.npz"]


@pytest.mark.slow
def test_clips_are_worked_on_from_the_command_line(
    waving: Clip,
    signer: Rig,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    from azee.clips import open_clip

    monkeypatch.chdir(tmp_path)
    save_clip(waving, signer, "w.npz")
    commands = (
        "cut w.npz --from 0.5 --to 1 -o c.npz -o c.bvh",
        "join w.npz c.bvh w.npz --overlap 0.2 -o j.npz",
        "mirror w.npz -o m.npz -o m.glb",
        "retime w.npz --speed 2 -o r.npz -o r.json",
        "convert w.npz --fps 60 -o v.npz",
    )
    for command in commands:
        assert run(["clip", *command.split(), "--quiet"]) == 0
    lengths = {name: open_clip(f"{name}.npz").clip for name in "cjmrv"}
    assert lengths["c"].duration_s == pytest.approx(0.5)
    assert lengths["j"].duration_s == pytest.approx(1.5 + 0.5 + 1.5 - 0.4)
    assert lengths["r"].duration_s == pytest.approx(0.75, abs=1 / 30)
    assert len(lengths["v"].times) == 91
    assert [x.text for x in lengths["j"].labels] == ["salut", "main levée"] * 2
    # Our own BVH comes back as the coordinates that it was written from: a millionth of a degree
    # is 1.7e-8 rad, and no coordinate stretches that a hundredfold.
    again = open_clip("c.bvh").clip
    np.testing.assert_allclose(again.coordinates, lengths["c"].coordinates, atol=1e-6)
    shutil.copy("c.bvh", "broken.npz")
    assert run(["clip", "convert", "broken.npz", "-o", "x.npz"]) == 1
    Path("cut-off.bvh").write_text(Path("c.bvh").read_text(encoding="ascii")[:5000], "ascii")
    assert run(["clip", "convert", "cut-off.bvh", "-o", "x.npz"]) == 1
    assert capsys.readouterr().err.count("error[not-a-clip]") == 2
    assert run(["clip", "convert", "c.bvh", "-o", "again.npz"]) == 0
    assert "cm" not in capsys.readouterr().err  # our own lengths need no guess
    Path("late.bvh").write_text(
        Path("c.bvh").read_text(encoding="ascii").replace("Frame Time: 0.0", "Frame Time: -"),
        encoding="ascii",
    )
    assert run(["clip", "convert", "late.bvh", "-o", "again.npz"]) == 0
    assert "no frame time" in capsys.readouterr().err
    assert run(["clip", "cut", "w.npz", "--from", "8", "-o", "x.npz"]) == 1
    assert run(["clip", "retime", "w.npz", "--duration", "1000000000", "-o", "x.npz"]) == 1
    assert capsys.readouterr().err.count("error[clip-times]") == 2
    save_clip(waving, replace(signer, name="../nobody"), "n.npz")
    assert run(["clip", "convert", "n.npz", "-o", "x.npz"]) == 1
    told = capsys.readouterr().err
    assert "error[not-a-clip]" in told
    assert "--rig" in told
    assert run(["clip", "retime", "w.npz", "-o", "x.npz"]) == 2
    assert not Path("x.npz").exists()
