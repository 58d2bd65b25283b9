"""Kinematics of many postures: against plain numpy, and slopes against differences."""

from __future__ import annotations

import numpy as np
import pytest
from stick_body import stick_body

from azee_rig.rig import Rig
from azee_solver.collisions import segment_distance
from azee_solver.kinematics import Parting, frames


@pytest.mark.parametrize("shape", [(), (3,), (2, 2)])
def test_frames_are_those_of_plain_numpy(shape: tuple[int, ...], signer: Rig) -> None:
    limits = signer.coordinates
    q = np.random.default_rng(5).uniform(limits.lower, limits.upper, (*shape, len(limits)))
    plain, compiled = signer.chain.frames(q), frames(signer.chain, q)
    assert compiled.positions.shape == plain.positions.shape
    np.testing.assert_allclose(compiled.positions, plain.positions, atol=1e-12)
    np.testing.assert_allclose(compiled.rotations, plain.rotations, atol=1e-12)


def test_slopes_of_what_is_not_deep_enough_are_left_out() -> None:
    rig = stick_body()
    pairs, q = rig.capsules.pairs, rig.coordinates.idle[None]
    reach = rig.capsules.radius[pairs].sum(axis=1)
    every = np.arange(len(rig.coordinates))
    parting = Parting(rig, pairs)
    depth, slope = parting.depths(q, reach, every)
    middle = float(np.median(depth))
    again, some = parting.depths(q, reach, every, middle)
    np.testing.assert_array_equal(again, depth)
    np.testing.assert_array_equal(some, np.where((depth > middle)[..., None], slope, 0.0))
    assert np.any(some)


@pytest.mark.parametrize("body", ["sticks", "signer"])
def test_depths_and_their_slopes(body: str, signer: Rig) -> None:
    rig = stick_body() if body == "sticks" else signer
    limits, capsules = rig.coordinates, rig.capsules
    rng = np.random.default_rng(3)
    q = rng.uniform(limits.lower, limits.upper, (4, len(limits)))
    reach = capsules.radius[capsules.pairs].sum(axis=1)
    chosen = np.array(
        [v for v, n in enumerate(limits.names) if n.startswith(("arm_R", "f_arm", "back"))]
    )
    parting = Parting(rig, capsules.pairs)
    depth, slope = parting.depths(q, reach, chosen)

    at = rig.chain.frames(q)
    o, R = at.positions[:, capsules.node], at.rotations[:, capsules.node]
    a, b = (o + (R @ ends[..., None])[..., 0] for ends in (capsules.a, capsules.b))
    i, j = capsules.pairs.T
    assert len(q) > 1
    assert len(chosen) > 5
    for t in range(len(q)):
        gap = segment_distance(a[t, i], b[t, i], a[t, j], b[t, j])
        np.testing.assert_allclose(depth[t], reach - gap, atol=1e-12)

    h = 1e-6
    for n, v in enumerate(chosen.tolist()):
        up, down = q.copy(), q.copy()
        up[:, v] += h
        down[:, v] -= h
        step = parting.depths(up, reach, chosen)[0] - parting.depths(down, reach, chosen)[0]
        wrong = np.abs(step / (2 * h) - slope[:, :, n])
        # Where the nearest points jump from one end to another there is a kink.
        assert np.mean(wrong > 1e-6) < 0.01
