from __future__ import annotations

import numpy as np
import pytest
from capsule_gaps import POSTURES, gaps, posture, segment_distance
from numpy.typing import NDArray

from azee_rig.rig import Rig

Floats = NDArray[np.float64]
FINGER_TOUCH_M = 0.006
"""Fingers that lie on each other press into their capsules by so much."""


@pytest.mark.parametrize("name", ["bind", "idle"])
def test_nothing_overlaps_at_rest(signer: Rig, name: str) -> None:
    q = getattr(signer.coordinates, name)
    assert gaps(signer, q, signer.capsules.pairs).min() > 0.0
    assert gaps(signer, q, signer.capsules.finger_pairs).min() > -0.001


@pytest.mark.parametrize("name", POSTURES["hands"])
def test_hand_postures_are_free(signer: Rig, name: str) -> None:
    q = posture(signer, POSTURES["hands"][name])
    assert gaps(signer, q, signer.capsules.pairs).min() > 0.0
    assert gaps(signer, q, signer.capsules.finger_pairs).min() > -FINGER_TOUCH_M


@pytest.mark.parametrize("name", ["both arms raised", "both arms forward and up"])
def test_raised_arms_are_free(signer: Rig, name: str) -> None:
    q = posture(signer, POSTURES["arms"][name])
    assert gaps(signer, q, signer.capsules.pairs).min() > 0.0


def test_a_hand_inside_the_trunk_is_seen(signer: Rig) -> None:
    inside = {
        "arm_R.flexion": 0,
        "arm_R.abduction": -25,
        "arm_R.rotation": 60,
        "f_arm_R.flexion": 90,
    }
    found = gaps(signer, posture(signer, inside), signer.capsules.pairs)
    names = signer.capsules.names
    deep = {
        (names[i], names[j])
        for (i, j), gap in zip(signer.capsules.pairs, found, strict=True)
        if gap < -0.02
    }
    assert any(a.startswith(("forearm_R", "hand_R")) and b.startswith("trunk") for a, b in deep)


def test_they_fit_the_mesh(signer: Rig) -> None:
    """Most of the skin of trunk, head, forearms and hands is within 12 mm of a capsule's."""
    capsules, mesh = signer.capsules, signer.mesh
    frames = signer.chain.frames(signer.coordinates.bind)
    nearest = np.full(len(mesh.vertices), np.inf)
    for k in range(len(capsules.names)):
        R, p = frames.rotations[capsules.node[k]], frames.positions[capsules.node[k]]
        a, b = p + R @ capsules.a[k], p + R @ capsules.b[k]
        t = np.clip((mesh.vertices - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        away = np.linalg.norm(mesh.vertices - a - t[:, None] * (b - a), axis=1) - capsules.radius[k]
        nearest = np.minimum(nearest, away)
    carried = np.array(signer.skeleton.names)[mesh.joints[:, 0]]
    for part, limit in (
        ("spine0", 0.020),
        ("lowerarm", 0.012),
        ("wrist", 0.012),
        ("finger", 0.006),
    ):
        skin = np.char.startswith(carried, part)
        assert np.percentile(nearest[skin], 90) < limit, part


def test_pairs_are_listed_once(signer: Rig) -> None:
    for pairs in (signer.capsules.pairs, signer.capsules.finger_pairs):
        listed = {frozenset(pair) for pair in pairs.tolist()}
        assert len(listed) == len(pairs)
        assert all(len(pair) == 2 for pair in listed)
    names = signer.capsules.names
    base = {frozenset((names[i], names[j])) for i, j in signer.capsules.pairs}
    for pair in (
        ("forearm_L", "forearm_R"),
        ("hand_L_radial", "hand_R_ulnar"),
        ("hand_L_ulnar", "forearm_R"),
        ("hand_R_radial", "upper_arm_L"),
        ("hand_R_radial", "face"),
        ("upper_arm_L", "trunk_3"),
    ):
        assert frozenset(pair) in base


def test_distance_of_segments() -> None:
    x, y, z = np.eye(3)
    assert segment_distance(-x, x, z - y, z + y) == pytest.approx(1.0)
    assert segment_distance(0 * x, x, 3 * x, 4 * x) == pytest.approx(2.0)
    assert segment_distance(0 * x, x, y, x + y) == pytest.approx(1.0)
