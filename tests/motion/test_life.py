"""Life moves every coordinate a little, never jumps, and depends on the seed alone."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.motion.overlay.life import BREATH_S, life
from azee_rig.load import load_rig

RIG = load_rig()
IDLE = np.asarray(RIG.coordinates.idle)


def lived(seconds: float, fps: float = 60.0, seed: int = 0) -> NDArray[np.float64]:
    times = np.arange(round(seconds * fps)) / fps
    return life(RIG, np.tile(IDLE, (len(times), 1)), times, seed)


def test_the_seed_alone_decides() -> None:
    assert np.array_equal(lived(3.0), lived(3.0))
    assert not np.array_equal(lived(3.0), lived(3.0, seed=1))


def test_every_coordinate_moves_a_little() -> None:
    degrees = np.degrees(lived(60.0))
    spread = degrees.std(axis=0)
    assert spread.min() > 0.05
    assert spread.max() < 1.5
    assert np.abs(degrees).max() < 5.0


def test_it_is_smooth() -> None:
    q = lived(20.0)
    speed = np.degrees(np.abs(np.diff(q, axis=0))).max() * 60.0
    power = np.abs(np.fft.rfft(q - q.mean(axis=0), axis=0)) ** 2
    hz = np.fft.rfftfreq(len(q), 1 / 60.0)
    assert speed < 25.0
    assert power[hz > 4.0].sum() < 0.01 * power.sum()


def test_breath_comes_about_as_often_as_a_breath() -> None:
    q = lived(120.0)
    chest = q[:, RIG.coordinates.index["clav_L.elevation"]]
    other = q[:, RIG.coordinates.index["clav_R.elevation"]]
    both = chest + other
    power = np.abs(np.fft.rfft(both - both.mean())) ** 2
    hz = np.fft.rfftfreq(len(both), 1 / 60.0)
    breaths = (hz > 0.6 / BREATH_S) & (hz < 1.6 / BREATH_S)
    assert power[breaths].sum() > 0.4 * power.sum()


def test_head_and_trunk_follow_the_hands() -> None:
    fps, index = 60.0, RIG.coordinates.index
    times = np.arange(240) / fps
    q = np.tile(IDLE, (len(times), 1))
    raised = q.copy()
    for side in "LR":
        raised[120:, index[f"arm_{side}.flexion"]] += 1.0
    change = life(RIG, raised, times, 0) - life(RIG, q, times, 0)
    assert change[-1, index["head.flexion"]] - change[0, index["head.flexion"]] < -0.01
    fingers = [i for name, i in index.items() if name.startswith(("index", "thumb"))]
    assert change[:, fingers] == pytest.approx(0.0)


def test_a_clip_of_one_frame_lives() -> None:
    assert lived(1 / 60.0).shape == (1, len(IDLE))
