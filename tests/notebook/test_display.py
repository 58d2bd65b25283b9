"""Objects in a notebook: what they show, that a player of GLB plays, and the example notebook."""

from __future__ import annotations

import json
import re
import sys
from html import unescape
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
from PIL import Image
from programs import Node

import azee
from azee.notebook import display
from azee.notebook.registration import SHOWN
from azee.notebook.view import page
from azee_rig.rig import Rig

ROOT = Path(__file__).parents[2]
NOTEBOOK = ROOT / "examples" / "notebook" / "azee.ipynb"


@pytest.fixture(scope="module")
def made() -> azee.Compilation:
    return azee.compile("key .4 (place @I_TIP(s) @CH)\n")


@pytest.mark.long
def test_each_kind_shows_itself(made: azee.Compilation, signer: Rig) -> None:
    assert str(display.score(made.score)["image/svg+xml"]).startswith("<svg")
    whole = str(display.compilation(made)["text/html"])
    assert all(part in whole for part in ("<svg", "<iframe", "data:image/png", "place @I_TIP(s)"))
    assert "1 constraint is met" in str(display.report(made.report)["text/plain"])
    assert "<iframe" in str(display.clip(made.clip)["text/html"])
    assert "44 bones" in str(display.rig(signer)["text/plain"])


def test_ipython_is_told_by_name_and_not_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    told = {}

    def note(module: str, name: str, show: object) -> None:
        told[module, name] = show

    formatter = SimpleNamespace(for_type_by_name=note)
    shell = SimpleNamespace(display_formatter=SimpleNamespace(mimebundle_formatter=formatter))
    azee.load_ipython_extension(shell)
    assert set(told) == set(SHOWN)
    for module, name in SHOWN:
        found = sys.modules.get(module) or __import__(module, fromlist=[name])
        assert isinstance(found, ModuleType)
        assert isinstance(getattr(found, name), type)


def test_a_mistake_is_shown_as_check_shows_it() -> None:
    with pytest.raises(azee.AZeeError) as caught:
        azee.compile(":nobody\n")
    assert caught.value._render_traceback_()[0] == "error[unknown-rule]: there is no rule `:nobody`"


@pytest.mark.slow
def test_the_player_plays_what_the_body_does(
    made: azee.Compilation, browser: Node, tmp_path: Path
) -> None:
    """Joints are where the rig has them, the picture moves, and nothing is fetched."""
    clip, rig = made.clip, made.rig
    document = tmp_path / "page.html"
    document.write_text(page(clip, rig, made.animation.key_times), encoding="utf-8")
    frames = [0, len(clip.times) // 2]
    times = [float(clip.times[frame]) for frame in frames]
    pictures = [tmp_path / f"{frame}.png" for frame in frames]
    found = json.loads(browser("notebook_view.mjs", document, ",".join(map(str, times)), *pictures))
    assert found["played"]
    assert not found["hidden"]
    assert (found["error"], found["complaints"], found["asked"]) == (0, [], [])
    assert found["shown"] == f"{times[1]:.2f} s"
    for frame, joints in zip(frames, found["joints"], strict=True):
        positions = rig.joint_positions(rig.pose(clip.coordinates[frame]))
        for name, place in joints.items():
            node = rig.skeleton.names.index(name)
            np.testing.assert_allclose(place, positions[node], atol=1e-3, err_msg=name)
    still, moved = (np.asarray(Image.open(p).convert("RGB"), dtype=float) for p in pictures)
    ground = still[5, 5]
    body = np.mean(np.abs(still[:470, :560] - ground).max(axis=2) > 20)
    assert 0.1 < body < 0.6
    assert 0.005 < np.mean(np.abs(still - moved).max(axis=2) > 40) < 0.3


@pytest.mark.slow
def test_the_example_notebook_runs(tmp_path: Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells), "outputs are not kept"
    client = nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3",
                                     resources={"metadata": {"path": str(tmp_path)}})  # fmt: skip
    client.execute()
    data = [o["data"] for cell in notebook.cells for o in cell.get("outputs", ()) if "data" in o]
    assert sum("image/svg+xml" in d for d in data) == 1
    players = [d["text/html"] for d in data if "<iframe" in d.get("text/html", "")]
    assert len(players) == 2
    inside = re.search(r'srcdoc="([^"]*)"', players[0])
    assert inside is not None
    assert unescape(inside[1]).startswith("<!doctype html>")
    assert (tmp_path / "sentence.glb").stat().st_size > 100_000
