from __future__ import annotations

import numpy as np
import pytest

from azee_rig.mesh import vertex_normals
from azee_rig.rig import Rig
from azee_rig.skin import joint_frames


def test_skin_at_bind_is_the_mesh(signer: Rig) -> None:
    posed = signer.skin(signer.pose(signer.coordinates.bind))
    np.testing.assert_allclose(posed, signer.mesh.vertices, atol=1e-14)


def test_the_mesh_is_whole(signer: Rig) -> None:
    mesh = signer.mesh
    assert mesh.joints.shape == mesh.weights.shape
    assert mesh.weights.shape[1] <= 8
    np.testing.assert_allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-12)
    assert mesh.joints.max() < len(signer.skeleton.names) == mesh.joint_count
    assert mesh.triangles.max() < len(mesh.vertices)
    assert np.unique(mesh.triangles).size == len(mesh.vertices)
    stops = [0, *(p.stop for p in mesh.parts)]
    assert [p.start for p in mesh.parts] == stops[:-1]
    assert stops[-1] == len(mesh.triangles)
    assert abs(mesh.vertices[:, 1].min()) < 0.02, "the soles are on the ground"
    assert mesh.units == signer.units


def test_normals_are_unit_and_look_outward(signer: Rig) -> None:
    mesh = signer.mesh
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-6)
    top = mesh.vertices[:, 1].argmax()
    assert mesh.normals[top, 1] > 0.9


def test_normals_of_a_square() -> None:
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    normals = vertex_normals(square, np.array([[0, 1, 2], [0, 2, 3]]))
    np.testing.assert_allclose(normals, np.tile([0.0, 0.0, 1.0], (4, 1)))


@pytest.mark.long
def test_skin_is_linear_blending(signer: Rig) -> None:
    """Σ_j w_j (R_j (v − p̄_j) + p_j), with a matrix of weights, in any posture and with a face."""
    random = np.random.default_rng(5)
    c, mesh = signer.coordinates, signer.mesh
    pose = signer.pose(random.uniform(c.lower, c.upper))
    face = random.uniform(-0.5, 1.0, len(signer.units))
    positions, rotations = joint_frames(signer.skeleton, pose)
    away = mesh.shaped(face)[:, None] - signer.skeleton.rest_positions
    each = np.einsum("jab,njb->nja", rotations, away) + positions
    expected = np.einsum("nj,nja->na", mesh.dense_weights, each)
    np.testing.assert_allclose(signer.skin(pose, face), expected, atol=1e-12)


def test_eyes_turn_their_balls_and_nothing_else(signer: Rig) -> None:
    q = np.array(signer.coordinates.idle)
    before = signer.skin(signer.pose(q))
    q[signer.coordinates.index["eye_L.yaw"]] = np.radians(20)
    moved = np.linalg.norm(signer.skin(signer.pose(q)) - before, axis=1) > 1e-9
    part = next(p for p in signer.mesh.parts if p.name == "eyes")
    eyes = np.unique(signer.mesh.triangles[part.start : part.stop])
    assert moved.any()
    assert set(np.flatnonzero(moved)) <= set(eyes[signer.mesh.vertices[eyes, 0] > 0])


def test_brows_ride_the_skin(signer: Rig) -> None:
    part = next(p for p in signer.mesh.parts if p.name == "brows")
    brows = np.unique(signer.mesh.triangles[part.start : part.stop])
    idle = signer.pose(signer.coordinates.idle)
    still = signer.skin(idle)[brows]
    up = signer.skin(idle, signer.face_morphs["AU1"])[brows]
    down = signer.skin(idle, signer.face_morphs["AU4"])[brows]
    inner = np.abs(still[:, 0]) < 0.022
    assert (up - still)[inner, 1].mean() > 0.003
    assert (down - still)[:, 1].mean() < -0.003


def test_lids_follow_the_eyes(signer: Rig) -> None:
    q = np.array(signer.coordinates.idle)
    assert all(float(w) == 0.0 for w in signer.lid_weights(q).values())
    q[signer.coordinates.index["eye_L.pitch"]] = np.radians(-20)
    weights = signer.lid_weights(np.stack([q, signer.coordinates.idle]))
    assert weights["eyeLookDownLeft"][0] > 0.7
    assert weights["eyeLookDownLeft"][1] == 0.0
    assert weights["eyeLookDownRight"][0] == weights["eyeLookUpLeft"][0] == 0.0
