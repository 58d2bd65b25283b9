"""The vector of parameters of a sign, and what it means (Gürel 2010, section 3.2; G1 and G2)."""

from __future__ import annotations

import numpy as np

from azee.clip.blend import repositioned
from azee.clip.parameters import parameters
from azee.clip.recording import Recording
from azee_rig.rotation import about_axis, to_quaternions
from azee_rig.skeleton import Skeleton

JOINTS, FRAMES = 40, 3


def test_forty_joints_have_123_parameters_which_give_their_rotations_back() -> None:
    """G1: p3i+1 … p3i+3 are θz, θx, θy in degrees. G2: L = Lz Lx Ly, G = parent · L."""
    random = np.random.default_rng(3)
    asked = random.uniform(-80.0, 80.0, (FRAMES, JOINTS, 3))
    z, x, y = (np.radians(asked[..., i]) for i in range(3))
    local = about_axis(2, z) @ about_axis(0, x) @ about_axis(1, y)
    parents = np.array([-1, *random.integers(0, np.arange(1, JOINTS))])
    offsets = random.normal(size=(JOINTS, 3))
    skeleton = Skeleton(tuple(f"j{i}" for i in range(JOINTS)), parents, offsets)
    places = np.tile(offsets, (FRAMES, 1, 1))
    recording = Recording(
        skeleton, {}, np.arange(FRAMES) / 30, to_quaternions(local), places
    )  # fmt: skip
    p = parameters(recording)
    assert p.shape == (FRAMES, 123)
    assert np.allclose(p[:, :3], places[:, 0])
    assert np.allclose(p[:, 3:].reshape(FRAMES, JOINTS, 3), asked)
    _, world = recording.frames()
    for i in range(1, JOINTS):
        assert np.allclose(world[:, i], world[:, parents[i]] @ local[:, i])
    assert not repositioned(p)[:, :6].any()
