from __future__ import annotations

import numpy as np

from azee_grammar.vocabulary import MORPHS
from azee_rig.rig import Rig


def test_every_facial_morph_is_shown_or_its_lack_is_explained(signer: Rig) -> None:
    facial = {name for name, entry in MORPHS.items() if "facial" in entry.kind}
    assert set(signer.face_morphs) | set(signer.unexpressed_morphs) == facial
    assert not set(signer.face_morphs) & set(signer.unexpressed_morphs)
    assert all(len(reason) > 20 for reason in signer.unexpressed_morphs.values())


def test_every_facial_morph_is_seen(signer: Rig) -> None:
    """On a head and shoulders of 480 pixels skin moves by 2 pixels or more, not just one point."""
    mesh = signer.mesh
    pixel_m = 2 * 0.165 / 480
    inside = {"teeth", "eyes", "lashes"}
    hidden = [p for p in mesh.parts if p.name in inside]
    covered = {int(v) for p in hidden for v in mesh.triangles[p.start : p.stop].ravel()}
    assert len(signer.face_morphs) >= 94
    for name, units in signer.face_morphs.items():
        moved = np.zeros((len(mesh.vertices), 3))
        for unit, weight in units.items():
            rows, deltas = mesh.unit(unit)
            moved[rows] += weight * deltas
        far = np.flatnonzero(np.linalg.norm(moved, axis=1) > 2 * pixel_m)
        assert len(set(far.tolist()) - covered) >= 12, name


def test_the_tongue_moves_alone(signer: Rig) -> None:
    mesh = signer.mesh
    (part,) = (p for p in mesh.parts if p.name == "tongue")
    tongue = set(np.unique(mesh.triangles[part.start : part.stop]).tolist())
    for unit, axis, sign in (
        ("tongueUp", 1, 1.0),
        ("tongueDown", 1, -1.0),
        ("tongueBackUp", 1, 1.0),
    ):
        rows, deltas = mesh.unit(unit)
        assert set(rows.tolist()) <= tongue
        assert (sign * deltas[:, axis]).max() > 0.008
    rows, deltas = mesh.unit("tongueWide")
    assert (deltas[:, 0] * mesh.vertices[rows, 0]).min() > 0.0


def test_a_cheek_bulges_on_its_side(signer: Rig) -> None:
    mesh = signer.mesh
    for unit, sign in (("cheekBulgeLeft", 1.0), ("cheekBulgeRight", -1.0)):
        rows, deltas = mesh.unit(unit)
        assert (sign * mesh.vertices[rows, 0]).min() > 0.0
        assert 0.006 < np.linalg.norm(deltas, axis=1).max() < 0.012


def test_every_skeletal_morph_is_there(signer: Rig) -> None:
    skeletal = {name for name, entry in MORPHS.items() if "skeletal" in entry.kind}
    assert skeletal <= set(signer.skeletal_morphs)
    for name, moves in signer.skeletal_morphs.items():
        assert moves, name
        assert set(moves) <= set(signer.coordinates.names)


def test_a_skeletal_morph_of_weight_one_stays_inside_the_limits(signer: Rig) -> None:
    c = signer.coordinates
    assert len(signer.skeletal_morphs) > 20
    for name, moves in signer.skeletal_morphs.items():
        assert moves, name
        for coordinate, angle in moves.items():
            i = c.index[coordinate]
            assert c.lower[i] <= angle <= c.upper[i], (name, coordinate)


def test_sides_of_a_morph_are_mirrored(signer: Rig) -> None:
    mesh = signer.mesh

    def mean_side(name: str) -> float:
        moved = np.zeros((len(mesh.vertices), 3))
        for unit, weight in signer.face_morphs[name].items():
            rows, deltas = mesh.unit(unit)
            moved[rows] += weight * deltas
        size = np.linalg.norm(moved, axis=1)
        return float((size * mesh.vertices[:, 0]).sum() / size.sum())

    pairs = [n for n in signer.face_morphs if n.endswith("_L") and not n.startswith("AU30")]
    assert len(pairs) > 10
    for name in pairs:
        left, right = mean_side(name), mean_side(name.removesuffix("L") + "R")
        assert left > 0.005, name
        assert abs(left + right) < 0.006, name


def test_a_morph_without_side_is_both_sides(signer: Rig) -> None:
    both = signer.skeletal_morphs["index_bend"]
    one = {**signer.skeletal_morphs["index_bend_L"], **signer.skeletal_morphs["index_bend_R"]}
    assert both == one
    assert set(signer.skeletal_morphs["index_bend_R"]) == {"index_R_1.flexion"}


def test_units_move_what_they_are_named_for(signer: Rig) -> None:
    mesh = signer.mesh
    for unit in mesh.units:
        rows, deltas = mesh.unit(unit)
        assert len(rows), unit
        assert 0.0003 < np.linalg.norm(deltas, axis=1).max() < 0.06, unit
    rows, deltas = mesh.unit("jawOpen")
    assert deltas[:, 1].min() < -0.015
    rows, deltas = mesh.unit("tongueOut")
    assert deltas[:, 2].max() > 0.01
