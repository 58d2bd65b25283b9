"""Sites on the skin: at bind to 2 mm, on their side, outward, mirrored; and while joints bend."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from azee_grammar.vocabulary import BONES, SITES
from azee_rig.mirror import other_side
from azee_rig.nearest import nearest
from azee_rig.rig import Rig
from azee_rig.site_check import at_bind, over_range

Floats = NDArray[np.float64]

RECARRIED = {"T_NA": "thumb_{S}_3", "T_PAD": "thumb_{S}_3"}
"""Sites whose published bone contradicts their description: nail and pad are on the last one."""


SHARED = {"EYE_R", "T_INT_R_1", "T_KN_R_1", "T_KNl_R_1", "T_l_R_1", "T_BALL_R"}
"""Eyeballs have joints of their own; the thumb's first bone lies in the palm's flesh."""


def place(rig: Rig, q: Floats, name: str) -> tuple[Floats, Floats]:
    site, frames = rig.sites[name], rig.chain.frames(q)
    return site.point(frames), site.outward(frames)


def test_every_bone_and_site_of_azee_is_there(signer: Rig) -> None:
    assert set(signer.bones) == set(BONES)
    assert set(signer.sites) == set(SITES)
    for name, site in signer.sites.items():
        side = "_L" if "_L" in name[1:] else "_R"
        recarried = RECARRIED.get(name.removesuffix(side))
        expected = SITES[name].bone if recarried is None else recarried.format(S=side[1])
        assert site.bone == expected, name


@pytest.mark.long
def test_at_bind_they_lie_on_the_skin_of_their_bone_and_look_outward(signer: Rig) -> None:
    q = signer.coordinates.bind
    placed = [place(signer, q, name) for name in signer.sites]
    points, normals = (np.array(x) for x in zip(*placed, strict=True))
    surface = trimesh.Trimesh(signer.mesh.vertices, signer.mesh.triangles, process=False)
    _, distance, triangle = trimesh.proximity.closest_point(surface, points)  # type: ignore[no-untyped-call]
    measured = at_bind(signer)
    np.testing.assert_allclose([m.distance_m for m in measured], distance, atol=1e-4)
    assert distance.max() < 0.002
    facing = (surface.face_normals[triangle] * normals).sum(axis=1)
    assert [m.site for m, f in zip(measured, facing, strict=True) if f < 0.6] == []
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-5)
    assert {m.site for m in measured if m.own < 0.45 and "_R" in m.site} <= SHARED
    assert [m.site for m in measured if m.near < 0.5] == []
    assert [m.site for m in measured if m.faults] == []


def test_skin_of_another_bone_is_found_out(signer: Rig) -> None:
    """What the check is worth: a site moved by 3 mm, turned inward, or given a wrong bone."""
    good = signer.sites["CK_L"]
    for wrong, fault in (
        (replace(good, position=good.position + 0.003 * good.normal), "off the skin"),
        (replace(good, normal=-good.normal), "outward"),
        (replace(good, bone="palm_L"), "other bones"),
    ):
        spoilt = replace(signer, sites={"CK_L": wrong, "CK_R": signer.sites["CK_R"]})
        found = at_bind(spoilt)[0]
        assert any(fault in text for text in found.faults), found.faults


def test_left_and_right_mirror_each_other(signer: Rig) -> None:
    q = signer.coordinates.bind
    assert len(signer.sites) == 323
    for name, site in signer.sites.items():
        other = other_side(name)
        (a, n), (b, m) = place(signer, q, name), place(signer, q, other)
        assert np.linalg.norm(a * (-1, 1, 1) - b) < 0.002, name
        assert (n * (-1, 1, 1)) @ m > 0.9, name
        if other != name and not site.bone.startswith("back"):
            assert a[0] > 0 if "_L" in name[1:] else a[0] < 0, name


@pytest.mark.parametrize("digit", ["thumb", "index", "middle", "ring", "little"])
def test_sides_of_a_finger(signer: Rig, digit: str) -> None:
    letter, q = digit[0].upper(), signer.coordinates.bind
    R = signer.chain.frames(q).rotations[signer.bones[f"{digit}_R_3"].node]
    tip, pad, nail = (place(signer, q, f"{letter}_{x}_R")[1] @ R for x in ("TIP", "PAD", "NA"))
    assert tip[1] > 0.7
    assert pad[2] > 0.7
    assert nail[2] < -0.7


def test_named_places_of_the_face_are_in_order(signer: Rig) -> None:
    height = {n: place(signer, signer.coordinates.bind, n)[0][1] for n in signer.sites}
    order = ["NK", "CH", "MO", "NSP", "NO", "EYE_R", "EB_R", "FH", "HEAD"]
    assert sorted(order, key=lambda n: height[n]) == order
    at = {n: place(signer, signer.coordinates.bind, n)[0] for n in ("EBi_L", "EB_L", "EBe_L")}
    assert at["EBi_L"][0] < at["EB_L"][0] < at["EBe_L"][0]


@pytest.mark.slow
def test_they_stay_on_the_skin_over_the_range_of_every_joint(signer: Rig) -> None:
    """Within 6 mm, with the coordinates of a joint at their limits in every combination."""
    found = over_range(signer)
    assert {site.site for site in found} == set(signer.sites)
    assert [site for site in found if abs(site.distance_m) > 0.006] == []
    worst = found[0]
    q = np.array(signer.coordinates.idle)
    for name, angle in worst.at_rad.items():
        for side in (name, other_side(name)):
            q[signer.coordinates.index[side]] = angle
    skin = trimesh.Trimesh(signer.skin(signer.pose(q)), signer.mesh.triangles, process=False)
    point = place(signer, q, worst.site)[0]
    _, distance, _ = trimesh.proximity.closest_point(skin, point[None])  # type: ignore[no-untyped-call]
    assert distance[0] == pytest.approx(abs(worst.distance_m), abs=1e-6)


@pytest.mark.parametrize("name", ["SH_R", "EL_L", "WRt_R", "I_KNi_R_2"])
def test_normals_follow_the_skin(signer: Rig, name: str) -> None:
    """Where a site rides on several nodes, its normal stays within 30° of the skin's."""
    q = np.array(signer.coordinates.idle)
    for coordinate, degrees in (
        ("arm_{S}.flexion", 60),
        ("arm_{S}.abduction", 40),
        ("f_arm_{S}.flexion", 110),
        ("palm_{S}.flexion", 50),
        ("index_{S}_2.flexion", 70),
    ):
        for side in "LR":
            q[signer.coordinates.index[coordinate.format(S=side)]] = np.radians(degrees)
    surface = trimesh.Trimesh(signer.skin(signer.pose(q)), signer.mesh.triangles, process=False)
    point, normal = place(signer, q, name)
    found = nearest(surface.vertices, signer.mesh.triangles, point[None])
    assert surface.face_normals[found.triangles[0]] @ normal > np.cos(np.radians(30))
