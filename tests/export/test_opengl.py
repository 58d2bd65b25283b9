"""OpenGL draws what our rasteriser draws, within a tolerance, and says so where it is not there."""

from __future__ import annotations

import sys
import threading
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from programs import Python

from azee.cli.main import run
from azee.clip.clip import Clip, Label
from azee.clips import save_clip
from azee.export.pictures.camera import Camera, camera, projected
from azee.export.pictures.opengl.canvas import OpenGLCanvas
from azee.export.pictures.opengl.context import NoOpenGLError, OpenGL
from azee.export.pictures.renderer import Canvas, canvases, resolved
from azee.export.pictures.scene import Look, Scene
from azee_rig.load import load_rig
from azee_rig.rig import Rig

Floats = NDArray[np.float64]
Pixels = NDArray[np.uint8]

MEAN = 0.03
"""The most that colours differ by in the mean, of 255."""
FAR, FEW = 16, 1e-3
"""Only this share of the pixels, at edges, differs in a colour by more than this, of 255."""
SIZE = 240, 270


def posture(rig: Rig, kind: str) -> Floats:
    """A posture by its kind: at rest, a raised hand, or arms, fingers and head anyhow."""
    c = rig.coordinates
    q = np.array(c.idle)
    if kind == "raised":
        q[c.index["arm_R.flexion"]], q[c.index["f_arm_R.flexion"]] = np.radians((80, 110))
    elif kind != "idle":
        drawn = np.random.default_rng(int(kind)).uniform(c.lower, c.upper)
        q += 0.35 * (drawn - q)
    return q


def check_alike(ours: Pixels, theirs: Pixels) -> None:
    """Hold two pictures to the tolerance."""
    assert ours.shape == theirs.shape
    apart = np.abs(ours.astype(int) - theirs)
    assert apart.mean() < MEAN
    assert (apart.max(axis=2) > FAR).mean() < FEW


class Both:
    """Canvases of both renderers, of one body."""

    def __init__(self, ours: Canvas, theirs: Canvas) -> None:
        self.ours, self.theirs = ours, theirs

    def check(self, vertices: Floats, eye: Camera, *, transparent: bool = False) -> Pixels:
        """Draw with both, hold them to the tolerance, and return the picture of OpenGL."""
        theirs = self.theirs.draw(vertices, eye, transparent)
        check_alike(self.ours.draw(vertices, eye, transparent), theirs)
        return theirs


@pytest.fixture(scope="module")
def both(signer: Rig, opengl: str) -> Iterator[Both]:
    """Both renderers of the body that ships."""
    with (
        canvases("software", signer.mesh, [SIZE], 2) as ours,
        canvases("opengl", signer.mesh, [SIZE], 2) as theirs,
    ):
        yield Both(ours[0][0], theirs[0][0])


@pytest.fixture(scope="module")
def clip(signer: Rig) -> Clip:
    """Five frames in which the right hand is raised."""
    share = np.linspace(0.0, 1.0, 5)[:, None]
    idle, raised = (posture(signer, kind) for kind in ("idle", "raised"))
    labels = (Label(("salut",), 0.0, 0.1),)
    return Clip(np.arange(5) / 30, idle + share * (raised - idle), ("jawOpen",), share, labels)


@pytest.mark.long
@pytest.mark.parametrize("view", ["front", "face", "right hand", "left hand", "three-quarter"])
@pytest.mark.parametrize("kind", ["idle", "raised", "1", "2", "3"])
def test_pictures_of_both_are_alike(both: Both, signer: Rig, kind: str, view: str) -> None:
    q = posture(signer, kind)
    lids = {unit: float(weight) for unit, weight in signer.lid_weights(q).items()}
    vertices = signer.skin(signer.pose(q), lids)
    drawn = both.check(vertices, camera(signer, q, view))
    assert np.ptp(drawn.astype(int), axis=(0, 1)).min() > 60, "there is a body in it"


@pytest.mark.slow
@pytest.mark.parametrize("body", ["child", "heavy", "game"])
def test_pictures_of_every_body_are_alike(opengl: str, body: str) -> None:
    rig = load_rig(body)
    q = posture(rig, "raised")
    vertices = rig.skin(rig.pose(q))
    with (
        canvases("software", rig.mesh, [SIZE, (160, 90)], 2) as ours,
        canvases("opengl", rig.mesh, [SIZE, (160, 90)], 2) as theirs,
    ):
        for view in ("front", "face", "right hand"):
            for one, other in zip(ours[0], theirs[0], strict=True):
                Both(one, other).check(vertices, camera(rig, q, view))


@pytest.mark.long
@pytest.mark.parametrize("view", ["front", "face"])
def test_transparent_pictures_are_alike(both: Both, signer: Rig, view: str) -> None:
    q = posture(signer, "raised")
    vertices, eye = signer.skin(signer.pose(q)), camera(signer, q, view)
    drawn = both.check(vertices, eye, transparent=True)
    assert drawn[0, 0].tolist() == [0, 0, 0, 0]
    assert drawn[SIZE[1] // 2, SIZE[0] // 2, 3] == 255
    assert ((drawn[..., 3] > 0) & (drawn[..., 3] < 255)).sum() > 0


@pytest.mark.parametrize("samples", [1, 3])
def test_any_number_of_samples_is_alike(opengl: str, signer: Rig, samples: int) -> None:
    q = posture(signer, "raised")
    vertices, eye = signer.skin(signer.pose(q)), camera(signer, q, "front")
    with (
        canvases("software", signer.mesh, [(120, 90)], samples) as ours,
        canvases("opengl", signer.mesh, [(120, 90)], samples) as theirs,
    ):
        Both(ours[0][0], theirs[0][0]).check(vertices, eye)


def test_what_is_behind_the_eye_or_nowhere_is_left_out_by_both(both: Both, signer: Rig) -> None:
    q = posture(signer, "raised")
    vertices = signer.skin(signer.pose(q))
    inside = signer.landmarks.shoulder_middle + np.array([0.0, 0.1, 0.0])
    from_inside = Camera(inside, inside + np.array([-0.1, 0.3, 0.5]), 1.5)
    assert (projected(vertices, from_inside, 10, 10)[0][:, 2] > 0).any()
    drawn = both.check(vertices, from_inside)
    assert np.ptp(drawn.astype(int), axis=(0, 1)).min() > 60
    away = Camera(np.array([0.0, 1.0, 3.0]), np.array([0.0, 1.0, 6.0]), 0.35)
    assert np.ptp(both.check(vertices, away)[0], axis=0).max() == 0, "one colour a row"
    beside = Camera(np.array([0.0, 9.0, 3.0]), np.array([0.0, 9.0, 0.0]), 0.35)
    both.check(vertices, beside)


def test_frames_are_the_same_whichever_thread_asks_for_them(
    opengl: str, clip: Clip, signer: Rig
) -> None:
    look = Look((120, 90), ("front", "face"), samples=1, renderer="opengl")
    scene = Scene(clip, signer, look)
    with scene.canvases() as (own,):
        one = [scene.frame(i, own) for i in range(5)]
    assert all((a == b).all() for a, b in zip(one, scene.frames(), strict=True))
    ours = Scene(clip, signer, Look((120, 90), ("front", "face"), samples=1))
    for a, b in zip(one, ours.frames(), strict=True):
        check_alike(a, b)


def test_a_film_that_is_given_up_leaves_no_context_behind(
    opengl: str, clip: Clip, signer: Rig
) -> None:
    before = set(threading.enumerate())
    frames = Scene(clip, signer, Look((64, 64), renderer="opengl")).frames()
    assert isinstance(frames, Generator)
    next(frames)
    assert any(thread.name.startswith("opengl") for thread in threading.enumerate())
    frames.close()
    assert set(threading.enumerate()) <= before


MEMORY = """
import numpy as np
from azee.export.pictures.camera import camera
from azee.export.pictures.renderer import canvases
from azee_rig.load import load_rig
rig = load_rig("signer")
vertices, eye = rig.skin(rig.pose(rig.coordinates.idle)), camera(rig, rig.coordinates.idle, "front")
for round in range(12):
    with canvases("opengl", rig.mesh, [(640, 360)], 2) as (own,):
        own[0].draw(vertices, eye)
    with open("/proc/self/statm") as file:
        print(int(file.read().split()[1]) * 4096 // 1_000_000)
"""


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory is read from /proc")
def test_contexts_give_back_what_they_hold(opengl: str, python: Python) -> None:
    megabytes = [int(line) for line in python("-c", MEMORY, expect=0).stdout.split()]
    assert megabytes[-1] - megabytes[3] < 200


def test_an_error_in_the_thread_of_the_context_reaches_who_asked(opengl: str) -> None:
    with OpenGL() as there, pytest.raises(ZeroDivisionError):
        there.run(lambda: 1 // 0)


def test_a_picture_beyond_what_the_driver_draws_is_refused(opengl: str, signer: Rig) -> None:
    with OpenGL() as there:
        there.most = 256
        with pytest.raises(NoOpenGLError, match="draws at most 128 pixels each way"):
            OpenGLCanvas(there, signer.mesh, (64, 129), 2)
        OpenGLCanvas(there, signer.mesh, (64, 128), 2).close()


@pytest.mark.long
def test_the_command_draws_by_opengl_and_says_by_whose(
    opengl: str,
    clip: Clip,
    signer: Rig,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    save_clip(clip, signer, "w.npz")
    drawn: list[str] = []

    def noted(self: OpenGLCanvas, *given: Any) -> Pixels:
        drawn.append("OpenGL")
        return draw(self, *given)

    draw = OpenGLCanvas.draw
    monkeypatch.setattr(OpenGLCanvas, "draw", noted)
    small = ["--size", "160x120", "--at", "0.1s"]
    asked = ["--renderer", "opengl"]
    assert run(["render", "w.npz", *small, *asked, "-o", "g.png", "-o", "g.webm"]) == 0
    assert f"drawn by OpenGL: {opengl}" in capsys.readouterr().err
    assert len(drawn) == 1 + 5
    assert run(["render", "w.npz", *small, "-o", "s.png"]) == 0
    assert "drawn by" not in capsys.readouterr().err
    check_alike(np.asarray(Image.open("s.png")), np.asarray(Image.open("g.png")))


def test_auto_takes_opengl_only_where_a_graphics_processor_draws(
    opengl: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert resolved("opengl") == ("opengl", f"OpenGL: {opengl}")
    with OpenGL() as there:
        expected = "software" if there.by_software else "opengl"
    assert resolved("auto")[0] == expected
    for words, chosen in ((("no such word",), "opengl"), ((opengl.lower(),), "software")):
        monkeypatch.setattr("azee.export.pictures.opengl.context.SOFTWARE", words)
        assert resolved("auto")[0] == chosen


def test_without_the_package_one_message_names_the_extra(
    clip: Clip,
    signer: Rig,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "moderngl", None)
    save_clip(clip, signer, "w.npz")
    command = ["render", "w.npz", "--size", "64x64", "-o", "w.png"]
    assert run([*command, "--renderer", "opengl"]) == 1
    told = capsys.readouterr().err
    assert "error[not-installed]" in told
    assert "pip install 'azee[gl]'" in told
    assert not Path("w.png").exists()
    assert resolved("auto")[0] == "software"
    assert run(command) == 0, "no renderer is asked for: OpenGL is not looked for"
    with pytest.raises(NoOpenGLError):
        next(Scene(clip, signer, Look((64, 64), renderer="opengl")).frames())


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="EGL is looked for on Linux")
def test_without_a_driver_the_message_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("moderngl", reason="the extra gl is not installed")
    monkeypatch.setenv("GLCONTEXT_LINUX_LIBEGL", "libnothing.so")
    before = threading.active_count()
    with pytest.raises(NoOpenGLError, match=r"no OpenGL 3\.3 here: .*libnothing") as caught:
        resolved("opengl")
    assert "libegl1" in caught.value.remedy
    assert threading.active_count() == before
    assert resolved("auto")[0] == "software"
