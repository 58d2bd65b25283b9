"""Writing and reading a long clip takes little more room than the arrays and the file."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from small_rig import SMALL, tumbling

from azee.clip.bvh import read_bvh
from azee.clip.clip import Clip
from azee.export.formats import clip_json, moving_body
from azee.export.formats.bvh import write_bvh
from azee.export.formats.clip_json import write_json
from azee.export.formats.glb import write_glb
from azee_rig.rig import Rig

LONG = 2000
"""Frames."""


def long_clip(frames: int = LONG) -> Clip:
    """The small body's movement over and over."""
    q = np.resize(tumbling().coordinates, (frames, tumbling().coordinates.shape[1]))
    return Clip(np.arange(frames) / 30, q, (), np.zeros((frames, 0)))


def peak_of(action: Callable[[], object]) -> int:
    """The most memory that an action takes at any time, bytes."""
    tracemalloc.start()
    action()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


@pytest.mark.parametrize("write", [write_bvh, write_glb, write_json])
@pytest.mark.parametrize("size", [1, 3, 1000])
def test_the_same_bytes_however_many_frames_are_posed_together(
    write: Callable[..., None], size: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(tumbling(), SMALL, tmp_path / "whole")
    monkeypatch.setattr(moving_body, "CHUNK", size)
    monkeypatch.setattr(clip_json, "ROWS", size)
    write(tumbling(), SMALL, tmp_path / "chunks")
    assert (tmp_path / "chunks").read_bytes() == (tmp_path / "whole").read_bytes()


@pytest.mark.long
def test_a_glb_is_not_held_more_than_once(signer: Rig, tmp_path: Path) -> None:
    times = np.arange(LONG) / 30
    q = signer.coordinates.idle + 0.1 * np.sin(times[:, None])
    clip = Clip(times, q, (), np.zeros((LONG, 0)))
    write_glb(Clip(times[:2], q[:2], (), np.zeros((2, 0))), signer, tmp_path / "body.glb")
    peak = peak_of(lambda: write_glb(clip, signer, tmp_path / "long.glb"))
    rotations = LONG * len(signer.skeleton.names) * 4 * 8
    assert peak < 3 * (rotations + (tmp_path / "long.glb").stat().st_size)


def test_json_is_not_made_of_lists_of_all_frames(tmp_path: Path) -> None:
    clip = long_clip()
    peak = peak_of(lambda: write_json(clip, SMALL, tmp_path / "long.json"))
    arrays = LONG * len(SMALL.skeleton.names) * (4 + 3) * 8
    assert peak < 2 * arrays + 1e6


def test_reading_bvh_keeps_neither_text_nor_rows(tmp_path: Path) -> None:
    write_bvh(long_clip(), SMALL, tmp_path / "long.bvh")
    peak = peak_of(lambda: read_bvh(tmp_path / "long.bvh"))
    arrays = LONG * len(SMALL.skeleton.names) * (4 + 3) * 8
    text = (tmp_path / "long.bvh").stat().st_size
    assert peak < 2.8 * (arrays + text)
