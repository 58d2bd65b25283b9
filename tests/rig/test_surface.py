"""Rays against the skin of a body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from azee_rig.build.surface import Surface
from azee_rig.rig import Rig


def test_a_ray_passes_a_triangle_without_area(signer: Rig) -> None:
    """Somebody's mesh may have one; where a ray meets it is computed by dividing by its area."""
    square = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
    sliver = [[-1, 0, 0.5], [1, 0, 0.5], [0, 1e-9, 0.5]]
    one = np.zeros((7, 1))
    mesh = replace(
        signer.mesh,
        vertices=np.array(square + sliver, dtype=float),
        triangles=np.array([[4, 5, 6], [0, 1, 2], [0, 2, 3]]),
        parts=(replace(signer.mesh.parts[0], start=0, stop=3),),
        colours=np.ones((7, 3)),
        joints=one.astype(int),
        weights=one + 1.0,
        units=(),
        unit_start=np.zeros(1, dtype=int),
        unit_rows=np.zeros(0, dtype=int),
        unit_deltas=np.zeros((0, 3)),
    )
    surface = Surface(mesh, signer.skeleton)
    above, down = np.array([0.1, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])
    for allowed in ([True, True, True], [False, True, True]):
        place, normal = surface.cast(above, down, np.array(allowed), "first")
        np.testing.assert_allclose(place, [0.1, 0.0, 0.0], atol=1e-12)
        np.testing.assert_allclose(normal, [0.0, 0.0, 1.0], atol=1e-12)
