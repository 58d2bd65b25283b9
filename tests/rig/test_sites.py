"""Sites on the skin: at bind to 2 mm, on their side, outward, mirrored; and while joints bend."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from azee_grammar.vocabulary import BONES, SITES
from azee_rig.rig import Rig

Floats = NDArray[np.float64]

RECARRIED = {"T_NA": "thumb_{S}_3", "T_PAD": "thumb_{S}_3"}
"""Sites whose published bone contradicts their description: nail and pad are on the last one."""


def place(rig: Rig, q: Floats, name: str) -> tuple[Floats, Floats]:
    site, frames = rig.sites[name], rig.chain.frames(q)
    return site.point(frames), site.outward(frames)


@pytest.fixture(scope="module")
def bind_surface(signer: Rig) -> trimesh.Trimesh:
    return trimesh.Trimesh(signer.mesh.vertices, signer.mesh.triangles, process=False)


def nearest(surface: trimesh.Trimesh, points: Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Distances to the surface, and the triangles there."""
    _, distance, triangle = trimesh.proximity.closest_point(surface, points)  # type: ignore[no-untyped-call]
    return distance, triangle


def test_every_bone_and_site_of_azee_is_there(signer: Rig) -> None:
    assert set(signer.bones) == set(BONES)
    assert set(signer.sites) == set(SITES)
    for name, site in signer.sites.items():
        side = "_L" if "_L" in name[1:] else "_R"
        recarried = RECARRIED.get(name.removesuffix(side))
        expected = SITES[name].bone if recarried is None else recarried.format(S=side[1])
        assert site.bone == expected, name


def test_at_bind_they_lie_on_the_skin_and_look_outward(
    signer: Rig, bind_surface: trimesh.Trimesh
) -> None:
    q = signer.coordinates.bind
    placed = [place(signer, q, name) for name in signer.sites]
    points, normals = (np.array(x) for x in zip(*placed, strict=True))
    distance, triangle = nearest(bind_surface, points)
    names = list(signer.sites)
    assert [n for n, d in zip(names, distance, strict=True) if d > 0.002] == []
    facing = (bind_surface.face_normals[triangle] * normals).sum(axis=1)
    assert [n for n, f in zip(names, facing, strict=True) if f < 0.3] == []
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-5)


def test_left_and_right_mirror_each_other(signer: Rig) -> None:
    q = signer.coordinates.bind
    for name, site in signer.sites.items():
        if "_L" not in name[1:]:
            continue
        other = name[0] + name[1:].replace("_L", "_R", 1)
        (a, n), (b, m) = place(signer, q, name), place(signer, q, other)
        assert np.linalg.norm(a * (-1, 1, 1) - b) < 0.002, name
        assert (n * (-1, 1, 1)) @ m > 0.9, name
        if site.bone.endswith("_L") or "_L_" in site.bone:
            assert a[0] > 0, name


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
@pytest.mark.parametrize(
    ("site", "coordinate"),
    [
        ("EL_R", "f_arm_R.flexion"),
        ("ELi_R", "f_arm_R.flexion"),
        ("F_ARM_R", "f_arm_R.pronation"),
        ("F_ARMi_R", "f_arm_R.pronation"),
        ("WR_R", "palm_R.flexion"),
        ("WRi_R", "palm_R.flexion"),
        ("I_KN_R_1", "index_R_1.flexion"),
        ("I_KN_R_2", "index_R_2.flexion"),
    ],
)
def test_they_stay_near_the_skin_over_a_joint(signer: Rig, site: str, coordinate: str) -> None:
    """Within 6 mm; 8 mm in the crease of an elbow that is bent as far as it goes."""
    i = signer.coordinates.index[coordinate]
    for value in np.linspace(signer.coordinates.lower[i], signer.coordinates.upper[i], 8):
        q = np.array(signer.coordinates.idle)
        q[i] = value
        skin = trimesh.Trimesh(signer.skin(signer.pose(q)), signer.mesh.triangles, process=False)
        point = place(signer, q, site)[0]
        assert nearest(skin, point[None])[0][0] < (0.008 if site == "ELi_R" else 0.006), np.degrees(
            value
        )
