"""Motion on another body: hands where they were, palms as they were turned, no jumps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from azee.cli.main import run
from azee.clip.bvh import read_bvh
from azee.clip.clip import Clip
from azee.clip.retarget import retarget
from azee.clip.retarget_source import measure_clip, measure_recording
from azee.export.formats.bvh import write_bvh
from azee_rig.load import load_rig
from azee_rig.rig import Rig

FRAMES = 40


@pytest.fixture(scope="module")
def clip(signer: Rig) -> Clip:
    """Hands that meet before the body and part again, the head turned, fists that open."""
    c = signer.coordinates
    rest, met = np.array(c.idle), np.array(c.idle)
    for side in "LR":
        for name, degrees in (("arm_{}.flexion", 35), ("arm_{}.rotation", 50),
                              ("f_arm_{}.flexion", 95), ("f_arm_{}.pronation", 60),
                              ("palm_{}.flexion", 20), ("index_{}_1.flexion", 70),
                              ("middle_{}_2.flexion", 90)):  # fmt: skip
            met[c.index[name.format(side)]] = np.radians(degrees)
    met[c.index["head.axial"]] = met[c.index["neck.axial"]] = np.radians(15)
    met[c.index["back_1.flexion"]] = np.radians(8)
    share = 0.5 - 0.5 * np.cos(np.linspace(0, 2 * np.pi, FRAMES))
    q = rest + share[:, None] * (met - rest)
    return Clip(np.arange(FRAMES) / 30, q, (), np.zeros((FRAMES, 0)))


def _hands(rig: Rig, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Wrists from the shoulders' middle in arm lengths, and palms, in the chest's frame."""
    seen = measure_clip(Clip(np.arange(len(q)) / 30, q, (), np.zeros((len(q), 0))), rig)
    return seen.wrists / seen.arm_m, seen.palms


def _turn_deg(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    trace = np.einsum("...ab,...ab->...", a, b)
    return np.asarray(np.degrees(np.arccos(np.clip((trace - 1) / 2, -1, 1))))


@pytest.mark.parametrize("body", ["child", "game"])
def test_hands_stay_where_they_were_on_another_body(signer: Rig, clip: Clip, body: str) -> None:
    other = load_rig(body)
    made = retarget(measure_clip(clip, signer), other)
    places, palms = _hands(signer, clip.coordinates)
    there, turned = _hands(other, made.clip.coordinates)
    assert np.linalg.norm(there - places, axis=-1).max() < 0.03
    assert _turn_deg(turned, palms).max() < 5
    assert np.degrees(np.abs(np.diff(made.clip.coordinates, axis=0)).max()) < 12


def test_a_bvh_under_our_own_names_comes_back(signer: Rig, clip: Clip, tmp_path: Path) -> None:
    """Through nothing but names and places of joints, as any BVH is read."""
    write_bvh(clip, signer, tmp_path / "clip.bvh")
    made = retarget(measure_recording(read_bvh(tmp_path / "clip.bvh")), signer)
    places, palms = _hands(signer, clip.coordinates)
    there, turned = _hands(signer, made.clip.coordinates)
    assert np.linalg.norm(there - places, axis=-1).max() < 0.03
    assert _turn_deg(turned, palms).max() < 5
    c = signer.coordinates
    for name in ("index_L_1.flexion", "middle_R_2.flexion", "head.axial"):
        off = made.clip.coordinates[:, c.index[name]] - clip.coordinates[:, c.index[name]]
        assert np.degrees(np.abs(off).max()) < 8, name


def test_the_command_tells_what_was_kept(
    signer: Rig, clip: Clip, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bvh(clip, signer, tmp_path / "clip.bvh")
    out = tmp_path / "child.npz"
    assert run(["retarget", str(tmp_path / "clip.bvh"), "-o", str(out), "--rig", "child"]) == 0
    assert f"hands are where they were in all {FRAMES} frames" in capsys.readouterr().err
    assert out.exists()
    (tmp_path / "bad.bvh").write_text("HIERARCHY\nROOT a\n", encoding="utf-8")
    assert run(["retarget", str(tmp_path / "bad.bvh"), "-o", str(out)]) == 1
    assert "error[not-a-clip]" in capsys.readouterr().err


def test_a_clip_command_carries_another_skeletons_motion_over(
    signer: Rig, clip: Clip, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = load_rig("game")
    write_bvh(retarget(measure_clip(clip, signer), other).clip, other, tmp_path / "theirs.bvh")
    assert (
        run(["clip", "convert", str(tmp_path / "theirs.bvh"), "-o", str(tmp_path / "x.npz")]) == 0
    )
    said = capsys.readouterr().err
    assert f"carried over to `signer`: hands are where they were in all {FRAMES} frames" in said
