"""A storyboard shows each moment from every view."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from azee.export.storyboard import MOST, SIZE, VIEWS, even_choice, write_png
from azee.motion.clip import Clip
from azee_rig.rig import Rig


@pytest.mark.slow
def test_a_column_per_moment_and_a_row_per_view(signer: Rig, tmp_path: Path) -> None:
    c = signer.coordinates
    raised = c.idle.copy()
    raised[c.index["arm_R.flexion"]] = np.radians(100)
    postures = np.array([c.idle, raised, raised + 1e-3, c.idle])
    clip = Clip(np.array([0.0, 0.5, 0.75, 1.0]), postures, (), np.zeros((4, 0)))
    write_png(clip, signer, tmp_path / "b.png", [0.0, 0.01, 0.52, 0.74])
    image = Image.open(tmp_path / "b.png")
    assert image.width == 2 * SIZE[0]
    assert image.height >= len(VIEWS) * SIZE[1]
    pixels = np.asarray(image).astype(int)
    idle, moved = pixels[: SIZE[1], : SIZE[0]], pixels[: SIZE[1], SIZE[0] : 2 * SIZE[0]]
    assert np.abs(idle - moved).max() > 60


@given(st.lists(st.integers(0, 500), unique=True, min_size=1).map(sorted))
def test_an_even_choice_keeps_the_ends(frames: list[int]) -> None:
    chosen = even_choice(frames, MOST)
    assert len(chosen) == min(len(frames), MOST)
    assert (chosen[0], chosen[-1]) == (frames[0], frames[-1])
    assert chosen == sorted(set(chosen))
