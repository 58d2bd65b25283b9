"""Depths of capsules along movements: against segments in numpy, and slopes against differences."""

from __future__ import annotations

import numpy as np
import pytest
from stick_body import stick_body

from azee_rig.rig import Rig
from azee_solver.collisions import segment_distance
from azee_solver.parting import Parting


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

    frames = rig.chain.frames(q)
    o, R = frames.positions[:, capsules.node], frames.rotations[:, capsules.node]
    a, b = (o + (R @ ends[..., None])[..., 0] for ends in (capsules.a, capsules.b))
    i, j = capsules.pairs.T
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
