"""The player page, its export and its element in a browser that is not ours."""

from __future__ import annotations

import importlib.util
import json
import os
import statistics
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from programs import Node
from served import Served, web_server

import azee
from azee.player.export import NotAnExportError, export_page
from azee.player.idle import LOOP_S
from azee.player.vocabularies import letters, texts
from azee_rig.rig import Rig

ROOT = Path(__file__).parents[2]
FPS = 30
FASTEST_M_S = 4.0
DROP_M = 0.15
"""By how much a hand may go down between two letters."""

pytestmark = pytest.mark.slow


def _pictures(tmp_path: Path) -> Path:
    """Where pictures go: a folder that PLAYER_PICTURES names, for looking at them."""
    folder = Path(os.environ.get("PLAYER_PICTURES", tmp_path / "pictures"))
    folder.mkdir(exist_ok=True)
    return folder


def _fastest_m_s(frames: Sequence[Mapping[str, Any]]) -> float:
    """Speed of the right wrist between frames; a jump would be far above any hand's."""
    places = np.array([frame["wrist"] for frame in frames])
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).max() * FPS)


def _runs(values: Sequence[Any]) -> list[Any]:
    """Return values without those that are as the one before."""
    return [v for n, v in enumerate(values) if n == 0 or v != values[n - 1]]


def test_a_person_uses_the_page(browser: Node, tmp_path: Path) -> None:
    """An idle loop, typed text, the loop ends, signs are named, idle again; view, speed, body."""
    pictures = _pictures(tmp_path)
    with Served(tmp_path, "play", "--page", "HELLO") as server:
        seen = json.loads(browser("player_page.mjs", server.url, pictures))
        code, said = server.ended()
        assert (code, said.strip()) == (130, "")
    (complaint,) = seen["complaints"]
    assert "422" in complaint, "of a text with a mistake, as it should be"
    assert seen["foreign"] == []

    frames = seen["frames"]
    assert _runs([f["state"] for f in frames]) == ["waiting", "playing", "idle"]
    signs = _runs([f["sign"] for f in frames])
    assert [sign for sign in signs if sign in ("H", "I")] == ["H", "I"]
    assert signs[-1] == "idle"
    first = next(n for n, f in enumerate(frames) if f["state"] == "playing")
    assert frames[first - 1]["idle"] == pytest.approx(LOOP_S, abs=1 / FPS), "the loop was cut"
    assert frames[first]["time"] < 1 / FPS
    assert frames[-1]["idle"] == pytest.approx(0.3, abs=1.1 / FPS)
    assert _fastest_m_s(frames) < FASTEST_M_S
    assert seen["told"] == ["the manual alphabet of ASL has no `!`; it is left out"]

    home, turned, tilted, rolled, back, away, again = seen["views"]
    assert turned == pytest.approx([home[0] - 0.5, *home[1:]])
    assert tilted == pytest.approx([turned[0], turned[1] + 0.25, *turned[2:]])
    assert rolled == pytest.approx([*tilted[:2], tilted[2] - 1 / 3, tilted[3]])
    assert back == pytest.approx([home[0], *rolled[1:]])
    assert away[3] > back[3] * 1.2
    assert again == home

    assert seen["inaccessible"] == []
    assert seen["mistake"] == ["2:1: there is no rule `:nobody`"]
    assert seen["slow"] == pytest.approx(0.1, abs=1e-6)
    assert all(scrolled <= int(width) for width, scrolled in seen["widths"].items())
    assert seen["french"] == ["Jouer", "ami", 0]
    print(f"\n{statistics.median(seen['frames_ms']):.1f} ms a frame at 480 x 504: {seen['device']}")
    for path in pictures.glob("*.png"):
        with Image.open(path) as picture:
            assert np.asarray(picture.convert("L")).std() > 15, f"{path.name} shows nothing"


def test_an_exported_page_joins_letters_without_a_server(
    browser: Node, signer: Rig, tmp_path: Path
) -> None:
    """Only letters that are typed are fetched, once; between them hands stay up."""
    folder = tmp_path / "page"
    few = letters("asl", signer, "ABL")
    count = export_page(folder, signer, [few, texts([], signer)], text="lab")
    assert count == 3
    with web_server(folder) as url:
        arguments = (url, "b é al", _pictures(tmp_path) / "folder.png")
        seen = json.loads(browser("player_folder.mjs", *arguments))
    assert (seen["complaints"], seen["foreign"], seen["quit"]) == ([], [], False)
    assert (seen["clips"], seen["again"]) == (3, 0)
    assert seen["told"] == ["Not known, left out: é"]
    frames = [f for f in seen["frames"] if f["state"] == "playing"]
    assert [s for s in _runs([f["sign"] for f in frames]) if len(s) == 1] == ["B", "A", "L"]
    signs = [f["sign"] for f in frames]
    between = frames[signs.index("B") : signs.index("L")]
    heights = [f["wrist"][1] for f in between]
    assert max(heights) - min(heights) < DROP_M
    assert _fastest_m_s(seen["frames"]) < FASTEST_M_S


def test_the_gallery_plays_clips_as_the_body_moves(browser: Node, tmp_path: Path) -> None:
    """Joints are where the rig has them at the clip's frames, within the steps of a web clip."""
    spec = importlib.util.spec_from_file_location("gallery", ROOT / "docs" / "gallery.py")
    assert spec is not None
    assert spec.loader is not None
    gallery = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(gallery)
    example = tmp_path / "arbre.azee"
    example.write_text(":arbre\n", encoding="utf-8")
    gallery.build(tmp_path, [example])
    made = azee.compile(example)
    frames = [0, len(made.clip.times) // 2, len(made.clip.times) - 1]
    times = [float(made.clip.times[n] - made.clip.times[0]) for n in frames]
    with web_server(tmp_path) as url:
        arguments = (url, ",".join(map(str, times)), _pictures(tmp_path) / "gallery.png")
        seen = json.loads(browser("player_element.mjs", *arguments))
    assert seen["foreign"] == []
    (complaint,) = seen["complaints"]
    assert complaint == 'azee-player: speed="7" has no meaning: a number from 0.1 to 2'
    assert seen["duration"] == pytest.approx(made.clip.duration_s, abs=1e-5)
    assert (seen["state"], seen["paused"], seen["speed"]) == ("playing", True, 1)
    rig = made.rig
    for frame, joints in zip(frames, seen["joints"], strict=True):
        positions = rig.joint_positions(rig.pose(made.clip.coordinates[frame]))
        for name, place in joints.items():
            expected = positions[rig.skeleton.names.index(name)]
            np.testing.assert_allclose(place, expected, atol=1e-3, err_msg=name)
    hips = rig.skeleton.names[0]
    shift = np.subtract(seen["moved"][hips], seen["joints"][-1][hips])
    np.testing.assert_allclose(shift, (0.5, 0.0, 0.0), atol=5e-3)
    assert set(seen["names"]) >= {"arbre"}
    assert "Drag to turn the signer" in seen["text"]
    print(f"\n{statistics.median(seen['frames_ms']):.1f} ms a frame: {seen['device']}")


def test_an_export_replaces_an_older_one_and_nothing_else(signer: Rig, tmp_path: Path) -> None:
    few = letters("asl", signer, "A")
    folder = tmp_path / "page"
    for _ in range(2):
        assert export_page(folder, signer, [few]) == 1
    catalogue = json.loads((folder / "catalogue.json").read_text(encoding="utf-8"))
    assert catalogue["sources"][0]["signs"] == {"A": "sign/0-0.azwc"}
    named = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert named >= {"index.html", "azee-player.js", "vendor-three.js", "LICENSES.md"}
    assert named >= {"body/signer.glb", "idle/signer.azwc", "sign/0-0.azwc"}
    assert not any("studio" in name or "editor" in name for name in named)
    other = tmp_path / "thesis"
    other.mkdir()
    (other / "chapter.tex").write_text("years of work")
    with pytest.raises(NotAnExportError, match="holds something else"):
        export_page(other, signer, [few])
    assert (other / "chapter.tex").read_text() == "years of work"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["page", "thesis"]
