"""A storyboard shows each moment from every view."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray
from PIL import Image

from azee.clip.clip import Clip
from azee.export.pictures.storyboard import (
    MOST,
    SAME_RAD,
    SIZE,
    VIEWS,
    telling,
    telling_frames,
    write_png,
)
from azee_rig.rig import Rig


def test_a_clip_without_moments_shows_how_far_it_goes(signer: Rig) -> None:
    c = signer.coordinates
    postures = np.tile(c.idle, (3, 1))
    postures[1, c.index["head.flexion"]] += 0.3
    clip = Clip(np.array([0.0, 0.5, 1.0]), postures, (), np.zeros((3, 0)))
    assert telling_frames(clip, [], MOST) == [0, 1]


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


@given(arrays(float, st.tuples(st.integers(1, 30), st.just(3)), elements=st.floats(-3, 3)))
def test_the_chosen_postures_are_the_least_alike(shapes: NDArray[np.float64]) -> None:
    chosen = telling(shapes, MOST)
    assert chosen[0] == 0
    assert chosen == sorted(set(chosen))
    assert len(chosen) <= MOST
    apart = np.abs(shapes[:, None] - shapes[chosen]).max(axis=2)
    between = [apart[i, k] for i in chosen for k in range(len(chosen)) if chosen[k] != i]
    assert all(gap > SAME_RAD for gap in between)
    left_out = apart.min(axis=1).max()
    assert left_out <= (min(between) if len(chosen) == MOST else SAME_RAD)
