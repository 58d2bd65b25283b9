"""Skin keeps its shape where plain linear blending collapses, by joints alone."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from azee_rig.build.shape import elbow_sleeve, enclosed_volume, limb_sections, section_area
from azee_rig.drive import Drive
from azee_rig.rig import Rig

Floats = NDArray[np.float64]


def _bent(rig: Rig, **degrees: float) -> Floats:
    q = np.array(rig.coordinates.bind)
    for name, angle in degrees.items():
        q[rig.coordinates.index[name.replace("__", ".")]] = np.radians(angle)
    return q


def _hand_turned(rig: Rig, side: str, before: Floats, after: Floats) -> float:
    """Degrees by which the skin of the fingers turns, as one piece, from posture to posture (V,).

    The rotation that fits best (Kabsch 1976): what does not move keeps its shape, too.
    """
    names = np.array(rig.skeleton.names)[rig.mesh.joints]
    of_hand = np.char.startswith(names, "finger") & np.char.endswith(names, f".{side}")
    whole = np.where(of_hand, rig.mesh.weights, 0.0).sum(axis=1) > 0.999
    p, q = (rig.skin(rig.pose(posture))[whole] for posture in (before, after))
    u, _, vt = np.linalg.svd((q - q.mean(axis=0)).T @ (p - p.mean(axis=0)))
    R = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
    return float(np.degrees(np.arccos(np.clip((np.trace(R) - 1.0) / 2.0, -1.0, 1.0))))


def test_measures_of_a_prism() -> None:
    """A box of 2 × 3 × 5 cm without its ends, whole and with a section across."""
    square = np.array([[0, 0], [2, 0], [2, 3], [0, 3]]) / 100.0
    vertices = np.array([[x, y, z] for z in (0.0, 0.05) for x, y in square])
    ring = [(k, (k + 1) % 4) for k in range(4)]
    triangles = np.array([t for a, b in ring for t in ((a, b, b + 4), (a, b + 4, a + 4))])
    assert enclosed_volume(vertices, triangles) == pytest.approx(30e-6)
    middle, up = np.array([0.01, 0.015, 0.02]), np.array([0.0, 0.0, 1.0])
    assert section_area(vertices, triangles, middle, up) == pytest.approx(6e-4)
    assert np.isnan(section_area(vertices, triangles[1:], middle, up))


@pytest.mark.parametrize("side", ["L", "R"])
@pytest.mark.parametrize("degrees", [-80.0, 80.0])
def test_the_wrist_is_not_wrung(signer: Rig, side: str, degrees: float) -> None:
    """At ±80° of pronation a section keeps 97 % of its area at the wrist, 95 % in the sleeve."""
    at = {"skin": np.arange(-0.030, 0.021, 0.005), "top": np.arange(-0.16, -0.035, 0.02)}
    least = {"skin": 0.97, "top": 0.95}
    straight, wrung = (
        _bent(signer, **{f"f_arm_{side}__pronation": angle}) for angle in (0.0, degrees)
    )
    for part, places in at.items():
        before, after = (
            limb_sections(signer, signer.skin(signer.pose(q)), q, part, side, places)
            for q in (straight, wrung)
        )
        assert len(before) == len(places)
        assert np.isfinite(before).all()
        assert (after / before).min() >= least[part], (part, after / before)
    assert _hand_turned(signer, side, straight, wrung) == pytest.approx(80.0, abs=1e-3)


@pytest.mark.parametrize("side", ["L", "R"])
def test_a_bent_elbow_keeps_its_flesh(signer: Rig, side: str) -> None:
    """Of what 6 cm of both limbs enclose, 90 % is left at every angle up to 145°."""
    sleeve = elbow_sleeve(signer, "top", side, 0.06)
    before = enclosed_volume(signer.mesh.vertices, sleeve)
    at_bind = np.degrees(signer.coordinates.bind[signer.coordinates.index[f"f_arm_{side}.flexion"]])
    for angle in (0.0, 90.0, 120.0, 145.0):
        q = _bent(signer, **{f"f_arm_{side}__flexion": angle})
        share = enclosed_volume(signer.skin(signer.pose(q)), sleeve) / before
        assert 0.90 <= share < 1.06, angle
        turned = _hand_turned(signer, side, signer.coordinates.bind, q)
        assert turned == pytest.approx(abs(angle - at_bind), abs=1e-3)


def test_helpers_take_their_share_of_a_bend(signer: Rig) -> None:
    rotations = signer.pose(_bent(signer, f_arm_R__flexion=123.0)).rotations
    drive: Drive = signer.drive
    elbow = signer.skeleton.names.index("lowerarm01.R")
    turned = 2 * np.arccos(rotations[:, 0])
    helpers = np.flatnonzero(drive.helper_of == elbow)
    assert len(helpers) == 3
    np.testing.assert_allclose(turned[helpers], turned[elbow] * np.array([0.25, 0.5, 0.75]))
    moving = np.flatnonzero(turned > 1e-6)
    assert set(moving) == {elbow, *helpers}


def test_no_two_neighbours_along_a_limb_differ_by_much(signer: Rig) -> None:
    """Half-way between two turns skin loses 1 − cos²(θ/2) of its section: 5 % at 25°."""
    q = _bent(signer, arm_R__rotation=90.0, f_arm_R__pronation=-90.0)
    turned = np.degrees(2 * np.arccos(np.clip(signer.pose(q).rotations[:, 0], -1.0, 1.0)))
    assert turned.max() < 25.0
    assert (turned > 15.0).sum() >= 9
