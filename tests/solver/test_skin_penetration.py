"""How deep the drawn skin lies in the body, and what of it is meant."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from stick_obstacles import coordinate

from azee_rig.rig import Rig
from azee_solver import penetration
from azee_solver.constraint import Place
from azee_solver.evaluate import evaluator
from azee_solver.geometry import (
    Side,
    Site,
    SitePoint,
)
from azee_solver.penetration import meant_contact, mesh_penetration
from azee_solver.winding import distances, winding_numbers

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)


QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


CUBE = CORNERS[[t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]]


def test_winding_numbers_tell_inside_from_outside_even_of_an_open_box() -> None:
    points = np.array([[0.5, 0.5, 0.5], [0.1, 0.9, 0.2], [1.5, 0.5, 0.5], [-0.2, 0.1, 0.1]])
    np.testing.assert_allclose(winding_numbers(points, CUBE), [1, 1, 0, 0], atol=1e-9)
    open_box = CUBE[2:]
    assert winding_numbers(points[:1], open_box)[0] > 0.7


@given(st.integers(0, 10**6), st.integers(1, 40))
def test_winding_numbers_are_the_sum_of_solid_angles(seed: int, count: int) -> None:
    """Also of surfaces that cross themselves, seen from their corners too, and of many turns."""
    random = np.random.default_rng(seed)
    tangle = random.normal(size=(count, 3, 3))
    surface = np.concatenate([tangle, np.repeat(CUBE, 3, axis=0), 2.0 * CUBE - 0.5])
    points = np.concatenate([random.uniform(-0.5, 1.5, (6, 3)), tangle[0, :1], CORNERS[:1]])
    a, b, c = np.moveaxis(surface[None] - points[:, None, None], 2, 0)
    lengths = [np.linalg.norm(v, axis=-1) for v in (a, b, c)]
    volume = np.einsum("ntk,ntk->nt", a, np.cross(b, c))
    spread = np.prod(lengths, axis=0)
    for v, w, length in zip((a, b, c), (b, c, a), (lengths[2], *lengths[:2]), strict=True):
        spread += np.einsum("ntk,ntk->nt", v, w) * length
    exact = np.arctan2(volume, spread)
    flat = np.abs(np.abs(exact) - np.pi) < 1e-9  # a point on a triangle sees it from either side
    sums = exact.sum(axis=1) / (2 * np.pi)
    seen = ~flat.any(axis=1)
    np.testing.assert_allclose(winding_numbers(points, surface)[seen], sums[seen], atol=1e-9)


@given(st.tuples(coordinate, coordinate, coordinate))
def test_distance_to_a_cube(point: tuple[float, float, float]) -> None:
    p = 2 * np.array([point])
    outside = np.linalg.norm(p - np.clip(p, 0, 1))
    inside = min(np.minimum(p, 1 - p).min(), 1.0)
    wanted = outside if outside > 0 else inside
    assert distances(p, CUBE)[0] == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize(
    ("site", "other", "radius_m"),
    [("PA", "ST", 0.055), ("I_TIP", "PA", 0.055), ("I_TIP", "ST", 0.02)],
)
def test_a_touch_is_meant_about_a_finger_and_farther_about_a_palm(
    signer: Rig, site: str, other: str, radius_m: float
) -> None:
    """Whichever of the two sites lies on the palm."""
    body, frames = evaluator(signer, Side.RIGHT), signer.chain.frames(signer.coordinates.idle)
    on = SitePoint(Site(other, Side.LEFT if other == "PA" else None))
    touch = meant_contact(body, frames, Place(Site(site, Side.RIGHT), on))
    assert touch.radius_m == radius_m
    np.testing.assert_allclose(touch.point, body.site(Site(site, Side.RIGHT), frames))


@pytest.mark.parametrize(("winding", "inside"), [(0.48, False), (0.52, True)])
def test_skin_is_inside_a_part_that_surrounds_it_more_than_half(
    signer: Rig, winding: float, inside: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Parts are open where others go on, so that about a wrist there is something in between."""
    monkeypatch.setattr(
        penetration, "winding_numbers", lambda points, surface: np.full(len(points), winding)
    )
    assert bool(mesh_penetration(signer, np.array(signer.coordinates.idle))) == inside
