"""Skin on four joints a vertex moves as skin on eight does, as nearly as it can."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from azee_rig.build.influences import with_four_influences
from azee_rig.mesh import BodyMesh, Part
from azee_rig.rig import Rig
from azee_rig.skeleton import Pose, Skeleton
from azee_rig.skin import skin

JOINTS = 7


@pytest.fixture
def spine() -> Skeleton:
    """Seven joints in a row, 10 cm apart."""
    offsets = np.tile([0.0, 0.1, 0.0], (JOINTS, 1))
    return Skeleton(tuple("abcdefg"), np.arange(-1, JOINTS - 1), offsets)


@pytest.fixture
def sleeve() -> BodyMesh:
    """Points around the row, each on all joints, the nearer the more."""
    random = np.random.default_rng(3)
    vertices = random.uniform([-0.1, 0.1, -0.1], [0.1, 0.7, 0.1], (60, 3))
    heights = 0.1 * np.arange(1, JOINTS + 1)
    weights = np.exp(-((vertices[:, 1:2] - heights) ** 2) / 0.02)
    triangles = np.arange(60).reshape(20, 3)
    return BodyMesh(
        vertices=vertices,
        triangles=triangles,
        parts=(Part("sleeve", 0, 20, (1.0, 1.0, 1.0, 1.0), 1.0),),
        colours=np.ones((60, 3)),
        joints=np.tile(np.arange(JOINTS), (60, 1)),
        weights=weights / weights.sum(axis=1, keepdims=True),
        units=(),
        unit_start=np.zeros(1, np.int64),
        unit_rows=np.zeros(0, np.int64),
        unit_deltas=np.zeros((0, 3)),
        joint_count=JOINTS,
    )


def _bends(count: int, seed: int) -> Pose:
    random = np.random.default_rng(seed)
    turns = np.concatenate(
        [np.ones((count, JOINTS, 1)), random.normal(scale=0.15, size=(count, JOINTS, 3))], axis=-1
    )
    turns /= np.linalg.norm(turns, axis=-1, keepdims=True)
    return Pose(np.zeros((count, 3)), turns)


def _one(poses: Pose, i: int) -> Pose:
    return Pose(poses.root_translation[i], poses.rotations[i])


def _apart(a: BodyMesh, b: BodyMesh, skeleton: Skeleton, pose: Pose) -> NDArray[np.float64]:
    moved = skin(a, skeleton, pose) - skin(b, skeleton, pose)
    return np.asarray(np.linalg.norm(moved, axis=1))


def test_four_weights_that_sum_to_one(sleeve: BodyMesh, spine: Skeleton) -> None:
    fitted = with_four_influences(sleeve, spine, _bends(30, 1))
    assert fitted.weights.shape == fitted.joints.shape == (60, 4)
    assert fitted.weights.min() >= 0
    np.testing.assert_allclose(fitted.weights.sum(axis=1), 1)
    assert (np.diff(fitted.weights, axis=1) <= 0).all()


def test_it_stays_nearer_than_dropping_the_lightest(sleeve: BodyMesh, spine: Skeleton) -> None:
    """On postures that it was not fitted to."""
    fitted = with_four_influences(sleeve, spine, _bends(30, 1))
    order = np.argsort(-sleeve.weights, axis=1)[:, :4]
    kept = np.take_along_axis(sleeve.weights, order, axis=1)
    dropped = replace(sleeve, joints=order, weights=kept / kept.sum(axis=1, keepdims=True))
    others = _bends(20, 2)
    ours, theirs = (
        np.mean([_apart(sleeve, mesh, spine, _one(others, i)) ** 2 for i in range(20)])
        for mesh in (fitted, dropped)
    )
    assert ours < 0.9 * theirs


def test_vertices_on_four_joints_stay_as_they_are(sleeve: BodyMesh, spine: Skeleton) -> None:
    few = np.where(np.arange(JOINTS) < 4, sleeve.weights, 0)
    few /= few.sum(axis=1, keepdims=True)
    given = replace(sleeve, weights=few)
    fitted = with_four_influences(given, spine, _bends(30, 1))
    np.testing.assert_array_equal(fitted.dense_weights, given.dense_weights)


def test_the_signer_needs_no_more_than_four(signer: Rig) -> None:
    """Viewers that read only the first four joints of a vertex see the body that we see."""
    assert (signer.mesh.weights > 0).sum(axis=1).max() <= 4
