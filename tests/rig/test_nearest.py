"""The nearest points of a surface: against trimesh, on any triangles, flat ones among them."""

from __future__ import annotations

import numpy as np
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from azee_rig.nearest import barycentric, closest_on_triangles, nearest


@given(st.integers(0, 2**32 - 1))
def test_it_agrees_with_trimesh(seed: int) -> None:
    random = np.random.default_rng(seed)
    vertices = random.normal(size=(12, 3))
    triangles = np.array([random.choice(12, 3, replace=False) for _ in range(20)])
    points = random.normal(scale=1.5, size=(5, 3))
    found = nearest(vertices, triangles, points)
    surface = trimesh.Trimesh(vertices, triangles, process=False)
    wanted, distance, _ = trimesh.proximity.closest_point(surface, points)  # type: ignore[no-untyped-call]
    np.testing.assert_allclose(found.distances, distance, atol=1e-9)
    np.testing.assert_allclose(found.points, wanted, atol=1e-6)
    shares = barycentric(vertices[triangles[found.triangles]], found.points)
    np.testing.assert_allclose(shares.sum(axis=1), 1.0)
    assert shares.min() > -1e-6


def test_a_triangle_without_area_is_its_edges() -> None:
    corners = np.array([[[0.0, 0, 0], [1, 0, 0], [2, 0, 0]], [[1.0, 1, 1]] * 3])
    on = closest_on_triangles(corners, np.array([1.5, 1.0, 0.0]))
    np.testing.assert_allclose(on, np.array([[1.5, 0.0, 0.0], [1.0, 1.0, 1.0]]))
