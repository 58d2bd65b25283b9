"""Bones that a trill swings: how often, how far, about which axis."""

from __future__ import annotations

import math

import numpy as np
import pytest
from played_scores import TIP, S, at, block, frame_at, played, results, rig, sync

from azee_solver.constraint import (
    Trill,
)
from azee_solver.geometry import (
    Bone,
    Dir,
    Vec,
)


def test_a_trill_swings_as_often_and_as_far_as_it_says_and_fades() -> None:
    trill = Trill(Bone("f_arm", S), Dir(Bone("f_arm", S)), 4.0, math.radians(8))
    score = sync(block("T", "0", "1", trill), block("P", "0", "1", at(TIP, 0, 0, 0)))
    animation = played(score, fps=120.0)
    plain = played(sync(block("P", "0", "1", at(TIP, 0, 0, 0))), fps=120.0)
    q, base = animation.clip.coordinates, plain.clip.coordinates
    swing = q - base
    column = rig().coordinates.index["f_arm_R.pronation"]
    assert results(animation)["T trill"].met
    assert results(animation)["P place"].met
    rows = slice(frame_at(animation, 0.15), frame_at(animation, 0.86))
    inside, times = swing[rows, column], animation.clip.times[rows]
    # Least squares: sine and cosine of 4 Hz explain all of it, with the whole amplitude.
    waves = np.stack([f(2 * math.pi * 4.0 * times) for f in (np.sin, np.cos)], axis=1)
    parts = np.linalg.lstsq(waves, inside, rcond=None)[0]
    assert np.linalg.norm(parts) == pytest.approx(math.radians(8), rel=0.02)
    assert np.abs(inside - waves @ parts).max() < 0.02 * math.radians(8)
    assert np.abs(inside).max() == pytest.approx(math.radians(8), rel=0.02)
    before = np.flatnonzero(np.diff(np.sign(inside)) != 0)
    share = inside[before] / (inside[before] - inside[before + 1])
    crossings = times[before] + share * (times[before + 1] - times[before])
    assert len(crossings) in (5, 6)
    assert np.diff(crossings) == pytest.approx(1 / (2 * 4.0), rel=0.02)
    assert np.abs(swing[frame_at(animation, 0.0)]).max() < 1e-9
    rising = swing[frame_at(animation, 0.0) : frame_at(animation, 0.06), column]
    assert np.abs(rising).max() < math.radians(5)
    assert np.abs(swing[frame_at(animation, 1.0)]).max() < 1e-9


@pytest.mark.parametrize("axis", [Vec(1, 0, 0), Vec(0, 2, 0), Dir(Bone("f_arm", S))], ids=str)
def test_a_trill_turns_about_a_fixed_axis_of_the_bone_before(axis: Vec | Dir) -> None:
    """An axis without bones in it is carried along; how long it is does not matter."""
    score = sync(
        block("T", "0", "1", Trill(Bone("palm", S), axis, 2.5, math.radians(6))),
        block("P", "0", "1", at(TIP, 0, 0, 0)),
    )
    animation, plain = played(score, fps=60.0), played(sync(score.blocks[1]), fps=60.0)
    row = frame_at(animation, 0.5)
    before, after = (
        rig().chain.frames(made.clip.coordinates[row : row + 1]).rotations[0]
        for made in (plain, animation)
    )
    bones = rig().bones
    palm, parent = bones["palm_R"].node, int(rig().chain.parents[bones["palm_R"].origin_node])
    turn = after[palm] @ before[palm].T
    if isinstance(axis, Vec):
        wanted = before[parent] @ np.sign([axis.x, axis.y, axis.z])
    else:
        wanted = before[bones["f_arm_R"].node][:, 1]
    skew = (turn - turn.T) / 2
    spin = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
    # Sine 2π 2.5 · 0.5 = 1: half-way the palm is turned by the whole amplitude.
    assert abs(spin @ wanted) == pytest.approx(math.sin(math.radians(6)), rel=0.03)
    assert np.linalg.norm(spin) == pytest.approx(abs(spin @ wanted), rel=0.02)
